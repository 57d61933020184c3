"""What practising plays: the notes of a fiddle on each string, and passages that they stand in."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.core.player.bowing import LAST_NOTE
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.core.player.note_tables import OPEN_NOTES

Array = Any

RESTS_S, FIRST_NOTES = (0.02, 0.12), 0.25  # s; share of notes with none before
HALF = 0.5  # semitones


@dataclass(frozen=True)
class Passage:
    """A note before, if there is one, and how the next is bowed."""

    before: int | None
    speed: float
    pressure: float
    is_slurred: bool
    rest_s: float


@dataclass(frozen=True)
class SearchedNote:
    """A note on a string, at one of PLACES, and the bowings that a search starts from.

    `note` is its name on a yehu, `notes` are those of the instrument; `moved` is that of the
    default place, with the bow moved to here.
    """

    string: int
    note: int
    place: int
    start: Array
    moved: Array | None = None
    notes: NoteRange = YEHU

    @property
    def above(self) -> int:
        """Semitones by which it sounds higher than on a yehu."""
        return self.notes.open_notes[self.string] - OPEN_NOTES[self.string]

    @property
    def sounds(self) -> int:
        """The note that it is."""
        return self.note + self.above

    @property
    def is_open(self) -> bool:
        """Whether no finger tunes it."""
        return self.note == OPEN_NOTES[self.string]

    @property
    def is_high_on_inner(self) -> bool:
        """Whether it is played on the inner string only where that is asked for, or near."""
        return self.string == 0 and self.sounds >= self.notes.open_notes[1]


def stops_of(notes: NoteRange) -> list[tuple[int, int]]:
    """The notes practised on each string, by the names that they have on a yehu.

    What is bent above the first's goes to the other.
    """
    stops = []
    for string, (first, reach) in enumerate(zip(OPEN_NOTES, notes.reaches, strict=True)):
        above = notes.open_notes[string] - first
        last = min(first + math.ceil(reach), LAST_NOTE, notes.highest - above)
        stops += [(string, note) for note in range(first, last + 1)]
    return stops


def pitches_near_notes(
    tuning: Callable[[float], float | None], notes: NoteRange = YEHU
) -> dict[int, float]:
    """The pitch of a tuning that is nearest to each note, within a quarter tone; else the note."""
    keys = (tuning(float(key)) for key in range(128))
    pitches = [pitch for pitch in keys if pitch is not None]
    found = {}
    for note in range(notes.lowest, notes.highest + 1):
        nearest = min(pitches, key=lambda pitch: abs(pitch - note), default=float(note))
        found[note] = nearest if abs(nearest - note) <= HALF else float(note)
    return found


def passages_of(
    search: SearchedNote,
    seed: int,
    count: int,
    speeds: tuple[float, ...],
    pressures: tuple[float, ...],
) -> list[Passage]:
    """Passages of a note, drawn by a seed, with all speeds and pressures as often as each other."""
    chance = np.random.default_rng(seed)
    notes = search.notes
    highest = math.floor(notes.highest_notes[0]) if search.is_high_on_inner else notes.highest
    # In turn, so that a few passages have them all.
    bows = chance.permutation([(speed, pressure) for speed in speeds for pressure in pressures])
    befores = [note for note in range(notes.lowest, highest + 1) if note != search.sounds]
    return [
        Passage(
            before=None if chance.random() < FIRST_NOTES else int(chance.choice(befores)),
            speed=float(bows[i % len(bows), 0]),
            pressure=float(bows[i % len(bows), 1]),
            is_slurred=bool(chance.integers(2)),
            rest_s=float(chance.choice(RESTS_S)),
        )
        for i in range(count)
    ]
