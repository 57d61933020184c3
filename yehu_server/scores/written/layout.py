"""A written score as a page has it: bars, notes cut at their lines, names of pitches."""

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

from yehu_server.scores.written.notated import (
    LONGEST_CHANGE,
    Note,
    Part,
    Sign,
    Span,
    Tempo,
    Written,
)
from yehu_server.scores.written.words import WRITTEN_CHANGES

LETTERS = "CDEFGAB"
STEPS = (0, 2, 4, 5, 7, 9, 11)  # semitones of the letters above C
SEMITONES = dict(zip(LETTERS, STEPS, strict=True))
FIFTHS = (0, 2, 4, -1, 1, 3, 5)  # the letters on the line of fifths
CENTRE = 2  # of a key's seven notes on that line, from its do
TUPLETS = {3: 2, 5: 4, 7: 4}  # so many notes in the time of so many
FINEST = 16  # of a quarter: the shortest note that is drawn
MAX_PAGE_BARS = 20_000
METRE_UNITS = (4, 8, 16, 32)


@dataclass(frozen=True)
class PageBar:
    """A bar: where it begins and ends, its number, and the quarters that its metre has."""

    begin: Fraction
    end: Fraction
    number: str
    quarters: Fraction

    @property
    def length(self) -> Fraction:
        """Quarters that are in it."""
        return self.end - self.begin


@dataclass(frozen=True)
class Piece:
    """A note or a part of one, tied to the others; or, without a note, a rest."""

    begin: Fraction
    length: Fraction
    note: Note | None = None
    is_first: bool = True
    is_last: bool = True

    @property
    def end(self) -> Fraction:
        """The beat at which it ends."""
        return self.begin + self.length

    @property
    def factor(self) -> Fraction:
        """The tuplet that it is in, as a factor of its length."""
        count = tuplet_of(self.length.denominator)
        return Fraction(TUPLETS[count], count) if count in TUPLETS else Fraction(1)


def page_bars(written: Written) -> list[PageBar]:
    """Return the bars of a score, up to the end of its last note."""
    begins = _begins(written)
    metres = [_quarters_at(written, begin) for begin, _ in begins]
    if len(begins) > 1:
        pickup = begins[1][0] - begins[0][0]
        if metres[0] == pickup < metres[1]:  # a short first bar, which some call a metre
            metres[0] = metres[1]
    found: list[PageBar] = []
    for at, ((begin, number), quarters) in enumerate(zip(begins, metres, strict=True)):
        if at + 1 < len(begins):
            end = begins[at + 1][0]
        else:
            end = max(begin + quarters, written.end)
            rest = quarters - found[0].length if found else Fraction(0)
            if rest > 0 and written.end == begin + rest:  # an upbeat completes it
                end = written.end
        found.append(PageBar(begin, end, number, quarters))
    return found


def _begins(written: Written) -> list[tuple[Fraction, str]]:
    if written.bars:
        places = {bar.beat: bar.number for bar in reversed(written.bars)}
        return sorted(places.items())
    metres = {Fraction(metre.beat): Fraction(metre.quarters) for metre in written.metres}
    metres = {Fraction(0): Fraction(4), **metres}
    changes = sorted(metres)
    last = max(written.end, Fraction(1, 64))
    found: list[tuple[Fraction, str]] = []
    for at, change in enumerate(changes):
        beat, end = change, min(last, changes[at + 1]) if at + 1 < len(changes) else last
        while beat < end and len(found) < MAX_PAGE_BARS:
            found.append((beat, str(len(found) + 1)))
            beat += metres[change]
    return found


def _quarters_at(written: Written, beat: Fraction) -> Fraction:
    held = [metre.quarters for metre in written.metres if metre.beat <= float(beat) + 1e-9]
    return Fraction(held[-1] if held else 4.0).limit_denominator(64)


def signature(quarters: Fraction) -> tuple[int, int] | None:
    """The figures of a metre, such as (3, 4); None where it has none."""
    for unit in METRE_UNITS:
        count = quarters * unit / 4
        if count.denominator == 1 and 0 < count < 100:
            return int(count), unit
    return None


def pieces_of(part: Part, bars: Sequence[PageBar]) -> list[list[Piece]]:
    """Return, for each bar, the notes and rests that fill it, cut at bar lines."""
    found: list[list[Piece]] = [[] for _ in bars]
    ends = [bar.begin for bar in bars]
    at = Fraction(0)
    for number, note in enumerate(part.notes):
        after = part.notes[number + 1].beat if number + 1 < len(part.notes) else note.end
        end = min(note.end, after) if after > note.beat else note.end
        _put(found, bars, ends, Piece(at, note.beat - at))
        held = min(note.held_from, end) if note.marks else note.beat
        lengths = [each for each in (held - note.beat, end - held) if each]
        for piece in split(Piece(note.beat, end - note.beat, note), lengths):
            _put(found, bars, ends, piece)
        at = max(at, end)
    if bars:
        _put(found, bars, ends, Piece(at, bars[-1].end - at))
    return found


def _put(
    found: list[list[Piece]], bars: Sequence[PageBar], begins: list[Fraction], piece: Piece
) -> None:
    number = max(bisect_right(begins, piece.begin) - 1, 0)
    begin = piece.begin
    while begin < piece.end and number < len(bars):
        end = min(piece.end, bars[number].end)
        cut = replace(
            piece,
            begin=begin,
            length=end - begin,
            is_first=piece.is_first and begin == piece.begin,
            is_last=piece.is_last and end == piece.end,
        )
        found[number] += split(cut, _lengths(cut))
        begin = end
        number += 1


def _lengths(piece: Piece) -> list[Fraction]:
    """The lengths of a piece within a tuplet and outside of it, cut at a beat if that can be."""
    enters, leaves = tuplet_of(piece.end.denominator), tuplet_of(piece.begin.denominator)
    if enters == leaves or None in (enters, leaves):
        return [piece.length]
    steps = range(math.floor(piece.begin * FINEST) + 1, math.ceil(piece.end * FINEST))
    places = [Fraction(step, FINEST) for step in steps]
    if leaves == 1:
        places.reverse()
    is_short = 1 in (enters, leaves) and piece.length <= 1
    if is_short and _fits(piece.length, enters if leaves == 1 else leaves):
        return [piece.length]
    places = [
        place
        for place in places
        if _fits(piece.end - place, enters) and _fits(place - piece.begin, leaves)
    ]
    beats = [place for place in places if place.denominator == 1]
    cut = next(iter(beats + places), None)
    return [piece.length] if cut is None else [cut - piece.begin, piece.end - cut]


def _fits(length: Fraction, tuplet: int | None) -> bool:
    factor = Fraction(TUPLETS.get(tuplet or 1, 1), tuplet or 1)
    return FINEST % (length / factor).denominator == 0


def split(piece: Piece, lengths: Sequence[Fraction]) -> Iterator[Piece]:
    """Cut a piece into such lengths, tied to each other."""
    begin = piece.begin
    for number, length in enumerate(lengths):
        first = piece.is_first and number == 0
        last = piece.is_last and number == len(lengths) - 1
        yield replace(piece, begin=begin, length=length, is_first=first, is_last=last)
        begin += length


def tuplet_of(denominator: int) -> int | None:
    """The tuplet that a length with such a denominator belongs to: 1, 3, 5, 7; None: none."""
    odd = denominator // (denominator & -denominator)
    return odd if odd == 1 or odd in TUPLETS else None


def spelled(pitch: float, fifths: int) -> tuple[int, float, int]:
    """Return a pitch as a letter (0 for C), its accidental (semitones) and its octave (C4 is 60).

    It is a note of the key, else the nearest to it on the line of fifths.
    """
    key = math.floor(pitch + 0.5)
    best = (99.0, 0, 0)
    for letter, step in enumerate(STEPS):
        alter = (key - step + 6) % 12 - 6
        if abs(alter) <= 2:
            place = FIFTHS[letter] + 7 * alter
            best = min(best, (abs(place - fifths - CENTRE) - 0.1 * (alter > 0), letter, alter))
    _, letter, alter = best
    octave = (key - alter - STEPS[letter]) // 12 - 1
    return letter, alter + round(pitch - key, 6), octave


@lru_cache(maxsize=1024)
def name_of(pitch: float, fifths: int) -> str:
    """The name of a pitch in a key, such as Bb4, or A4+12 (cents)."""
    letter, alter, octave = spelled(pitch, fifths)
    sign = math.floor(alter + 0.5)
    cents = round(100.0 * (alter - sign))
    return f"{LETTERS[letter]}{'#' * sign}{'b' * -sign}{octave}{f'{cents:+d}' if cents else ''}"


def key_alter(letter: int, fifths: int) -> int:
    """The accidental that a key gives a letter."""
    return -((FIFTHS[letter] - fifths + 1) // 7)


def rounded(written: Written, allowed: Sequence[int]) -> tuple[Written, int]:
    """Return a score whose beats all have one of some denominators, or divide the first of them.

    And how many beats of notes were moved to the nearest such place.
    """
    moved: set[Fraction] = set()

    def near(beat: Fraction) -> Fraction:
        if any(each % beat.denominator == 0 for each in allowed):
            return beat
        moved.add(beat)
        return Fraction(round(beat * allowed[0]), allowed[0])

    def note(each: Note) -> Note:
        beat = near(each.beat)
        length = max(near(each.end) - beat, Fraction(1, allowed[0]))
        return each._replace(beat=beat, length=length)

    parts = []
    for part in written.parts:
        spans = (each._replace(begin=near(each.begin), end=near(each.end)) for each in part.spans)
        signs = (each._replace(beat=near(each.beat)) for each in part.signs)
        notes = tuple(map(note, part.notes))
        parts.append(replace(part, notes=notes, spans=tuple(spans), signs=tuple(signs)))
    tempi = tuple(Tempo(near(each.beat), each.quarters_per_minute) for each in written.tempi)
    bars = tuple(bar._replace(beat=near(bar.beat)) for bar in written.bars)
    return replace(written, parts=tuple(parts), tempi=tempi, bars=bars), len(moved)


def ends_as_read(change: Span, part: Part, written: Written, end: Fraction) -> bool:
    """Whether the words of a change of tempo, such as rit., say where it ends.

    That is where the next tempo or change begins, after LONGEST_CHANGE, or at the end of the score.
    """
    ends = {tempo.beat for tempo in written.tempi}
    ends |= {span.begin for span in part.spans if span.name in WRITTEN_CHANGES}
    is_usual = change.end - change.begin == LONGEST_CHANGE or change.end >= end
    return change.value is None and (is_usual or change.end in ends)


@dataclass(frozen=True)
class Placed:
    """A sign, or the beginning or end of a span, at its beat."""

    beat: Fraction
    what: Sign | Span | Tempo
    is_end: bool = False


def placed(part: Part, tempi: Sequence[Tempo] = ()) -> list[Placed]:
    """The signs, spans and tempi of a part in order: at one beat ends first, then beginnings."""
    found = [Placed(span.end, span, is_end=True) for span in part.spans]
    found += [Placed(tempo.beat, tempo) for tempo in tempi]
    found += [Placed(sign.beat, sign) for sign in part.signs]
    found += [Placed(span.begin, span) for span in part.spans]
    return sorted(found, key=lambda each: (each.beat, not each.is_end))
