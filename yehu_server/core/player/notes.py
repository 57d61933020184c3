"""Notes begin, follow the parameters, and end; the one pressed last sounds. Compiled."""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.ramps import start_ramp
from yehu_server.core.controls.slots import SILENCE, SLOTS
from yehu_server.core.player import left_hand, right_hand, stroke_contours, velocity, vibrato
from yehu_server.core.player.bow_length import CHANGE_MS, is_at_its_end, plan_stroke
from yehu_server.core.player.bowing import MIN_PRESS, bowing_value
from yehu_server.core.player.bowing_by_ear import begin_pressure_correction
from yehu_server.core.player.fingering import OPEN, choose, choose_for_slide, learnt_position, stay
from yehu_server.core.player.gestures import (
    BEARS_SLIDE,
    BEATS,
    IS_PLUCKED,
    REACH,
    SHAPES,
    attack_ms,
    begin_gesture,
    begin_slide,
    release_ms,
    tremolo_of,
)
from yehu_server.core.player.gestures import FINGER_COUNT as FINGER_STEP_COUNT
from yehu_server.core.player.harmonics import NONE, place_of, string_of
from yehu_server.core.player.held_keys import NOT_HELD, add_key, find_key, remove_key
from yehu_server.core.player.intonation import in_tables
from yehu_server.core.player.left_hand import LIFTING_MS, side_of
from yehu_server.core.player.ownership import (
    DEFAULT_RAMP_MS,
    move_parameter,
    take_all_back,
    take_back,
)
from yehu_server.core.player.parameter_indices import BOW, OUTPUT, PLAYING, SMOOTH_MS
from yehu_server.core.player.phrasing import (
    SCOOP_MS,
    SHIFT,
    STEP_MS,
    hurry_of,
    scoop_of,
    slide_of_leap_ms,
    varied_semitones,
    vary_next_note,
)
from yehu_server.core.player.record import SILENT
from yehu_server.core.player.right_hand import SLURRED_MS, requested_speed
from yehu_server.core.player.sway import swing
from yehu_server.core.player.tuning_by_ear import begin_tuning
from yehu_server.params.spec import TURNED_ON
from yehu_server.params.table import find

BEND_RAMP_MS = find("/playing/bend").smooth_ms
# The level is this power of dynamics: together with the slower bow, dynamics 0.5 is some 12 dB
# below 1, and 0.1 some 35 dB. By ear.
DYNAMICS_EXPONENT = 1.5
# A pitch bent farther than this from its key is not given a slide of its own.
MAX_SEMITONES_FROM_KEY = 0.5
# With the bow off, the finger shifts to its next place. Lifted, it would pluck the string in front
# of the next finger, and the bow catch that with periods three times too long: of leaps down to F5
# to A5 after a rest, 6 of 10 were wrong for more than 40 ms. A bow that only begins to leave will
# turn: LEAVING is the most of its weight that is left.
LEAVING = 0.95
SETTLING_MS = 35.0  # until a string has reached its pitch, and the ear has only that in its window


# -- notes --------------------------------------------------------------------------------------


@compiled_exactly
def begin(p: Any, c: Any, frame: int, channel: int, key: float, pitch: float) -> None:
    """Begin a note, legato where another sounds, else with a new stroke of the bow.

    Keys struck at one frame make one stroke.
    """
    take_all_back(p)
    p.is_direct = 0
    before = find_key(p, channel, key)
    is_legato = p.sounding != SILENT and (before == NOT_HELD or p.sounding != before)
    at_once = is_legato and frame == p.began
    if before != NOT_HELD:
        remove_key(p, before)
    add_key(p, channel, key, pitch)
    sound_last(p, c, is_legato, at_once)
    if not is_legato:
        p.began = frame


@compiled_exactly
def end(p: Any, c: Any, channel: int, key: float, more_end: bool) -> None:
    """End a note; of those still held the last one sounds again, legato.

    Where `more_end` at the same time, the last of them to end decides.
    """
    held = find_key(p, channel, key)
    if held != NOT_HELD:
        remove_key(p, held)
    if more_end or p.sounding >= 0 or p.sounding == SILENT:
        return
    if p.held > 0:
        sound_last(p, c, True, False)
    else:
        p.sounding = SILENT
        ends_in_ms = release_ms(p, c)
        stroke_contours.end_contours(p, c, ends_in_ms)
        right_hand.lift(p, c, ends_in_ms)
        vibrato.end_vibrato(p, c)


@compiled_exactly
def stop_sound(p: Any, c: Any, is_panic: bool) -> None:
    """Lift bow and fingers and fade out, unless a note sounds; a panic ends all notes."""
    if is_panic:
        p.held, p.sounding = 0, SILENT
    if p.sounding != SILENT:
        return
    p.is_direct = 0
    take_back(p, BOW.speed)
    take_back(p, BOW.side)
    right_hand.lift(p, c, LIFTING_MS)
    left_hand.lift_all(p, c)
    p.finger_pitch = p.open_note[0]
    start_ramp(c, SILENCE, 0.0, 0)


@compiled_exactly
def sound_last(p: Any, c: Any, is_legato: bool, at_once: bool) -> None:
    """Let the key sound that was pressed last."""
    p.sounding = p.held - 1
    vary_next_note(p)
    is_slur = is_legato and not at_once
    if not at_once:
        p.hurry = 0.0 if is_legato else hurry_of(p, c)
    p.stroke_speed_factor = 1.0
    begin_gesture(p, c, is_slur)
    turns = plan_stroke(p, c, requested_speed(p), is_legato)
    stroke_contours.begin_contours(p, c, is_slur)
    swing(p, is_slur)
    slide_ms = 0.0 if at_once and not is_touched(p) else slide_into_note_ms(p, c)
    was, last, p.note_began = p.finger_pitch, p.note_began, c.frame
    if slide_ms > 0.0 and p.string >= 0:
        string, position = begin_from_last(p, slide_ms)
        pitch = p.finger_pitch = note_pitch(p)
    elif is_touched(p):
        string, position = string_of(p.gesture.node), place_of(p, p.gesture.node)
        pitch = p.finger_pitch = note_pitch(p)
    else:
        pitch = p.finger_pitch = note_pitch(p)
        low, high = REACH[p.gesture.row, 0], REACH[p.gesture.row, 1]
        if low < high:  # on the string that has all of the slide
            aim = pitch - p.gesture.bend
            low, high = aim + low, aim + high
            string, position = choose_for_slide(p, pitch, low, high, requested_speed(p), True)
        else:
            beats = BEATS[p.gesture.row]
            shakes = not (beats or is_plucked(p)) and vibrato.is_sure(p, c, last)
            string, position = choose(p, pitch, beats, shakes, requested_speed(p))
            if not (at_once or beats or is_plucked(p)):
                position = scooped(p, c, string, position, pitch - was)
                pitch = p.finger_pitch
    crosses_strings = string != p.string
    left_hand.stop(p, c, string, position, min_press(p, string), step_or_shift(p, c, slide_ms))
    begin_tuning(p, pitch)
    begin_pressure_correction(p, pitch)
    pause_listening(p, c, max(slide_ms, SLURRED_MS if is_slur else attack_ms(p)))
    vibrato.set_vibrato(p, c)
    vibrato.begin_vibrato(p, c)
    set_assist(p, c)
    set_level(p, c)
    set_bow_pressure(p, c)
    if not is_legato or crosses_strings:
        right_hand.set_attack_pressure(p, c)
    if is_plucked(p):
        right_hand.pluck(p, c, side_of(p))
    else:
        ramp_ms = CHANGE_MS if turns else SLURRED_MS
        draw(p, c, ramp_ms if is_slur else p.value[PLAYING.attack])


@compiled_exactly
def step_or_shift(p: Any, c: Any, slide_ms: float) -> float:
    """SHIFT in place of a step where the bow is off, or leaves: the finger slides there unheard."""
    is_off = c.target[SLOTS.bow_side] == 0.0 and abs(c.value[SLOTS.bow_side]) < LEAVING
    if slide_ms >= 0.0 or p.string < 0 or not is_off or is_plucked(p) or is_touched(p):
        return slide_ms
    return SHIFT


@compiled_exactly
def scooped(p: Any, c: Any, string: int, position: float, rise: float) -> float:
    """Begin the slide of a note that comes to its pitch from a little below.

    Returns the finger position (m) there, or the one given where the note has no such slide.
    """
    g = p.gesture
    is_free = FINGER_STEP_COUNT[g.row] == 0 and g.bend == p.value[PLAYING.bend] == 0.0
    if not is_free or position == OPEN or p.finger_pitch < p.open_note[string] + 1.0:
        return position
    scoop = scoop_of(p, c, rise)
    if scoop == 0.0:
        return position
    begin_slide(p, scoop, 0.0, 0.0, 1e-3 * SCOOP_MS)
    p.finger_pitch = note_pitch(p)
    return learnt_position(p, string, p.finger_pitch, requested_speed(p))


@compiled_exactly
def slide_into_note_ms(p: Any, c: Any) -> float:
    """Time of the slide that a note begins with; STEP_MS where the finger steps."""
    if is_touched(p):
        return STEP_MS
    if is_on(p, PLAYING.portamento):
        return float(p.value[PLAYING.portamento_time])
    is_bent = abs(p.value[PLAYING.bend]) > MAX_SEMITONES_FROM_KEY
    if is_bent or is_plucked(p) or not BEARS_SLIDE[p.gesture.row]:
        return STEP_MS
    return slide_of_leap_ms(p, c, note_pitch(p) - p.finger_pitch)


@compiled_exactly
def begin_from_last(p: Any, slide_ms: float) -> tuple[int, float]:
    """Begin a slide where the finger is, to the pitch of the note; the fingering there.

    A slide from a note that both strings have to one of the inner string alone stays on that.
    """
    requested = note_pitch(p)
    begin_slide(p, p.finger_pitch - requested, p.gesture.bend, 0.0, 1e-3 * slide_ms)
    pitch = note_pitch(p)
    low, high = min(pitch, requested), max(pitch, requested)
    return choose_for_slide(p, pitch, low, high, requested_speed(p), False)


@compiled_exactly
def reverse_bow_at_end(p: Any, c: Any) -> None:
    """Change the direction of a bow that reaches its end."""
    if p.sounding < 0 or tremolo_of(p) != 0.0:
        return
    if is_at_its_end(p, c, abs(c.value[SLOTS.bow_speed])):
        p.direction = -p.direction
        draw(p, c, CHANGE_MS)


@compiled_exactly
def pause_listening(p: Any, c: Any, moving_ms: float) -> None:
    """Ignore the string until a move of `moving_ms` has ended and the pitch has settled."""
    frames = int(1e-3 * (moving_ms + SETTLING_MS) * p.rate)
    p.settled_at = max(p.settled_at, c.frame + frames)


@compiled_exactly
def note_pitch(p: Any) -> float:
    """Pitch (fractional MIDI note) of the sounding key, with its bend; 0 in silence."""
    if p.sounding < 0:
        return 0.0
    bend = p.value[PLAYING.bend] + p.gesture.bend
    return float(p.held_pitch[p.sounding] + bend + varied_semitones(p))


@compiled_exactly
def sounding_pitch(p: Any) -> float:
    """The pitch while a note sounds or the bow is drawn directly, else NaN.

    A bend goes no lower than the open string.
    """
    if p.sounding >= 0:
        return max(note_pitch(p), float(p.open_note[p.string]))
    return float(p.finger_pitch if p.is_direct != 0 else math.nan)


@compiled_exactly
def is_on(p: Any, index: int) -> bool:
    """Whether a switch is on."""
    return bool(p.value[index] >= TURNED_ON)


@compiled_exactly
def is_plucked(p: Any) -> bool:
    """Whether the note is plucked."""
    return is_on(p, PLAYING.pizzicato) or bool(SHAPES[p.gesture.row, IS_PLUCKED])


@compiled_exactly
def is_touched(p: Any) -> bool:
    """Whether the finger of the sounding note touches a node, from which it does not move."""
    return bool(p.sounding >= 0 and p.gesture.node != NONE)


# -- what follows a parameter while a note sounds ---------------------------------------------


@compiled_exactly
def set_assist(p: Any, c: Any) -> None:
    """Let the bow's force follow its speed as far as is asked for."""
    move_parameter(p, c, BOW.assist, p.value[PLAYING.assist], DEFAULT_RAMP_MS)


@compiled_exactly
def set_level(p: Any, c: Any) -> None:
    """Set the output's level."""
    level = (p.value[PLAYING.volume] * p.value[PLAYING.expression]) ** 2
    dynamics = right_hand.requested_dynamics(p)
    level *= dynamics * math.sqrt(dynamics)  # to the DYNAMICS_EXPONENT
    move_parameter(p, c, OUTPUT.level, level, DEFAULT_RAMP_MS)


@compiled_exactly
def draw(p: Any, c: Any, ramp_ms: float) -> None:
    """Draw the bow at the speed of the sounding note."""
    if p.sounding >= 0 and not is_plucked(p) and p.gesture.is_off == 0:
        right_hand.draw(p, c, note_pitch(p), side_of(p), ramp_ms)


@compiled_exactly
def update_bow(p: Any, c: Any) -> None:
    """Draw as parameters now say, but let a move of the gesture take its time."""
    left_ms = 1e3 * (p.gesture.move_ends - (c.frame - p.note_began) / p.rate)
    draw(p, c, max(left_ms, SMOOTH_MS[BOW.speed]))


@compiled_exactly
def set_bow_pressure(p: Any, c: Any) -> None:
    """Set the bow's pressure and position, and the colour that they make."""
    right_hand.set_bow_pressure(p, c, note_pitch(p), p.sounding >= 0)
    set_loudness_balance(p, c)


@compiled_exactly
def min_press(p: Any, string: int) -> float:
    """The finger force (N) that the sounding note needs on a string."""
    if p.sounding < 0:
        return 0.0
    stopped = in_tables(p, string, note_pitch(p))
    return bowing_value(p.bowing_table, string, p.value[PLAYING.bow_position], stopped, MIN_PRESS)


@compiled_exactly
def set_loudness_balance(p: Any, c: Any) -> None:
    """Set colour, and the gain that evens out the loudness of notes, as the bow is drawn."""
    if p.sounding >= 0 or p.is_direct != 0:
        pitch = note_pitch(p) if p.sounding >= 0 else p.finger_pitch
        speed, effort = requested_speed(p), requested_speed(p) * p.value[PLAYING.pressure]
        effort *= right_hand.arm(p, right_hand.ARM_FORCE)
        if p.is_direct != 0:
            speed, effort = p.speed, p.effort
        velocity.set_loudness_balance(p, c, pitch, speed, effort)


@compiled_exactly
def reset_corrections(p: Any, c: Any) -> None:
    """Take back what the ear has corrected of the sounding note."""
    p.sharper, p.pressure_factor, p.nearer = 0.0, 1.0, 1.0
    if p.sounding >= 0:
        follow_bend(p, c)
        set_bow_pressure(p, c)


@compiled_exactly
def follow_bend(p: Any, c: Any) -> None:
    """Slide the finger to the pitch of the sounding note, and bow it as that pitch wants."""
    follow_pitch(p, c, BEND_RAMP_MS)


@compiled_exactly
def rock(p: Any, c: Any) -> None:
    """Rock the finger as requested now; an open string's note is stopped on the other for it."""
    is_short = 0.0 < p.value[PLAYING.note_length] < vibrato.AUDIBLE_FROM_S
    is_open = p.sounding >= 0 and p.string == 1 and p.position == OPEN
    is_free = is_open and not (is_short or is_touched(p) or is_plucked(p))
    if is_free and vibrato.is_requested(p):
        pitch = note_pitch(p)
        string, position = choose(p, pitch, BEATS[p.gesture.row], True, requested_speed(p))
        if string == 0:
            left_hand.stop(p, c, string, position, min_press(p, string), STEP_MS)
            begin_tuning(p, pitch)
            set_bow_pressure(p, c)
            update_bow(p, c)
            pause_listening(p, c, SLURRED_MS)
    vibrato.set_vibrato(p, c)


@compiled_exactly
def follow_pitch(p: Any, c: Any, slide_ms: float) -> None:
    """The same, in a time (ms); `phrasing.STEP_MS` puts the next finger down."""
    if p.sounding < 0 or p.string < 0:
        return
    pitch, before, was = note_pitch(p), p.string, p.finger_pitch
    p.finger_pitch = pitch
    if is_touched(p):
        set_loudness_balance(p, c)
        return
    string, position = stay(p, pitch, slide_ms == STEP_MS, requested_speed(p))
    left_hand.stop(p, c, string, position, min_press(p, string), slide_ms)
    if string != before:
        begin_tuning(p, pitch)
    if string != before or not right_hand.has_same_bowing(p, pitch):
        set_bow_pressure(p, c)
        update_bow(p, c)
    if pitch != was:
        p.first_error, p.jumps = math.nan, 0
        pause_listening(p, c, max(slide_ms, 0.0))
    set_loudness_balance(p, c)
