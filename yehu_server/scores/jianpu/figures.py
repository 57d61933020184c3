"""Write pitches in a key, lengths and slurs as jianpu does."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from yehu_server.scores.jianpu.scale import LOWEST_DO, MIDDLE_C
from yehu_server.scores.score import DO_BY_FIFTHS
from yehu_server.scores.written.layout import LETTERS, STEPS, Piece, key_alter, spelled
from yehu_server.scores.written.notated import Span

# Of a quarter: what a hemidemisemiquaver is, and where notes of tuplets may begin.
FINEST = (16, 48, 80, 112)
BEAMS = {Fraction(1): "", Fraction(1, 2): "q", Fraction(1, 4): "s", Fraction(1, 8): "d",
         Fraction(1, 16): "h"}  # fmt: skip
# Lengths up to a dotted crotchet that one figure has, and how it is written: beam and dots.
FIGURES = sorted(
    ((length * factor, (beam, dots)) for length, beam in BEAMS.items()
     for factor, dots in ((Fraction(1), ""), (Fraction(3, 2), "."), (Fraction(7, 4), ".."))),
    reverse=True,
)  # fmt: skip
FIGURE_OF = dict(FIGURES)
PICKUPS = {Fraction(4, unit) * factor: f"{unit}{dot}" for unit in (1, 2, 4, 8, 16, 32, 64)
           for factor, dot in ((Fraction(1), ""), (Fraction(3, 2), "."))}  # fmt: skip


def figure_of(pitch: float, fifths: int) -> tuple[str, int]:
    """Return the figure of a pitch with its accidental, and by how many octaves it is marked.

    Of a MIDI note the nearest semitone is written; `fifths` is that of `score.nearest_key`.
    """
    letter, alter, octave = spelled(pitch, fifths)
    name = DO_BY_FIFTHS[fifths]
    first = LETTERS.index(name[0])
    do = (STEPS[first] - LOWEST_DO) % 12.0 + LOWEST_DO + {"#": 1, "b": -1}.get(name[1:], 0)
    degree = (letter - first) % 7
    sign = round(alter) - key_alter(letter, fifths)
    natural = 12 * (octave + 1) + STEPS[letter] + key_alter(letter, fifths)
    octaves = round((natural - MIDDLE_C - do - STEPS[degree]) / 12)
    return f"{'#' * sign if sign > 0 else 'b' * -sign}{degree + 1}", octaves


def notatable_lengths(length: Fraction, piece: Piece) -> list[Fraction]:
    """Lengths that one figure has, with its dashes, and that are as long together."""
    found: list[Fraction] = []
    if length >= 2:
        whole = int(length)
        found += [Fraction(whole)] if piece.note is not None else [Fraction(1)] * whole
        length -= whole
    while length > 0:
        fits = next((value for value, _ in FIGURES if value <= length), length)
        found.append(fits)
        length -= fits
    return found


def straightened(group: Sequence[Piece]) -> list[Piece]:
    """Pieces that end at sixteenths of a quarter, together as long."""
    found = []
    begin = group[0].begin
    for piece in group:
        end = max(Fraction(round(piece.end * 16), 16), begin + Fraction(1, 16))
        if piece is group[-1]:
            end = piece.end
        if end > begin:
            found.append(replace(piece, begin=begin, length=end - begin))
            begin = end
    return found


def nested_slurs(spans: Sequence[Span], begins: set[Fraction]) -> Iterator[Span]:
    """Slurs that begin and end at notes, and within each other or apart."""
    open_: list[Span] = []
    slurs = (span for span in spans if span.name == "slur" and span.value is None)
    for slur in sorted(slurs, key=lambda span: (span.begin, -span.end)):
        while open_ and open_[-1].end <= slur.begin:
            open_.pop()
        crosses = bool(open_) and open_[-1].end < slur.end
        if {slur.begin, slur.end} <= begins and not crosses:
            open_.append(slur)
            yield slur
