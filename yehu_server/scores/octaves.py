"""Move the notes of a part by octaves into range, so that its tune keeps its shape.

The whole part moves so that the fewest notes are left outside the instrument's range; where some
are, a phrase may move otherwise, from rest to rest. What is outside still is left to the player,
who moves each note by itself, as in live playing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.note_range import YEHU, NoteRange

Array = Any

FARTHEST = 5  # octaves
OCTAVES = range(-FARTHEST, FARTHEST + 1)
NUMBERS = ("", "an octave", "two octaves", "three octaves", "four octaves", "five octaves")


class NoteSpans(NamedTuple):
    """Notes of parts that may be moved, in columns [shape=(notes,)]."""

    # When each sounds, in any unit.
    begin: Array
    end: Array
    # The lowest and the highest pitch of each; NaN where it has none.
    low: Array
    high: Array
    part: Array  # its number, counted from 0

    def where(self, chosen: Array) -> NoteSpans:
        """Those of a mask, or in the order of some places."""
        return NoteSpans(*(column[chosen] for column in self))


@dataclass(frozen=True)
class Octaves:
    """By how many octaves notes are moved."""

    of_notes: Array  # for each note
    whole: int  # of most of the part
    # Number of phrases, and of those that are moved otherwise.
    phrases: int
    others: int

    @property
    def summary(self) -> str:
        """The moves as text, such as "an octave up, 2 of 9 phrases otherwise"; empty for none."""
        words = []
        if self.whole:
            words.append(f"{NUMBERS[abs(self.whole)]} {'up' if self.whole > 0 else 'down'}")
        if self.others:
            how = "otherwise" if self.whole else "by octaves"
            words.append(f"{self.others} of {self.phrases} phrases {how}")
        return ", ".join(words)


NO_NOTES = Octaves(np.zeros(0, np.int64), 0, 0, 0)


def octaves_of(notes: NoteSpans, rest: float, within: NoteRange = YEHU) -> Octaves:
    """Return the octaves by which each note of a part is moved, as of `octaves_of_parts`."""
    return next(iter(octaves_of_parts(notes, rest, within)), NO_NOTES)


def octaves_of_parts(notes: NoteSpans, rest: float, within: NoteRange = YEHU) -> list[Octaves]:
    """Return the octaves by which each note of parts that have notes is moved.

    Notes come by part, then in the order of their beginnings. A silence of `rest`, in their unit,
    parts phrases; the instrument has the notes `within`.
    """
    if not len(notes.begin):
        return []
    _, part = np.unique(notes.part, return_inverse=True)
    ends, rank = np.unique(notes.end, return_inverse=True)
    offset = part * len(ends)  # so that the latest end is one of the same part
    until = ends[np.maximum.accumulate(offset + rank) - offset]
    is_new = np.diff(part, prepend=-1) > 0
    is_start = is_new.copy()
    is_start[1:] |= notes.begin[1:] - until[:-1] >= rest
    starts = np.flatnonzero(is_start)
    outside = outside_by_octaves(notes, starts, within)
    of_part = part[starts]
    firsts = np.flatnonzero(is_new[starts])
    whole = _best(np.add.reduceat(outside, firsts, axis=1), 0)
    own = _best(outside, whole[of_part])
    others = np.add.reduceat(own != whole[of_part], firsts, dtype=np.int64)
    counts = np.diff(firsts, append=len(own)), others
    of_notes = np.split(
        np.repeat(own, np.diff(starts, append=len(part))), np.flatnonzero(is_new)[1:]
    )
    columns = (column.tolist() for column in (whole, *counts))
    return [Octaves(*row) for row in zip(of_notes, *columns, strict=True)]


def _best(outside: Array, preferred: Array | int) -> Array:
    """The octaves that leave the fewest notes outside, and of these the nearest to `preferred`.

    `outside`: numbers of notes [shape=(2 FARTHEST + 1, groups)], by octaves from -FARTHEST.
    """
    by = np.array(OCTAVES)[:, None]
    farther = 2 * np.abs(by - preferred) + (by < preferred)  # of two as near the higher
    return (outside * 8 * FARTHEST + farther).argmin(axis=0) - FARTHEST


def outside_by_octaves(notes: NoteSpans, starts: Array, within: NoteRange) -> Array:
    """How many notes of groups are outside the range, moved by OCTAVES [shape=(octaves, groups)].

    Groups begin at some places. A note without pitches is not outside.
    """
    lowest, highest = within.lowest - OPEN_WITHIN, within.highest + OPEN_WITHIN
    return np.array([
        np.add.reduceat(
            (lowest - moved >= notes.low) | (notes.high >= highest - moved),
            starts,
            dtype=np.int64,
        )
        for moved in 12.0 * np.array(OCTAVES)
    ])  # fmt: skip
