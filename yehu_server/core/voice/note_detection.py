"""Detects notes, slides and dynamics in the pitch and level of a voice, as commands. Compiled.

A note begins where two hearings agree, goes on through a short doubt, and ends with the voice. Its
pitch slides with the voice; a leap is another note, slurred; a level that falls and rises again is
a new stroke.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.tables import KEYS
from yehu_server.core.physics.elementary import each, exp, log, log10
from yehu_server.core.player.commands import BEGIN, END, SLIDE, WRITE
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.core.player.notes import DYNAMICS_EXPONENT
from yehu_server.core.player.parameter_indices import DYNAMICS, STRING
from yehu_server.core.player.right_hand import MIN_SPEED_FRACTION
from yehu_server.core.voice.pitch_detection import HEARING, HOP_S, prepare_hearing

# -- when it is sure ------------------------------------------------------------------------------
SURE, UNSURE = 0.88, 0.7  # certainty from which a note begins, and below which it is in doubt
AGREED = 0.6  # semitones: hearings that agree
# Hearings that agree on a note; a leap, where both pitches are compared at first; an octave.
BEGINS, LEAPS, LEAPS_OCTAVES = 2, 4, 5
SETTLED = 10  # hearings, up to which an octave is corrected like any leap
DOUBTED = 6  # hearings without a voice that end a note
LEAP = 0.8  # semitones from one hearing to the next that no voice slides
# -- the gate, dB of full scale: the level over the noise between notes at which a note begins.
# The noise is what is heard there, quickly if it is less, slowly if more.
OVER_NOISE_DB, CLOSES_DB, MIN_GATE_DB = 10.0, 5.0, -65.0
FALLS, RISES = 0.1, 0.01  # parts of the difference, by hearing
# -- dynamics: full ones are at the highest level, which is forgotten slowly.
MIN_FULL_DB, FORGOTTEN_DB = -55.0, 0.5 * HOP_S
FELT_DB = 0.4  # dynamics less apart are the same
MIN_DYNAMICS = 0.03  # at which a note still speaks
# -- struck again: the level falls and rises so much, faster than it swells; a sound that stays
# like itself meanwhile, as with the vibrato of a violin, rises by more.
FALL_DB, RISE_DB, SWELL_DB, PEAK_DB = 3.0, 5.0, 90.0 * HOP_S, 40.0 * HOP_S
ALIKE, ALIKE_RISE_DB = 0.9, 12.0
STROKE = 12  # hearings that a stroke lasts at least
# -- pitch
START = 6.0  # above the lowest: where the first note comes near to, from which tunes tend to rise
FELT = 0.01  # semitones: pitches less apart are the same
STAYS = 0.2  # semitones by which another pitch of the tuning is nearer, before it is aimed at
# Up to so far over the open outer string, and from so far below the end of the inner: the string
# asked for.
ON_INNER, ON_OUTER = 2.5, 0.3
INNER, EITHER = 1.0, 0.0
VOICE = -2  # the channel of its notes
VOICE_KEYS = (0.0, 1.0)  # which it has in turn: of two that are slurred, both are held for a moment
MAX_COMMANDS = 8


def dynamics_of(level_db: Any) -> Any:
    """The dynamics that are so many dB below full ones, as ``player`` plays them."""
    dynamics = each(exp, np.linspace(log(MIN_DYNAMICS), 0.0, 400))
    speed = MIN_SPEED_FRACTION + (1.0 - MIN_SPEED_FRACTION) * dynamics
    level = DYNAMICS_EXPONENT * each(log10, dynamics) + each(log10, speed)
    return np.interp(level_db, 20.0 * level, dynamics)


MIN_DB, STEPS = -60, 4  # by dB
BY_LEVEL = dynamics_of(np.arange(0, STEPS * MIN_DB, -1) / STEPS)

FOLLOWER = np.dtype(
    [
        ("rig", np.int64),  # address of the instrument that plays, where the input posts to it
        ("hearing", HEARING),
        # Of the instrument: its lowest and highest note, and up to which pitch the inner string is
        # asked for, where it was not and where it was.
        ("lowest", np.float64),
        ("highest", np.float64),
        ("on_inner", np.float64),
        ("on_outer", np.float64),
        ("transpose", np.float64),  # semitones; NaN: by octaves, as the first note wants
        ("sharper", np.float64),  # how much 440 Hz is above the instrument's A4 (semitones)
        ("correct", np.float64),  # how far what is played is moved to the tuning: 0 to 1
        ("tuning", np.float64, KEYS),  # pitches of its keys; NaN for a key without one
        ("aim", np.float64),  # the pitch of the tuning that it is moved to
        ("is_open", np.int64),  # whether a note sounds
        ("agreed", np.int64),  # hearings
        ("doubted", np.int64),
        ("age", np.int64),  # of the stroke and of the note, in hearings
        ("note_age", np.int64),
        ("last", np.float64),  # pitch that was heard last, and the one that is followed
        ("heard", np.float64),
        ("octaves", np.float64),  # semitones, of this note
        ("key", np.float64),  # of the note that sounds, of VOICE_KEYS
        ("played", np.float64),  # its pitch
        ("string", np.float64),
        ("dynamics_db", np.float64),
        ("noise_db", np.float64),
        ("full_db", np.float64),
        ("peak_db", np.float64),
        ("valley_db", np.float64),  # NaN: the level has not fallen
        ("before_db", np.float64),  # the level of the last hearing since it fell
        ("least", np.float64),  # certainty since it fell
        # What it has come to, in this hearing.
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
    prepare_hearing(f.hearing, rate)
    f.lowest, f.highest, f.on_inner, f.on_outer = OF_YEHU
    f.transpose, f.correct, f.aim = transpose, correct, math.nan
    for key in range(KEYS):
        f.tuning[key] = key
    f.noise_db, f.full_db = MIN_GATE_DB, MIN_FULL_DB
    f.dynamics_db = f.string = math.nan


@compiled_exactly
def send(f: Any, kind: int, index: int, value: float, other: float) -> None:
    """Add a command to those of this hearing."""
    n = f.commands
    f.kind[n], f.index[n], f.value[n], f.other[n] = kind, index, value, other
    f.commands = n + 1


@compiled_exactly
def decide(f: Any) -> None:
    """Decide what the last hearing comes to. Real time: safe."""
    f.commands = 0
    h = f.hearing
    f.full_db = max(f.full_db - FORGOTTEN_DB, MIN_FULL_DB)
    if f.is_open == 0:
        await_note(f, h)
    elif h.certainty < UNSURE or h.level_db < gate_db(f) - CLOSES_DB:
        f.doubted += 1
        if f.doubted >= DOUBTED:
            end(f)
    else:
        f.doubted = 0
        follow(f, h)
    h.expected = f.heard if f.is_open != 0 else math.nan


@compiled_exactly
def gate_db(f: Any) -> float:
    """The level at which a note begins."""
    return float(max(f.noise_db + OVER_NOISE_DB, MIN_GATE_DB))


@compiled_exactly
def await_note(f: Any, h: Any) -> None:
    """Begin a note where a voice is heard."""
    if h.certainty < SURE or h.level_db < gate_db(f):
        share = FALLS if h.level_db < f.noise_db else RISES
        f.noise_db += share * (h.level_db - f.noise_db)
        f.agreed = 0
        return
    f.agreed = f.agreed + 1 if f.agreed > 0 and abs(h.pitch - f.last) < AGREED else 1
    f.last = h.pitch
    if f.agreed >= BEGINS:
        f.is_open, f.age, f.doubted = 1, 0, 0
        f.peak_db, f.valley_db = h.level_db, math.nan
        set_dynamics(f, h)
        begin(f, h.pitch)


@compiled_exactly
def begin(f: Any, pitch: float) -> None:
    """Begin a note of a pitch, in range."""
    sharp = pitch + f.sharper
    if math.isnan(f.transpose):
        f.transpose = 12.0 * np.rint((f.lowest + START - sharp) / 12.0)
    played = sharp + f.transpose
    f.octaves = 0.0
    while played + f.octaves < f.lowest - 0.5:
        f.octaves += 12.0
    while played + f.octaves > f.highest + 0.5:
        f.octaves -= 12.0
    f.heard, f.agreed, f.note_age = pitch, 0, 0
    f.key, f.played = VOICE_KEYS[1] - f.key, playable(f, pitch)
    choose_string(f)
    send(f, BEGIN, VOICE, f.key, f.played)


@compiled_exactly
def playable(f: Any, pitch: float) -> float:
    """The pitch that is played for one that is heard."""
    played = pitch + f.sharper + f.transpose + f.octaves
    if f.correct > 0.0:
        nearest = nearest_of(f.tuning, played)
        if not abs(played - f.aim) < abs(played - nearest) + STAYS:
            f.aim = nearest
        played += f.correct * (f.aim - played)
    return float(min(max(played, f.lowest), f.highest))


@compiled_exactly
def nearest_of(tuning: Any, pitch: float) -> float:
    """The pitch of a tuning that is nearest to another; that itself where there is none."""
    nearest, least = pitch, math.inf
    for key in range(KEYS):
        if abs(tuning[key] - pitch) < least:
            nearest, least = float(tuning[key]), abs(tuning[key] - pitch)
    return nearest


@compiled_exactly
def choose_string(f: Any) -> None:
    """Ask for the inner string where the open outer one would not follow a pitch."""
    string = INNER if f.played < (f.on_outer if f.string == INNER else f.on_inner) else EITHER
    if string != f.string:
        f.string = string
        send(f, WRITE, STRING, string, 0.0)


@compiled_exactly
def follow(f: Any, h: Any) -> None:
    """Go on with a note as the voice does."""
    f.age += 1
    f.note_age += 1
    set_dynamics(f, h)
    if is_struck_again(f, h.level_db, h.certainty):
        end(f)
        f.is_open, f.age = 1, 0
        begin(f, h.pitch)
        return
    moved = abs(h.pitch - f.heard)
    if moved < LEAP:
        f.heard, f.agreed = h.pitch, 0
        played = playable(f, h.pitch)
        if abs(played - f.played) > FELT:
            f.played = played
            choose_string(f)
            send(f, SLIDE, 0, played, 0.0)
        return
    f.agreed = f.agreed + 1 if f.agreed > 0 and abs(h.pitch - f.last) < AGREED else 1
    f.last = h.pitch
    by_octaves = abs(moved - 12.0 * np.rint(moved / 12.0)) < AGREED and f.note_age > SETTLED
    if f.agreed >= (LEAPS_OCTAVES if by_octaves else LEAPS):
        before = f.key
        begin(f, h.pitch)
        send(f, END, VOICE, before, 0.0)


@compiled_exactly
def set_dynamics(f: Any, h: Any) -> None:
    """Play as loud as the voice is, against its loudest; what is no voice does not count."""
    f.full_db = max(f.full_db, h.level_db)
    level = h.level_db - f.full_db
    if not abs(level - f.dynamics_db) < FELT_DB:
        f.dynamics_db = level
        step = min(int(-STEPS * level), len(BY_LEVEL) - 1)
        send(f, WRITE, DYNAMICS, BY_LEVEL[step], 0.0)


@compiled_exactly
def is_struck_again(f: Any, level_db: float, certainty: float) -> bool:
    """Whether the level falls and rises as where a note is struck again."""
    f.peak_db = max(level_db, f.peak_db - PEAK_DB)
    if math.isnan(f.valley_db):
        if level_db < f.peak_db - FALL_DB:
            f.valley_db, f.least = level_db, certainty
        return False
    f.valley_db = min(level_db, f.valley_db + SWELL_DB)
    f.least = min(f.least, certainty)
    rise = level_db - f.valley_db
    if rise >= (RISE_DB if f.least < ALIKE else ALIKE_RISE_DB):
        f.valley_db, f.peak_db = math.nan, level_db
        return bool(f.age >= STROKE)
    # As loud as before, and it rises no more.
    if rise >= RISE_DB and f.peak_db - FALL_DB < level_db < f.before_db:
        f.valley_db = math.nan
    f.before_db = level_db
    return False


@compiled_exactly
def end(f: Any) -> None:
    """End the note."""
    if f.is_open != 0:
        send(f, END, VOICE, f.key, 0.0)
    f.is_open = f.agreed = 0
