"""`tunes`: fast tunes, slurred and in separate strokes: notes in tune in their second half.

A note is slurred to the next unless that repeats it. Separate notes have no rest between them.

The second half of a sixteenth is 62 ms at 120 quarters a minute, and 43 ms at 172. There what rings
of the notes before is part of the sound, so the pitch is that of the harmonics (`intonation`). On
sawtooth waves of 65 to 89 at 44.1, 48 and 96 kHz, with noise 40 dB below, its error is 0.4 cents at
most; beside a fifth above, 6 dB below the note, 1.5 cents (tests/test_measures.py).
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from tunes.shi_bei_jiu import make_notes

from measures.intonation import judged, overtones_off_by
from measures.shares import Share
from measures.take import Setup, Take, in_parallel

SIXTEENTHS_S = (0.125, 0.087)
OVERLAP_S = 0.01
FILE = Path(__file__).parents[1] / "tunes" / "fast.toml"


@dataclass(frozen=True)
class Note:
    """A note of a tune; start and length in sixteenths."""

    pitch: int
    start: int
    length: int


def read(sixteenths: str) -> list[Note]:
    """Return the notes of a tune of the file."""
    notes: list[Note] = []
    for slot, pitch in enumerate(map(int, sixteenths.split())):
        if pitch == 0:
            before = notes.pop()
            notes.append(Note(before.pitch, before.start, before.length + 1))
        else:
            notes.append(Note(pitch, slot, 1))
    return notes


def all_tunes() -> dict[str, list[Note]]:
    """Return the notes of each tune."""
    example = [Note(note.pitch, note.slot, note.slots) for note in make_notes()]
    with FILE.open("rb") as file:
        own = {name: read(data["sixteenths"]) for name, data in tomllib.load(file).items()}
    return {"Shi Bei Jiu": example, **own}


def _errors(setup: Setup, notes: list[Note], slot_s: float, is_slurred: bool) -> list[float]:
    """Play a tune; return the error (cents) of each note in its second half."""
    take = Take(setup)
    before: Note | None = None
    for note in notes:
        start_s = note.start * slot_s
        overlap_s = OVERLAP_S if before and is_slurred and before.pitch != note.pitch else 0.0
        if before and not overlap_s:
            take.off(start_s, before.pitch)
        take.on(start_s, note.pitch)
        if before and overlap_s:
            take.off(start_s + overlap_s, before.pitch)
        before = note
    sound = take.play((notes[-1].start + notes[-1].length) * slot_s)
    return [
        overtones_off_by(
            sound,
            setup.rate,
            (note.start + 0.5 * note.length) * slot_s,
            0.5 * note.length * slot_s,
            note.pitch,
        )
        for note in notes
    ]


def tunes(setup: Setup) -> list[Share]:
    """Print the notes of each tune that are out of tune: pitch, number and error (cents)."""
    ways = [
        (name, notes, slot_s, is_slurred)
        for name, notes in all_tunes().items()
        for slot_s in SIXTEENTHS_S
        for is_slurred in (True, False)
    ]
    found = in_parallel(setup, _errors, [way[1:] for way in ways])
    parts = []
    for (name, notes, slot_s, is_slurred), errors in zip(ways, found, strict=True):
        how = "slurred" if is_slurred else "separate"
        cases = [(note.pitch, number) for number, note in enumerate(notes, start=1)]
        parts.append(judged(f"{name}, {1e3 * slot_s:.0f} ms, {how}", cases, errors))
    return parts
