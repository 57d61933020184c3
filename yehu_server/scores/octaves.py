"""Move the notes of a part by octaves into range, so that its tune keeps its shape.

The whole part moves so that the fewest notes are left outside the instrument's range; where some
are, a phrase may move otherwise, from rest to rest. What is outside still is left to the player,
who moves each note by itself, as in live playing.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.note_range import YEHU, NoteRange

FARTHEST = 5  # octaves
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
    of_all = _ends(notes)
    whole = _best(of_all, 0, within)
    phrases = _phrases(notes, rest)
    of_notes: list[int] = []
    others = outside = 0
    for phrase in phrases:
        ends = of_all if len(phrases) == 1 else _ends(phrase)
        own = _best(ends, whole, within)
        others += own != whole
        outside += _outside(ends, own, within)
        of_notes += [own] * len(phrase)
    return Octaves(tuple(of_notes), whole, len(phrases), others, outside)


_Ends = Mapping[tuple[float, float], int]


def _ends(notes: Sequence[NoteSpan]) -> _Ends:
    """How many notes have each lowest and highest pitch; those without a pitch are left out."""
    ends: Counter[tuple[float, float]] = Counter()
    for pitches, count in Counter(n.pitches for n in notes if n.pitches).items():
        ends[min(pitches), max(pitches)] += count
    return ends


def _best(ends: _Ends, preferred: int, within: NoteRange) -> int:
    """The octaves that leave the fewest notes outside, and of these the nearest to `preferred`."""

    def cost(octaves: int) -> tuple[int, int, int]:
        return _outside(ends, octaves, within), abs(octaves - preferred), -octaves

    if not _outside(ends, preferred, within):
        return preferred
    return min(range(-FARTHEST, FARTHEST + 1), key=cost)


def _outside(ends: _Ends, octaves: int, within: NoteRange) -> int:
    """Number of notes outside the range, when moved by so many octaves."""
    lowest = within.lowest - OPEN_WITHIN - 12.0 * octaves
    highest = within.highest + OPEN_WITHIN - 12.0 * octaves
    return sum(count for (low, high), count in ends.items() if not lowest < low <= high < highest)


def _phrases(notes: Sequence[NoteSpan], rest: float) -> list[list[NoteSpan]]:
    phrases: list[list[NoteSpan]] = []
    end = 0.0
    for note in notes:
        if not phrases or note.begin - end >= rest:
            phrases.append([])
            end = note.end
        phrases[-1].append(note)
        end = max(end, note.end)
    return phrases
