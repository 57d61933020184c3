"""Detects notes, slides and dynamics in the pitch and level of a voice, as commands. Compiled.

A note begins when two successive hops agree, survives short unvoiced gaps, and ends with the voice.
Its pitch slides with the voice; a leap is another note, slurred; a level that falls and rises again
is a new stroke.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.tables import KEY_COUNT
from yehu_server.core.physics.elementary import elementwise, exp, log, log10
from yehu_server.core.player.commands import BEGIN, END, SLIDE, WRITE
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.core.player.notes import DYNAMICS_EXPONENT
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.player.right_hand import MIN_SPEED_FRACTION
from yehu_server.core.voice.pitch_detection import HOP_S, PITCH_DETECTOR, prepare_pitch_detector

# -- when it is sure ------------------------------------------------------------------------------
# Certainty from which a note begins, and below which a hop counts as unvoiced.
BEGIN_CERTAINTY, END_CERTAINTY = 0.88, 0.7
AGREE_SEMITONES = 0.6  # pitches of hops that agree
# Hops that agree on a note; on a leap, where both pitches are compared at first; on an octave.
BEGIN_HOPS, LEAP_HOPS, OCTAVE_LEAP_HOPS = 2, 4, 5
SETTLE_HOPS = 10  # age of a note up to which an octave is corrected like any leap
END_HOPS = 6  # unvoiced hops that end a note
LEAP_SEMITONES = 0.8  # from one hop to the next: no voice slides as fast
# -- the gate, dB of full scale: the level over the noise between notes at which a note begins.
# The noise is measured between notes: its estimate falls quickly and rises slowly.
OVER_NOISE_DB, GATE_HYSTERESIS_DB, MIN_GATE_DB = 10.0, 5.0, -65.0
NOISE_FALL_RATE, NOISE_RISE_RATE = 0.1, 0.01  # parts of the difference, by hop
# -- dynamics: full ones are at the highest level, which falls slowly.
MIN_FULL_DB, FULL_FALL_DB = -55.0, 0.5 * HOP_S
MIN_LEVEL_STEP_DB = 0.4  # dynamics less apart are the same
MIN_DYNAMICS = 0.03  # at which a note still speaks
# -- struck again: the level falls and rises so much, faster than it swells; a sound that stays
# like itself, as with the vibrato of a violin, has to rise by more.
FALL_DB, RISE_DB, SWELL_DB, PEAK_DB = 3.0, 5.0, 90.0 * HOP_S, 40.0 * HOP_S
STEADY_CERTAINTY, STEADY_RISE_DB = 0.9, 12.0
MIN_STROKE_HOPS = 12  # that a stroke lasts at least
# -- pitch
MAX_TRANSPOSE = 128.0  # semitones: a note is brought into range octave by octave
FIRST_NOTE_SEMITONES = 6.0  # above the lowest, about: tunes tend to rise from their first note
MIN_PITCH_STEP = 0.01  # semitones: pitches less apart are the same
RETARGET_SEMITONES = 0.2  # by which another pitch of the tuning must be nearer to be the target
# Up to so far over the open outer string, and from so far below the end of the inner: the string
# asked for.
ON_INNER, ON_OUTER = 2.5, 0.3
INNER, EITHER = 1.0, 0.0
VOICE_CHANNEL = -2  # the channel of its notes
VOICE_KEYS = (0.0, 1.0)  # which it has in turn: of two that are slurred, both are held for a moment
MAX_COMMANDS = 8


def dynamics_of(level_db: Any) -> Any:
    """The dynamics at a level (dB) below that of full ones, as ``player`` plays them."""
    dynamics = elementwise(exp, np.linspace(log(MIN_DYNAMICS), 0.0, 400))
    speed = MIN_SPEED_FRACTION + (1.0 - MIN_SPEED_FRACTION) * dynamics
    level = DYNAMICS_EXPONENT * elementwise(log10, dynamics) + elementwise(log10, speed)
    return np.interp(level_db, 20.0 * level, dynamics)


MIN_DB, STEPS_PER_DB = -60, 4  # by dB
BY_LEVEL = dynamics_of(np.arange(0, STEPS_PER_DB * MIN_DB, -1) / STEPS_PER_DB)

FOLLOWER = np.dtype(
    [
        ("rig", np.int64),  # address of the instrument that plays, where the input posts to it
        ("detector", PITCH_DETECTOR),
        # The instrument's lowest and highest note, and up to which pitch the inner string is
        # asked for, where it was not and where it was.
        ("lowest", np.float64),
        ("highest", np.float64),
        ("on_inner", np.float64),
        ("on_outer", np.float64),
        ("transpose", np.float64),  # semitones; NaN: by octaves, as the first note wants
        ("a4_offset", np.float64),  # how much 440 Hz is above the instrument's A4 (semitones)
        ("correct", np.float64),  # how far what is played is moved to the tuning: 0 to 1
        ("tuning", np.float64, KEY_COUNT),  # pitches of its keys; NaN for a key without one
        ("target_pitch", np.float64),  # the pitch of the tuning that it is moved to
        ("is_sounding", np.int64),  # whether a note sounds
        ("agreed_hops", np.int64),
        ("unvoiced_hops", np.int64),
        ("age", np.int64),  # of the stroke and of the note (hops)
        ("note_age", np.int64),
        ("last", np.float64),  # pitch of the last hop, and the one that is followed
        ("followed", np.float64),
        ("octaves", np.float64),  # semitones, of this note
        ("key", np.float64),  # of the note that sounds, of VOICE_KEYS
        ("played", np.float64),  # its pitch
        ("string", np.float64),
        ("dynamics_db", np.float64),
        ("noise_db", np.float64),
        ("full_db", np.float64),
        ("peak_db", np.float64),
        ("valley_db", np.float64),  # NaN: the level has not fallen
        ("previous_db", np.float64),  # the level of the previous hop since it fell
        ("min_certainty", np.float64),  # certainty since it fell
        # The commands of this hop.
        ("commands", np.int64),
        ("kind", np.int64, MAX_COMMANDS),
        ("index", np.int64, MAX_COMMANDS),
        ("value", np.float64, MAX_COMMANDS),
        ("other", np.float64, MAX_COMMANDS),
    ],
    align=True,
)


def ends_of(notes: NoteRange) -> dict[str, float]:
    """The fields of a follower for the notes of an instrument."""
    return {
        "lowest": float(notes.ends[0]),
        "highest": float(notes.ends[1]),
        "on_inner": float(notes.open_notes[1] + ON_INNER),
        "on_outer": float(notes.highest_notes[0] - ON_OUTER),
    }


OF_YEHU = tuple(ends_of(YEHU).values())


@compiled_exactly
def prepare_follower(f: Any, rate: float, transpose: float, correct: float) -> None:
    """Set up a record that is all 0 for a sound's rate (Hz); see its fields."""
    prepare_pitch_detector(f.detector, rate)
    f.lowest, f.highest, f.on_inner, f.on_outer = OF_YEHU
    f.transpose, f.target_pitch = transpose, math.nan
    if not math.isnan(transpose):
        f.transpose = min(max(transpose, -MAX_TRANSPOSE), MAX_TRANSPOSE)
    f.correct = min(max(correct, 0.0), 1.0) if math.isfinite(correct) else 0.0
    for key in range(KEY_COUNT):
        f.tuning[key] = key
    f.noise_db, f.full_db = MIN_GATE_DB, MIN_FULL_DB
    f.dynamics_db = f.string = math.nan


@compiled_exactly
def send(f: Any, kind: int, index: int, value: float, other: float) -> None:
    """Add a command to those of this hop."""
    n = f.commands
    f.kind[n], f.index[n], f.value[n], f.other[n] = kind, index, value, other
    f.commands = n + 1


@compiled_exactly
def update_note(f: Any) -> None:
    """Begin, move or end the note by the last hop: write commands. Real time: safe."""
    f.commands = 0
    h = f.detector
    f.full_db = max(f.full_db - FULL_FALL_DB, MIN_FULL_DB)
    if f.is_sounding == 0:
        await_note(f, h)
    elif h.certainty < END_CERTAINTY or h.level_db < gate_db(f) - GATE_HYSTERESIS_DB:
        f.unvoiced_hops += 1
        if f.unvoiced_hops >= END_HOPS:
            end(f)
    else:
        f.unvoiced_hops = 0
        track_voice(f, h)
    h.expected = f.followed if f.is_sounding != 0 else math.nan


@compiled_exactly
def gate_db(f: Any) -> float:
    """The level at which a note begins."""
    return float(max(f.noise_db + OVER_NOISE_DB, MIN_GATE_DB))


@compiled_exactly
def await_note(f: Any, h: Any) -> None:
    """Begin a note where a voice is detected."""
    if h.certainty < BEGIN_CERTAINTY or h.level_db < gate_db(f):
        share = NOISE_FALL_RATE if h.level_db < f.noise_db else NOISE_RISE_RATE
        f.noise_db += share * (h.level_db - f.noise_db)
        f.agreed_hops = 0
        return
    count_agreed(f, h.pitch)
    if f.agreed_hops >= BEGIN_HOPS:
        f.is_sounding, f.age, f.unvoiced_hops = 1, 0, 0
        f.peak_db, f.valley_db = h.level_db, math.nan
        set_dynamics(f, h)
        begin(f, h.pitch)


@compiled_exactly
def count_agreed(f: Any, pitch: float) -> None:
    """Count the successive hops whose pitches agree."""
    agrees = f.agreed_hops > 0 and abs(pitch - f.last) < AGREE_SEMITONES
    f.agreed_hops = f.agreed_hops + 1 if agrees else 1
    f.last = pitch


@compiled_exactly
def begin(f: Any, pitch: float) -> None:
    """Begin a note of a pitch, in range."""
    sharp = pitch + f.a4_offset
    if math.isnan(f.transpose):
        f.transpose = 12.0 * np.rint((f.lowest + FIRST_NOTE_SEMITONES - sharp) / 12.0)
    played = sharp + f.transpose
    f.octaves = 0.0
    while played + f.octaves < f.lowest - 0.5:
        f.octaves += 12.0
    while played + f.octaves > f.highest + 0.5:
        f.octaves -= 12.0
    f.followed, f.agreed_hops, f.note_age = pitch, 0, 0
    f.key, f.played = VOICE_KEYS[1] - f.key, played_pitch(f, pitch)
    choose_string(f)
    send(f, BEGIN, VOICE_CHANNEL, f.key, f.played)


@compiled_exactly
def played_pitch(f: Any, pitch: float) -> float:
    """The pitch that is played for a detected one."""
    played = pitch + f.a4_offset + f.transpose + f.octaves
    if f.correct > 0.0:
        nearest = nearest_of(f.tuning, played)
        if not abs(played - f.target_pitch) < abs(played - nearest) + RETARGET_SEMITONES:
            f.target_pitch = nearest
        played += f.correct * (f.target_pitch - played)
    return float(min(max(played, f.lowest), f.highest))


@compiled_exactly
def nearest_of(tuning: Any, pitch: float) -> float:
    """The pitch of a tuning that is nearest to another; that itself where there is none."""
    nearest, least = pitch, math.inf
    for key in range(KEY_COUNT):
        if abs(tuning[key] - pitch) < least:
            nearest, least = float(tuning[key]), abs(tuning[key] - pitch)
    return nearest


@compiled_exactly
def choose_string(f: Any) -> None:
    """Ask for the inner string where the open outer one would not follow a pitch."""
    string = INNER if f.played < (f.on_outer if f.string == INNER else f.on_inner) else EITHER
    if string != f.string:
        f.string = string
        send(f, WRITE, PLAYING.string, string, 0.0)


@compiled_exactly
def track_voice(f: Any, h: Any) -> None:
    """Go on with a note as the voice does."""
    f.age += 1
    f.note_age += 1
    set_dynamics(f, h)
    if is_struck_again(f, h.level_db, h.certainty):
        end(f)
        f.is_sounding, f.age = 1, 0
        begin(f, h.pitch)
        return
    moved = abs(h.pitch - f.followed)
    if moved < LEAP_SEMITONES:
        f.followed, f.agreed_hops = h.pitch, 0
        played = played_pitch(f, h.pitch)
        if abs(played - f.played) > MIN_PITCH_STEP:
            f.played = played
            choose_string(f)
            send(f, SLIDE, 0, played, 0.0)
        return
    count_agreed(f, h.pitch)
    by_octaves = abs(moved - 12.0 * np.rint(moved / 12.0)) < AGREE_SEMITONES
    by_octaves = by_octaves and f.note_age > SETTLE_HOPS
    if f.agreed_hops >= (OCTAVE_LEAP_HOPS if by_octaves else LEAP_HOPS):
        before = f.key
        begin(f, h.pitch)
        send(f, END, VOICE_CHANNEL, before, 0.0)


@compiled_exactly
def set_dynamics(f: Any, h: Any) -> None:
    """Play as loud as the voice is, against its loudest; noise does not count."""
    f.full_db = max(f.full_db, h.level_db)
    level = h.level_db - f.full_db
    if not abs(level - f.dynamics_db) < MIN_LEVEL_STEP_DB:
        f.dynamics_db = level
        step = min(int(-STEPS_PER_DB * level), len(BY_LEVEL) - 1)
        send(f, WRITE, PLAYING.dynamics, BY_LEVEL[step], 0.0)


@compiled_exactly
def is_struck_again(f: Any, level_db: float, certainty: float) -> bool:
    """Whether the level falls and rises as where a note is struck again."""
    f.peak_db = max(level_db, f.peak_db - PEAK_DB)
    if math.isnan(f.valley_db):
        if level_db < f.peak_db - FALL_DB:
            f.valley_db, f.min_certainty = level_db, certainty
        return False
    f.valley_db = min(level_db, f.valley_db + SWELL_DB)
    f.min_certainty = min(f.min_certainty, certainty)
    rise = level_db - f.valley_db
    if rise >= (RISE_DB if f.min_certainty < STEADY_CERTAINTY else STEADY_RISE_DB):
        f.valley_db, f.peak_db = math.nan, level_db
        return bool(f.age >= MIN_STROKE_HOPS)
    # As loud as before, and it rises no more.
    if rise >= RISE_DB and f.peak_db - FALL_DB < level_db < f.previous_db:
        f.valley_db = math.nan
    f.previous_db = level_db
    return False


@compiled_exactly
def end(f: Any) -> None:
    """End the note."""
    if f.is_sounding != 0:
        send(f, END, VOICE_CHANNEL, f.key, 0.0)
    f.is_sounding = f.agreed_hops = 0
