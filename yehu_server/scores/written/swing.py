"""Play even notes unevenly: swing of MusicXML, hornpipes of ABC."""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from yehu_server.scores.written.ticks import Ticks, scaled
from yehu_server.scores.written.voices import RawNote


@dataclass(frozen=True)
class Swing:
    """How pairs of notes are played that are written even."""

    unit: Ticks  # of each as written
    first: int  # the first lasts so long
    second: int  # beside the second
    is_of_pairs: bool = False  # whether only two notes of one unit each are played so

    @property
    def delay(self) -> Ticks:
        """By how much the second is late."""
        return scaled(self.unit, Fraction(self.first - self.second, self.first + self.second))


def swing_notes(notes: Iterable[RawNote], swing: Swing, begin: Ticks = 0) -> None:
    """Delay what begins on an off-beat, and let the note before it last up to there.

    Beats are counted from `begin`. What is shorter than a unit, or follows such a note, stays even:
    the beat is divided otherwise there. So does abcjs where it is asked to swing; abc2midi, in
    hornpipes, asks for pairs.
    """
    unit, delay = swing.unit, swing.delay
    voices: dict[tuple[str, str], list[RawNote]] = {}
    for note in notes:
        voices.setdefault(note.voice, []).append(note)
    for voice in voices.values():
        before: RawNote | None = None
        small: list[RawNote] = []
        for note in sorted(voice, key=lambda each: (each.at, not each.is_grace)):
            if note.is_grace:
                small.append(note)
                continue
            at = note.at
            is_off = (at - begin) % (2 * unit) == unit and note.length >= unit
            is_pair = before is not None and before.at + unit == at and before.length == unit
            if swing.is_of_pairs:
                is_off &= is_pair and note.length == unit
            if is_off and (before is None or before.at <= at - unit):
                if before is not None and before.at + before.length == at:
                    before.length += delay
                for each in small:
                    each.at += delay if each.at == at else 0
                note.at, note.length = at + delay, note.length - delay
            before, small = note, []


def begin_of_beats(length: Ticks, before: Ticks, metre: Ticks) -> Ticks:
    """Where a bar's beats begin, since it does; an upbeat counts from its end."""
    return length - metre if length < metre and before < metre else 0
