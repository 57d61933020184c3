"""Read one word of jianpu as a note: figures, octaves, accidentals and length."""

import re
from dataclasses import dataclass
from enum import Enum, IntEnum, auto
from fractions import Fraction
from functools import lru_cache

from yehu_server.scores.jianpu.characters import CHARACTERS, WEIGHTS
from yehu_server.scores.written.ticks import Ticks, ticks_of

MAJOR = (0.0, 2.0, 4.0, 5.0, 7.0, 9.0, 11.0)
LENGTHS = "cqsdh"  # crotchet, quaver, semiquaver, demi-, hemidemisemiquaver
MAX_OCTAVES, MAX_DOTS, MAX_FIGURES = 4, 4, 16
MAX_LETTERS = 64  # of a word that may be a note

_HIGH = {"8": "1", "9": "2"}  # an octave higher
_GRACE = re.compile(r"g\[([^\]]+)\]|\[([^\]]+)\]g")


class Kind(Enum):
    """The kinds of words of figures."""

    NOTE = auto()
    REST = auto()
    DASH = auto()  # the note before goes on
    BEAT = auto()  # of percussion


class Octaves(IntEnum):  # whose values are hashed at once
    """To which figure an octave mark belongs that stands between two."""

    UNSAID = auto()
    BEFORE = auto()
    AFTER = auto()


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure 1 to 7, or a character, with its accidental (semitones) and octaves from middle."""

    sign: str
    octave: int = 0
    alter: int = 0
    weight: str = ""  # of a character: light, heavy or living


@dataclass(frozen=True, slots=True)
class NoteWord:
    """A word of figures as written."""

    kind: Kind
    figures: tuple[Figure, ...]
    beams: int | None  # 0 for a crotchet, 1 for a quaver and so on; None where none is written
    dots: int
    dashes: int  # dashes written onto the note; of a DASH, how many there are
    shift: int  # octaves by which the base octave moves from this word on
    tremolo: bool
    unsure: bool  # an octave mark stands between two figures, and nothing says to which it belongs


@dataclass(frozen=True, slots=True)
class GraceWord:
    """Grace notes: each a figure, and its length in quarters."""

    notes: tuple[tuple[Figure, Fraction], ...]
    after: bool
    unsure: bool


@lru_cache(maxsize=4096)
def note_word(text: str, octaves: Octaves) -> NoteWord | None:
    """Read a word as a note, rest or dash; None where it is none."""
    if len(text) > MAX_LETTERS or text in ("-.", "->"):  # staccato, accent
        return None
    plain = "-" if text == "." else text
    tremolo = plain.count("///") == 1
    plain = plain.replace("///", "")
    shift = plain.count(">") - plain.count("<")
    plain = plain.replace("<", "").replace(">", "")
    head = plain.rstrip("-")
    length = _length(head)
    if length is None:
        return None
    dashes = len(plain) - len(head)
    bare = "".join(sign for sign in head if sign not in "cqsdh\\_.")
    if not bare.strip("-"):  # a dash, with its length before or behind it, or a base octave alone
        dashes += len(bare)
        if tremolo or not (dashes or (shift and not head)):
            return None
        return NoteWord(Kind.DASH, (), *length, dashes, shift, False, False)
    kind = {"0": Kind.REST, "x": Kind.BEAT}.get(bare, Kind.NOTE)
    figures, unsure = _figures(bare, octaves) if kind is Kind.NOTE else ((), False)
    if kind is Kind.NOTE and not figures:
        return None
    return NoteWord(kind, figures, *length, dashes, shift, tremolo, unsure)


def _length(text: str) -> tuple[int | None, int] | None:
    """The beams and dots among the signs of a word; None where they contradict each other."""
    letters = [sign for sign in text if sign in LENGTHS]
    strokes = text.count("\\") + text.count("_")  # lines under the figure
    dots = text.count(".")
    if len(letters) > 1 or (letters and strokes) or strokes > 4 or dots > MAX_DOTS:
        return None
    if text.startswith(("\\", "_")):  # a command
        return None
    if letters:
        return LENGTHS.index(letters[0]), dots
    return strokes or None, dots


def _figures(bare: str, octaves: Octaves) -> tuple[tuple[Figure, ...], bool]:
    """Figures with their signs about them; empty where there is anything else."""
    signs: list[str] = []
    between = [""]  # before the first figure, after it, after the second, ...
    for sign in bare:
        if "1" <= sign <= "9" or sign in CHARACTERS:
            signs.append(sign)
            between.append("")
        elif sign in "',#b" or sign in WEIGHTS:
            between[-1] += sign
        else:
            return (), False
    if not 1 <= len(signs) <= MAX_FIGURES:
        return (), False
    befores, afters, unsure = _shared(between, octaves)
    figures = [
        _figure(sign, before + after)
        for sign, before, after in zip(signs, befores, afters, strict=True)
    ]
    whole = tuple(figure for figure in figures if figure is not None)
    return (whole, unsure) if len(whole) == len(signs) else ((), False)


def _shared(between: list[str], octaves: Octaves) -> tuple[list[str], list[str], bool]:
    """Share the signs between figures out: those before each figure, those after it.

    Octave marks belong to the figure before them as far as, from the last figure back, each has
    some; else to the one after them as far as, from the first figure on, each has some. Those left
    are doubtful. Other signs belong to the figure after them, or to the last one.
    """
    count = len(between) - 1
    befores = [between[0], *[""] * (count - 1)]
    afters = [*[""] * (count - 1), between[-1]]
    marked = [any(sign in "'," for sign in signs) for signs in between]
    last = count
    while last and marked[last]:
        last -= 1
    first = 0
    while first < last and marked[first]:
        first += 1
    unsure = False
    for place in range(1, count):
        befores[place] = between[place].replace("'", "").replace(",", "")
        if not marked[place]:
            continue
        leads = place < first
        if first <= place <= last:
            unsure = unsure or octaves is Octaves.UNSAID
            leads = octaves is Octaves.BEFORE
        marks = "".join(sign for sign in between[place] if sign in "',")
        if leads:
            befores[place] += marks
        else:
            afters[place - 1] += marks
    return befores, afters, unsure


def _figure(sign: str, signs: str) -> Figure | None:
    """A figure with all its signs; None where they contradict each other."""
    up, down = signs.count("'"), signs.count(",")
    sharps, flats = signs.count("#"), signs.count("b")
    weights = [WEIGHTS[each] for each in signs if each in WEIGHTS]
    if (up and down) or (sharps and flats) or max(up, down) > MAX_OCTAVES:
        return None
    if max(sharps, flats) > 2 or len(weights) > 1 or (weights and sign.isascii()):
        return None
    octave = up - down + (sign in _HIGH)
    weight = weights[0] if weights else ""
    return Figure(_HIGH.get(sign, sign), octave, sharps - flats, weight)


@lru_cache(maxsize=1024)
def grace_word(text: str, octaves: Octaves) -> GraceWord | None:
    """Read a word as grace notes; None where it is none."""
    found = _GRACE.fullmatch(text) if len(text) <= MAX_LETTERS else None
    if found is None:
        return None
    lengths: list[Fraction] = []
    beams, bare = 2, ""
    for sign in found[1] or found[2]:
        if sign in "qsdh":
            beams = LENGTHS.index(sign)
            continue
        bare += sign
        if "1" <= sign <= "9" or sign in CHARACTERS:
            lengths.append(Fraction(1, 2**beams))
            beams = 2
    notes: list[tuple[Figure, Fraction]] = []
    left, unsure = iter(lengths), False
    for number, group in enumerate(bare.split("&")):
        figures, doubt = _figures(group, octaves)
        if not figures:
            return None
        unsure = unsure or doubt
        pairs = [(figure, next(left)) for figure in figures]
        if number:  # the first sounds with the one before: the higher is played
            notes[-1] = max(notes[-1], pairs.pop(0), key=lambda pair: height(pair[0]))
        notes += pairs
    return GraceWord(tuple(notes), found[2] is not None, unsure)


def height(figure: Figure) -> float:
    """Semitones above do of a figure 1 to 7, its octave among them; of a character, the octave."""
    degree = MAJOR[int(figure.sign) - 1] if figure.sign.isascii() else 0.0
    return degree + figure.alter + 12.0 * figure.octave


@lru_cache(maxsize=1024)
def length_of(beams: int, dots: int, room: int, notes: int) -> Ticks:
    """The length of a note of so many beams and dots, of `notes` in the room of others."""
    return ticks_of(Fraction(2 ** (dots + 1) - 1, 1 << (dots + beams)) * Fraction(room, notes))
