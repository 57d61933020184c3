"""Notes in tune, each by itself or in a scale: `grid`, `isolated`, `chromatic`, and so on.

`grid` marks each note: `.` within 10 cents (open strings 12) from 0.1 s on; `a` in tune only
after a longer attack; a number is the final error in cents; `O` a higher register, `U` a lower
one, `?` no pitch. Under variation the mean of the partials from 0.4 s on counts.
"""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from measures.intonation import (
    CLOSE_CENTS,
    MOMENTS_S,
    NONE,
    SETTLED_S,
    SHARP_CENTS,
    bound,
    errors_of,
    judged,
    mean_off_by,
    off_by,
    overtones_off_by,
    worst,
)
from measures.loudness import centroid_hz
from measures.shares import Share, share
from measures.take import Setup, Take, held, in_parallel
from yehu_server.core.physics.default_quantities import Quantities, measured_body
from yehu_server.core.player.note_tables import OPEN_NOTES
from yehu_server.params.table import STRING_NAMES
from yehu_server.playing.pitch_and_level import a_weighted_db
from yehu_server.playing.preset_folders import Presets

VELOCITIES = (20, 50, 80, 110, 127)
WHEELS = (None, 0, 64, 127)
NOTE_S, SCALE_S = 0.8, 0.4
OVERLAP_S = 0.01
STEADY = MOMENTS_S.index(SETTLED_S)
STEADY_S, END_S = 0.45, 0.75
# Mod wheel (-1: untouched) and velocity.
STEADY_CASES = [(w, v) for w in (-1, 0, 32, 64, 96, 127) for v in (40, 60, 80, 100, 127)]
BODY = measured_body()
LIGHT_BRIDGE = Quantities(body=replace(BODY, mass=tuple(0.5 * mass for mass in BODY.mass)))
OTHERS: dict[str, dict[str, Any]] = {
    "as calibrated": {},
    "30 cents low": {"settings": {f"/string/{name}/tuning": -30.0 for name in STRING_NAMES}},
    "30 cents high": {"settings": {f"/string/{name}/tuning": 30.0 for name in STRING_NAMES}},
    "4 % more tension": {"tension": 1.04},  # 34 cents
    "bridge of half the mass": {"quantities": LIGHT_BRIDGE},  # of each mode, at its frequency
}
BOWED_S, PLUCKED_S = (0.3, 0.8), (0.05, 0.25)  # from and to, of notes of presets


def _of(setup: Setup) -> Callable[..., float]:
    """What finds the error of a note: under variation notes move."""
    return mean_off_by if setup.variation > 0.0 else off_by


def _mark(setup: Setup, note: int, wheel: int | None, velocity: int) -> str:
    """Play one note and return its mark in the grid."""
    sound, _ = held(setup, note, velocity, NOTE_S, wheel)
    if setup.variation > 0.0:
        found = [mean_off_by(sound, setup.rate, SETTLED_S, NOTE_S - SETTLED_S, note)]
        settled = found
    else:
        found = errors_of(sound, setup.rate, note, 0.0, NOTE_S)
        settled = found[STEADY:]
    if all(abs(error) <= bound(note) for error in found):
        return "."
    if all(abs(error) <= bound(note) for error in settled):
        return "a"
    if NONE in settled:
        return "?"
    middle = float(np.median(settled))
    if abs(middle) < 100.0:
        return f"{middle:+.0f}"
    return "O" if middle > 0.0 else "U"


def grid(setup: Setup) -> list[Share]:
    """Print the marks of all notes at five velocities and four places of the wheel."""
    jobs = [(n, w, v) for n in setup.notes for w in WHEELS for v in VELOCITIES]
    marks = in_parallel(setup, _mark, jobs)
    print("note   wheel untouched       wheel 0               wheel 64              wheel 127")
    per_note = len(WHEELS) * len(VELOCITIES)
    for row in range(0, len(jobs), per_note):
        cells = marks[row : row + per_note]
        groups = [cells[at : at + len(VELOCITIES)] for at in range(0, per_note, len(VELOCITIES))]
        lines = ["".join(f"{cell:>4}" for cell in group) for group in groups]
        print(f"{jobs[row][0]:4} {'  '.join(lines)}")
    return [share("in tune", (mark == "." for mark in marks))]


def _alone(setup: Setup, note: int) -> float:
    """Return the largest error (cents) of a note by itself."""
    sound, _ = held(setup, note, 80, NOTE_S)
    return worst(errors_of(sound, setup.rate, note, 0.0, NOTE_S))


def isolated(setup: Setup) -> list[Share]:
    """Print the notes that are out of tune when each is played alone."""
    notes = [(note,) for note in setup.notes]
    return [judged("alone", notes, in_parallel(setup, _alone, notes))]


def _scale(setup: Setup, notes: list[int], is_slurred: bool) -> list[float]:
    """Return the largest error (cents) of each note of a scale without rests."""
    take = Take(setup)
    for i, note in enumerate(notes):
        if i and not is_slurred:
            take.off(i * SCALE_S, notes[i - 1])
        take.on(i * SCALE_S, note)
        if i and is_slurred:
            take.off(i * SCALE_S + OVERLAP_S, notes[i - 1])
    sound = take.play(len(notes) * SCALE_S)
    return [
        worst(errors_of(sound, setup.rate, note, i * SCALE_S, SCALE_S, overtones_off_by))
        for i, note in enumerate(notes)
    ]


def chromatic(setup: Setup) -> list[Share]:
    """Print the notes that are out of tune in a chromatic scale up and down."""
    notes = [*setup.notes, *reversed(setup.notes[:-1])]
    found = in_parallel(setup, _scale, [(notes, False), (notes, True)])
    cases = [(note,) for note in notes]
    return [
        judged(name, cases, errors)
        for name, errors in zip(("separate", "slurred"), found, strict=True)
    ]


def _sustained(
    setup: Setup, note: float, wheel: int, velocity: int, start_s: float, how: dict[str, Any]
) -> tuple[float, bool]:
    """Return the error (cents) of a note in the steady state; and if its finger is at the nut."""
    place = None if wheel < 0 else wheel
    sound, take = held(setup, note, velocity, END_S, place, **how)
    return _of(setup)(sound, setup.rate, start_s, END_S - start_s, note), take.is_at_nut


def steady(setup: Setup) -> list[Share]:
    """Print the largest steady-state error of each note, from 0.45 s on."""
    start_s = setup.steady_s(STEADY_S)
    jobs: list[Any] = [(note, *case, start_s, {}) for note in setup.notes for case in STEADY_CASES]
    errors = [error for error, _ in in_parallel(setup, _sustained, jobs)]
    table = np.abs(np.array(errors)).reshape(len(setup.notes), len(STEADY_CASES))
    right = table <= np.array([[bound(note, CLOSE_CENTS)] for note in setup.notes])
    for note, row, is_right in zip(setup.notes, table, right, strict=True):
        print(
            f"{note}: {row.max():6.1f} cents at most, "
            f"{(~is_right).sum():2} over {bound(note, CLOSE_CENTS):g}"
        )
    return [share("in tune", right.flat)]


def quarters(setup: Setup) -> list[Share]:
    """Print the quarter tones that are out of tune, from 0.4 s on.

    They are fractional notes, as OSC and tunings ask for. Those that are sharp with the finger as
    near to the nut as it can be are apart: no finger reaches them on the string that the player
    chose.
    """
    cases = [(note + 0.5, *case) for note in setup.notes[:-1] for case in STEADY_CASES]
    found = in_parallel(setup, _sustained, [(*case, SETTLED_S, {}) for case in cases])
    parts: dict[bool, list[tuple[Any, float]]] = {False: [], True: []}
    for case, (error, is_at_nut) in zip(cases, found, strict=True):
        parts[is_at_nut and CLOSE_CENTS < error < SHARP_CENTS].append((case, error))
    return [
        judged(
            f"{'not ' if is_apart else ''}reached by a finger",
            [case for case, _ in part],
            [error for _, error in part],
            CLOSE_CENTS,
            counts=not is_apart,
        )
        for is_apart, part in parts.items()
    ]


def strings(setup: Setup) -> list[Share]:
    """Print the share of stopped notes in tune on each instrument, and the others."""
    cases = [
        (note, velocity) for note in setup.notes if note not in OPEN_NOTES for velocity in (50, 100)
    ]
    parts = []
    for name, how in OTHERS.items():
        jobs = [(note, -1, velocity, SETTLED_S, how) for note, velocity in cases]
        errors = [error for error, _ in in_parallel(setup, _sustained, jobs)]
        parts.append(judged(name, cases, errors, CLOSE_CENTS))
    return parts


def _in_preset(setup: Setup, preset: str, note: int, velocity: int) -> tuple[float, float, float]:
    """Return error (cents), loudness (dB, A-weighted) and spectral centroid (Hz) of a note."""
    is_plucked = preset == "pizzicato"
    start_s, end_s = PLUCKED_S if is_plucked else BOWED_S
    sound, _ = held(setup, note, velocity, end_s, preset=preset)
    from_s = start_s if is_plucked else setup.steady_s(start_s)
    error = _of(setup)(sound, setup.rate, from_s, end_s - from_s, note)
    heard = sound[round(start_s * setup.rate) :]
    return error, a_weighted_db(heard, setup.rate), centroid_hz(heard, setup.rate)


def presets(setup: Setup) -> list[Share]:
    """Print the results of each preset of a way to play, and its notes that are out of tune."""
    cases = [(note, velocity) for note in setup.notes for velocity in (30, 64, 110)]
    parts = []
    shipped = Presets(Path(os.devnull))
    for name in shipped.names():
        if shipped.load(name).is_room:
            continue
        found = in_parallel(setup, _in_preset, [(name, *case) for case in cases])
        errors, levels, middles = np.array(found).T
        print(
            f"{name}: {np.median(levels):.1f} dB (within {np.ptp(levels):.1f}), "
            f"{np.median(middles):.0f} Hz"
        )
        parts.append(judged(name, cases, errors))
    return parts
