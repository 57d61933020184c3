"""The signs of ABC's music (standard 2.1, 4), as a table of patterns in the order of trial."""

import re
from fractions import Fraction
from functools import lru_cache
from typing import Any

LENGTH = r"\d*/*\d*"
NOTE = rf"(\^\^|\^|__|_|=)?([A-Ga-g])([',]*)({LENGTH})(-?)"
TOKEN = re.compile(
    rf"""(?P<note>{NOTE})
|(?P<space>[\s`*$\\]+)
|(?P<field>\[[A-Za-z]:[^\]]{{0,255}}\])
|(?P<bar>\.?(?::*\[?\|[|\]]*:*|::+))(?P<number>(?<!:)[1-9][\d,\-]*)?
|(?P<ending>\[[1-9][\d,\-]*)
|(?P<text>"[^"]*")
|(?P<sign>![^!|\s]+!|\+[^+|\s]+\+)
|(?P<chord>\[[^\[\]|]*\])(?P<chord_length>{LENGTH})(?P<chord_tie>-?)
|(?P<grace>\{{[^{{}}]*\}})
|(?P<rest>[zx])(?P<rest_length>{LENGTH})
|(?P<bars>[ZX])(?P<bars_count>\d*)
|\((?P<tuplet>\d)(?P<ratio>(?::\d*){{0,2}})
|(?P<slur>[()])
|(?P<tie>-)
|(?P<broken>>+|<+)
|(?P<short>[.~H-Yh-w])
|(?P<over>&)
|(?P<nothing>y\d*|!)
|(?P<other>.)""",
    re.VERBOSE,
)
# The same without groups: only texts are found, in half the time.
GROUP = re.compile(r"\(\?P<\w+>|(?<!\\)\((?![?)])")
TOKENS = re.compile(GROUP.sub("(?:", TOKEN.pattern), re.VERBOSE)
# The kind of a token by the last group that is in it, where that is not its own.
KINDS = {
    "number": "bar", "chord_length": "chord", "chord_tie": "chord", "rest_length": "rest",
    "bars_count": "bars", "ratio": "tuplet",
}  # fmt: skip
_NOTE, _UNDERSTOOD = re.compile(NOTE), re.compile(rf"{NOTE}|[\s\[\]{{}}/]")
NoteToken = tuple[str, str, int, str, str]  # accidental, letter, octave, length, tie


@lru_cache(maxsize=4096)
def token_of(text: str) -> tuple[str, tuple[Any, ...]]:  # noqa: PLR0911
    """The kind of a token, and its values; "" where it means nothing."""
    found = TOKEN.match(text)
    last = (found and found.lastgroup) or ""
    kind = KINDS.get(last, last)
    if found is None or kind in ("space", "nothing"):
        return "", ()
    if kind == "note":
        return kind, _note_of(found, 1)
    if kind == "bar":
        return kind, (found["bar"].lstrip("."), found["number"] or "")
    if kind == "field":
        return kind, (text[1], text[3:-1])
    if kind == "chord":
        return kind, (found["chord"], found["chord_length"], found["chord_tie"])
    if kind in ("rest", "bars"):
        return kind, (text[1:],)
    if kind == "tuplet":
        return kind, (int(found["tuplet"]), found["ratio"])
    if kind in ("text", "sign"):
        return kind, (text[1:-1],)
    if kind == "ending":
        return kind, (text[1:],)
    return kind, () if kind in ("tie", "over") else (text,)


def _note_of(found: re.Match[str], at: int) -> NoteToken:
    """A note whose groups follow that of a number."""
    sign, letter, octaves, length, tie = found.group(*range(at + 1, at + 6))
    octave = letter.islower() + octaves.count("'") - octaves.count(",")
    return sign or "", letter.upper(), octave, length, tie


@lru_cache(maxsize=4096)
def notes_in(text: str) -> tuple[list[NoteToken], str]:
    """The notes in brackets, and what else is in them."""
    return [_note_of(each, 0) for each in _NOTE.finditer(text)], _UNDERSTOOD.sub("", text)


@lru_cache(maxsize=4096)
def multiple_of(text: str) -> Fraction:
    """A multiple of the unit: 2, 3/2, /, //, /4."""
    number, slash, rest = text.partition("/")
    value = Fraction(int(number[:4] or 1))
    if slash:
        strokes = 1 + rest.count("/")
        under = rest.replace("/", "")
        value /= int(under[:4]) if under and int(under[:4]) else 2 ** min(strokes, 8)
    return value


# Fields, blocks of text, and what is in K: and V:.
FIELD = re.compile(r"([A-Za-z+]):(?![|:])\s*(.*)")  # C:| is a note at the end of a repeat
BLOCK = re.compile(r"%%\s*(begin|end)([a-z]\w*)")
PROPERTY = re.compile(r'[A-Za-z]+=(?:"[^"]*"|[^\s"]*)|"[^"]*"|[^\s"]+')
KEY = re.compile(r"([A-Ga-g])(#|b(?!lu)|♯|♭|sharp|flat)?([A-Za-z]*)")
ACCIDENTALS = re.compile(r"(?:(?:\^\^?|__?|=)[A-Ga-g])+")
GLUED = re.compile(r"(?<=[A-Za-z#♯♭])(?=[\^_])")
ACCIDENTAL = re.compile(r"(\^\^?|__?|=)([A-Ga-g])")
# The octaves of a clef: those of the standard, and _8 and ^8 as abcm2ps has them.
CLEF = re.compile(r"([A-Za-z]+)\d?(?:([+\-^_])(8|15))?")
