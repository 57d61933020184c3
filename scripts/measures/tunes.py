"""`tunes`, `detached`: fast tunes, slurred and in separate strokes: in tune in their second half.

A note is slurred to the next unless that repeats it. Separate notes have no rest between them;
detached ones are lifted after a share of their time.

The second half of a sixteenth is 62 ms at 120 quarters a minute, and 43 ms at 172. There what rings
of the notes before is part of the sound, so the pitch is that of the harmonics (`intonation`). On
sawtooth waves of 65 to 89 at 44.1, 48 and 96 kHz, with noise 40 dB below, its error is 0.4 cents at
most; beside a fifth above, 6 dB below the note, 1.5 cents.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from measures.intonation import judged, overtones_off_by
from measures.shares import Share
from measures.take import Setup, Take, in_parallel

SIXTEENTHS_S = (0.125, 0.087)
DETACHED_S, HELD = (0.125, 0.087, 0.0625), (1.0, 0.6)  # sixteenths; share of each that is held
OVERLAP_S = 0.01
FILE = Path(__file__).with_name("fast.toml")


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
    with FILE.open("rb") as file:
        return {name: read(data["sixteenths"]) for name, data in tomllib.load(file).items()}


def _errors(
    setup: Setup, notes: list[Note], slot_s: float, is_slurred: bool, held: float = 1.0
) -> list[float]:
    """Play a tune; return the error (cents) of each note in the second half of what is held."""
    take = Take(setup)
    before: Note | None = None
    for note in notes:
        start_s = note.start * slot_s
        overlap_s = OVERLAP_S if before and is_slurred and before.pitch != note.pitch else 0.0
        if before and not overlap_s:
            take.off((before.start + held * before.length) * slot_s, before.pitch)
        take.on(start_s, note.pitch)
        if before and overlap_s:
            take.off(start_s + overlap_s, before.pitch)
        before = note
    sound = take.play((notes[-1].start + notes[-1].length) * slot_s)
    return [
        overtones_off_by(
            sound,
            setup.rate,
            (note.start + 0.5 * held * note.length) * slot_s,
            0.5 * held * note.length * slot_s,
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


def detached(setup: Setup) -> list[Share]:
    """Print the same of separate strokes alone, at three tempi, whole and lifted early."""
    found = []
    for slot_s in DETACHED_S:
        for held in HELD:
            jobs = [(notes, slot_s, False, held) for notes in all_tunes().values()]
            errors = in_parallel(setup, _errors, jobs)
            cases = [note.pitch for notes, *_ in jobs for note in notes]
            what = f"{1.0 / slot_s:.1f} a second, held for {100.0 * held:.0f} %"
            found.append(
                judged(what, [(pitch,) for pitch in cases], [e for own in errors for e in own])
            )
    return found
