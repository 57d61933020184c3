"""`grid`, `isolated`, `chromatic`: notes in tune from 0.1 s on.

`grid` marks each note: `.` within 10 cents (open strings 12) from 0.1 s on; `a` in tune only
after a longer attack; a number is the final error in cents; `O` a higher register, `U` a lower
one, `?` no pitch. Under variation the mean from 0.4 s on counts.
"""

from __future__ import annotations

import numpy as np

from measures.intonation import (
    MOMENTS_S,
    NONE,
    SETTLED_S,
    bound,
    errors_of,
    in_words,
    off_by,
    worst,
)
from measures.overtones import overtones_off_by
from measures.shares import Share, share, share_line
from measures.take import NOTES, Setup, Take, in_parallel

VELOCITIES = (20, 50, 80, 110, 127)
WHEELS = (None, 0, 64, 127)
NOTE_S, SCALE_S = 0.8, 0.4
OVERLAP_S = 0.01
STEADY = MOMENTS_S.index(SETTLED_S)


def _mark(setup: Setup, note: int, wheel: int | None, velocity: int) -> str:
    """Play one note and return its mark in the grid."""
    take = Take(setup)
    take.wheel(wheel)
    take.on(0.0, note, velocity)
    sound = take.play(NOTE_S)
    if setup.variation > 0.0:
        found = [off_by(sound, setup.rate, SETTLED_S, NOTE_S - SETTLED_S, note)]
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
    jobs = [(n, w, v) for n in NOTES for w in WHEELS for v in VELOCITIES]
    marks = in_parallel(setup, _mark, jobs)
    print("note   wheel untouched       wheel 0               wheel 64              wheel 127")
    per_note = len(WHEELS) * len(VELOCITIES)
    for row in range(0, len(jobs), per_note):
        cells = marks[row : row + per_note]
        groups = [cells[at : at + len(VELOCITIES)] for at in range(0, per_note, len(VELOCITIES))]
        lines = ["".join(f"{cell:>4}" for cell in group) for group in groups]
        print(f"{jobs[row][0]:4} {'  '.join(lines)}")
    return [share("in tune", (mark == "." for mark in marks))]


def _told(what: str, notes: list[int], errors: list[float]) -> Share:
    right = [abs(error) <= bound(note) for note, error in zip(notes, errors, strict=True)]
    words = [f"{note} {in_words(error)}" for note, error in zip(notes, errors, strict=True)]
    return share_line(what, right, words)


def _alone(setup: Setup, note: int) -> float:
    """Return the largest error (cents) of a note by itself."""
    take = Take(setup)
    take.on(0.0, note)
    return worst(errors_of(take.play(NOTE_S), setup.rate, note, 0.0, NOTE_S))


def isolated(setup: Setup) -> list[Share]:
    """Print the notes that are out of tune when each is played alone."""
    return [_told("alone", list(NOTES), in_parallel(setup, _alone, [(note,) for note in NOTES]))]


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
    notes = [*NOTES, *reversed(NOTES[:-1])]
    found = in_parallel(setup, _scale, [(notes, False), (notes, True)])
    return [
        _told(name, notes, errors)
        for name, errors in zip(("separate", "slurred"), found, strict=True)
    ]
