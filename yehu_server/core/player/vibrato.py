"""The vibrato of a note: as requested, as its articulation wants it, or the player's own. Compiled.

Styles of vibrato are articulations (``params.articulations``). A vibrato is narrower, and off the
note's middle, where the body would swing its level (``vibrato_table``). Default rate and delay are
rows of ``params.table``.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import pseudorandom
from yehu_server.core.player.gestures import CENTS, DELAY_MS, HAS_VIBRATO, HERTZ, VIBRATOS
from yehu_server.core.player.gestures import PRESS as PRESS_SHARE
from yehu_server.core.player.gestures import UPWARD as UPWARD_SHARE
from yehu_server.core.player.ownership import DEFAULT_RAMP_MS, invalidate_sent, move_parameter
from yehu_server.core.player.parameter_indices import PLAYING, VIBRATO
from yehu_server.core.player.phrasing import chance, fingered
from yehu_server.core.player.vibrato_table import CENTRE, DEFAULT_DEPTH_CENTS, DEPTH_SHARE, STEPS

# The player's own, at full phrasing; by ear.
OWN_CENTS, OWN_DELAY_MS = 60.0, 750.0
AUDIBLE_FROM_S = 0.6  # length of a note from which its vibrato is audible
SLOW_FROM_S = 0.3  # between notes of unknown length that may have one on an open string's pitch
LEAST_PRESS = 0.1  # variation of the finger force that asks for one
# It is narrower near the nut [Pop]: its share there, and from where on it is whole.
AT_NUT, WHOLE_FROM = 0.6, 6.0  # semitones above the open string
# The finger presses less far up the inner string, which its force would sharpen by more than a
# semitone: its share there, from where on it falls, and in how many semitones.
INNER_SHARE, INNER_FROM, INNER_WITHIN = 0.25, 2.0, 3.0
FADING_MS = 600.0  # after the last note
# How players of a section differ in rate, depth and delay of their vibrato, and its least factor.
OTHER_RATE, OTHER_DEPTH, OTHER_DELAY = 0.3, 0.9, 1.2
MIN_OTHER = 0.4
FRAMES_FROM = 3 << 30  # of the seed's numbers: those that frames have; `drift` has some before


@compiled_exactly
def set_vibrato(p: Any, c: Any) -> None:
    """Set depth, middle and rate of the vibrato as requested."""
    row = VIBRATOS[p.gesture.row]
    own = has_vibrato(p)
    cents, upward = row[CENTS] if own else requested_cents(p), row[UPWARD_SHARE] if own else 0.0
    if upward == 0.0:
        at = vibrato_row(p)
        cents = min(cents, p.vibrato_table[at, DEPTH_SHARE] * max(cents, DEFAULT_DEPTH_CENTS))
        upward = p.vibrato_table[at, CENTRE]
    hertz = row[HERTZ] if own else p.value[PLAYING.vibrato_rate]
    press = (row[PRESS_SHARE] if own else p.value[PLAYING.vibrato_press]) * press_share(p)
    move_parameter(p, c, VIBRATO.depth, cents * other_factor(p, 1, OTHER_DEPTH), DEFAULT_RAMP_MS)
    move_parameter(p, c, VIBRATO.press, press, DEFAULT_RAMP_MS)
    move_parameter(p, c, VIBRATO.upward, upward, DEFAULT_RAMP_MS)
    move_parameter(p, c, VIBRATO.rate, hertz * other_factor(p, 0, OTHER_RATE), DEFAULT_RAMP_MS)


@compiled_exactly
def begin_vibrato(p: Any, c: Any) -> None:
    """Fade in the vibrato of a new note; players of a section begin at other phases of it."""
    delay_ms = VIBRATOS[p.gesture.row, DELAY_MS] if has_vibrato(p) else requested_delay_ms(p)
    delay_ms *= other_factor(p, 2, OTHER_DELAY)
    if p.player_number != 0 and p.value[PLAYING.variation] > 0.0 and delay_ms > 0.0:
        c.vibrato = phase_of(p, c)
    move_parameter(p, c, VIBRATO.onset, 0.0 if delay_ms > 0.0 else 1.0, 0.0)
    if delay_ms > 0.0:
        move_parameter(p, c, VIBRATO.onset, 1.0, delay_ms)


@compiled_exactly
def end_vibrato(p: Any, c: Any) -> None:
    """Let the vibrato fade with the last note, or the finger would rock the string on for ever."""
    move_parameter(p, c, VIBRATO.onset, 0.0, FADING_MS)
    invalidate_sent(p, VIBRATO.onset)  # the next note may begin while it fades


@compiled_exactly
def has_vibrato(p: Any) -> bool:
    """Whether the note's articulation has a vibrato of its own."""
    return bool(HAS_VIBRATO[p.gesture.row])


@compiled_exactly
def is_sure(p: Any, c: Any, last: int) -> bool:
    """Whether a new note gets a vibrato that is heard: by phrasing in files, or as requested.

    Where its length is not known it does unless it comes soon after the frame `last`, at which the
    one before began.
    """
    if p.value[PLAYING.note_length] <= 0.0:
        is_slow = p.began < 0 or c.frame - last >= SLOW_FROM_S * p.rate
        return bool(is_slow and is_requested(p))
    is_long = p.value[PLAYING.note_length] >= AUDIBLE_FROM_S
    return bool(is_long and (is_requested(p) or (fingered(p) > 0.0 and not has_vibrato(p))))


@compiled_exactly
def is_requested(p: Any) -> bool:
    """Whether a parameter, an aftertouch or the articulation asks for a vibrato."""
    if has_vibrato(p):
        return bool(VIBRATOS[p.gesture.row, CENTS] > 0.0)
    return bool(p.value[PLAYING.vibrato] > 0.0 or p.value[PLAYING.vibrato_press] >= LEAST_PRESS)


@compiled_exactly
def requested_cents(p: Any) -> float:
    """Depth of the vibrato: as requested, else the player's own."""
    if p.value[PLAYING.vibrato] > 0.0:
        return float(p.value[PLAYING.vibrato])
    above = vibrated_pitch(p) - p.open_note[max(p.string, 0)]
    near = min(max(above / WHOLE_FROM, 0.0), 1.0)
    return float(fingered(p) * OWN_CENTS * (AT_NUT + (1.0 - AT_NUT) * near))


@compiled_exactly
def press_share(p: Any) -> float:
    """How much of a variation of the finger force is played."""
    if p.string != 0:
        return 1.0
    above = vibrated_pitch(p) - p.open_note[0]
    far = min(max((above - INNER_FROM) / INNER_WITHIN, 0.0), 1.0)
    return float(1.0 + (INNER_SHARE - 1.0) * far)


@compiled_exactly
def requested_delay_ms(p: Any) -> float:
    """Time in which the vibrato of a new note comes: as requested; the player's own comes late."""
    if p.value[PLAYING.vibrato] > 0.0 or fingered(p) == 0.0:
        return float(p.value[PLAYING.vibrato_delay])
    return float(max(p.value[PLAYING.vibrato_delay], OWN_DELAY_MS))


@compiled_exactly
def vibrated_pitch(p: Any) -> float:
    """The pitch (fractional MIDI note) that the vibrato is about, also before a slide is there."""
    if p.sounding < 0:
        return float(p.finger_pitch)
    return float(p.held_pitch[p.sounding] + p.value[PLAYING.bend])


@compiled_exactly
def vibrato_row(p: Any) -> int:
    """Row of ``vibrato_table`` for the note."""
    row = int(np.rint(2.0 * (vibrated_pitch(p) - p.open_note[0])))
    return min(max(row, 0), STEPS - 1)


@compiled_exactly
def other_factor(p: Any, number: int, varied: float) -> float:
    """A factor that each player of a section has for good; 1 for the first, or one alone.

    `number`: of what it is a factor on; `varied`: its standard deviation at full variation.
    """
    if p.player_number == 0:
        return 1.0
    differs = math.sqrt(3.0) * pseudorandom((p.player_number << 32) + number)
    return float(max(1.0 + p.value[PLAYING.variation] * varied * differs, MIN_OTHER))


@compiled_exactly
def phase_of(p: Any, c: Any) -> float:
    """Where the vibrato of a note that begins now starts, of one of a section (turns)."""
    return float(0.5 + 0.5 * chance(p, FRAMES_FROM + c.frame))
