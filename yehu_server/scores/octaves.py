"""Move the notes of a part by octaves into range, so that its tune keeps its shape.

The whole part moves so that the fewest notes are left outside the instrument's range; where some
are, a phrase may move otherwise, from rest to rest. What is outside still is left to the player,
who moves each note by itself, as in live playing.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.note_range import YEHU, NoteRange

Array = Any

FARTHEST = 5  # octaves
OCTAVES = range(-FARTHEST, FARTHEST + 1)
NUMBERS = ("", "an octave", "two octaves", "three octaves", "four octaves", "five octaves")


class NoteSpan(NamedTuple):
    """A note to be moved: when it sounds, in any unit, and its pitches (MIDI notes)."""

    begin: float
    end: float
    pitches: tuple[float, ...]


@dataclass(frozen=True)
class Octaves:
    """By how many octaves notes are moved."""

    of_notes: tuple[int, ...]  # for each note
    whole: int  # of most of the part
    # Number of phrases, and of those that are moved otherwise.
    phrases: int
    others: int
    outside: int  # notes that are outside the range still

    @property
    def summary(self) -> str:
        """The moves as text, such as "an octave up, 2 of 9 phrases otherwise"; empty for none."""
        words = []
        if self.whole:
            words.append(f"{NUMBERS[abs(self.whole)]} {'up' if self.whole > 0 else 'down'}")
        if self.others:
            how = "otherwise" if self.whole else "by octaves"
            words.append(f"{self.others} of {self.phrases} phrases {how}")
        if self.outside and words:
            words.append(f"{self.outside} {'note' if self.outside == 1 else 'notes'} alone")
        return ", ".join(words)


def octaves_of(notes: Sequence[NoteSpan], rest: float, within: NoteRange = YEHU) -> Octaves:
    """Return the octaves by which each note is moved.

    Notes come in the order of their beginnings. A silence of `rest`, in their unit, parts phrases;
    the instrument has the notes `within`.
    """
    starts = _starts(notes, rest)
    if not starts:
        return Octaves((), 0, 0, 0, 0)
    outside = np.add.reduceat(_are_outside(notes, within), starts, axis=1, dtype=np.int64)
    whole = int(_best(outside.sum(axis=1), 0))
    own = _best(outside, whole)
    others, left = (own != whole).sum(), outside[own + FARTHEST, np.arange(len(own))].sum()
    of_notes = np.repeat(own, np.diff(starts, append=len(notes))).tolist()
    return Octaves(tuple(of_notes), whole, len(starts), int(others), int(left))


def _best(outside: Array, preferred: int) -> Array:
    """The octaves that leave the fewest notes outside, and of these the nearest to `preferred`.

    `outside`: numbers of notes [shape=(2 FARTHEST + 1, ...)], by octaves from -FARTHEST.
    """
    nearest = np.array(sorted(OCTAVES, key=lambda octaves: (abs(octaves - preferred), -octaves)))
    return nearest[outside[nearest + FARTHEST].argmin(axis=0)]


def _are_outside(notes: Sequence[NoteSpan], within: NoteRange) -> Array:
    """Whether each note is outside the range, moved by each of OCTAVES; one without pitches not."""
    kinds: dict[tuple[float, ...], int] = {}
    kind = np.array([kinds.setdefault(note.pitches, len(kinds)) for note in notes])
    low, high = (np.array([end(p, default=math.nan) for p in kinds]) for end in (min, max))
    moved = 12.0 * np.array(OCTAVES)[:, None]
    fits = (within.lowest - OPEN_WITHIN - moved < low) & (
        high < within.highest + OPEN_WITHIN - moved
    )
    return (~fits & ~np.isnan(low))[:, kind]


def _starts(notes: Sequence[NoteSpan], rest: float) -> list[int]:
    """The number of each phrase's first note."""
    starts: list[int] = []
    until = -math.inf
    for number, (begin, end, _) in enumerate(notes):
        if not starts or begin - until >= rest:
            starts.append(number)
            until = end
        elif end > until:
            until = end
    return starts
