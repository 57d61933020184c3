"""Fields of ABC, such as key, metre and tempo; and its decorations, in the names of `notated`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction

from yehu_server.scores.written.layout import LETTERS, key_alter
from yehu_server.scores.written.notated import HIGHEST_TEMPO, LOWEST_TEMPO

SHARPS = "FCGDAEB"  # in the order in which keys get them
MODES = {"maj": 0, "ion": 0, "mix": -1, "dor": -2, "min": -3, "m": -3, "aeo": -3, "phr": -4,
         "loc": -5, "lyd": 1}  # fmt: skip
ALTERS = {"^^": 2.0, "^": 1.0, "=": 0.0, "_": -1.0, "__": -2.0}
MAX_ORDER = 200  # parts as they are played

DECORATIONS: Mapping[str, tuple[str, float | None]] = {
    "trill": ("trill", None), "lowermordent": ("mordent", None), "mordent": ("mordent", None),
    "uppermordent": ("inverted-mordent", None), "pralltriller": ("inverted-mordent", None),
    "roll": ("turn", None), "turn": ("turn", None), "turnx": ("turn", None),
    "invertedturn": ("inverted-turn", None), "invertedturnx": ("inverted-turn", None),
    "staccato": ("staccato", None), "wedge": ("staccatissimo", None), "tenuto": ("tenuto", None),
    ">": ("accent", None), "accent": ("accent", None), "emphasis": ("accent", None),
    "^": ("marcato", None), "marcato": ("marcato", None), "fermata": ("fermata", None),
    "invertedfermata": ("fermata", None), "upbow": ("up-bow", None), "downbow": ("down-bow", None),
    "open": ("open-string", None), "snap": ("snap-pizzicato", None), "slide": ("slide-in-up", None),
    "breath": ("breath", None), "arpeggio": ("arpeggio", None), "plus": ("pizzicato", None),
    "spiccato": ("spiccato", None), "tremolo": ("tremolo", None), "harmonic": ("harmonic", None),
    "vibrato": ("vibrato", None), "slideup": ("slide-in-up", None),
    "slidedown": ("slide-in-down", None), "fall": ("slide-out-down", None),
    "doit": ("slide-out-up", None), "espressivo": ("soft-accent", None),
    "staccatissimo": ("staccatissimo", None), "portato": ("portato", None),
    **{str(finger): ("finger", float(finger)) for finger in range(5)},
    **{"/" * strokes: ("tremolo", float(strokes)) for strokes in range(1, 5)},
}  # fmt: skip
SHORTCUTS: Mapping[str, str] = {
    ".": "staccato", "~": "roll", "H": "fermata", "L": "accent", "M": "lowermordent", "O": "coda",
    "P": "uppermordent", "S": "segno", "T": "trill", "u": "upbow", "v": "downbow",
}  # fmt: skip
WEDGES: Mapping[str, str] = {
    "<(": "crescendo", "crescendo(": "crescendo", ">(": "diminuendo", "diminuendo(": "diminuendo",
    "<)": "stop", "crescendo)": "stop", ">)": "stop", "diminuendo)": "stop",
}  # fmt: skip
JUMPS: Mapping[str, str] = {
    "segno": "segno", "coda": "coda", "fine": "fine", "d.c.": "dacapo", "dacapo": "dacapo",
    "d.s.": "dalsegno", "dalsegno": "dalsegno", "dacoda": "tocoda", "tocoda": "tocoda",
    "d.c.alfine": "dacapo", "d.c.alcoda": "dacapo", "d.s.alfine": "dalsegno",
    "d.s.alcoda": "dalsegno",
}  # fmt: skip
IGNORED = frozenset({"thumb", "shortphrase", "mediumphrase", "longphrase", "5", "editorial"})

_KEY = re.compile(r"([A-G])([#b]?)\s*([A-Za-z]*)")
_ACCIDENTAL = re.compile(r"(\^\^|\^|__|_|=)([A-Ga-g])")
_CLEF = re.compile(r"\b(?:clef|middle|m|octave|transpose)=\S*")
_OCTAVE = re.compile(r"octave=(-?\d)|(?:treble|bass|alto|tenor|soprano|clef=\S*?)([+-])8")
_FRACTION = re.compile(r"(\d+)/(\d+)")


def key_of(text: str) -> tuple[int, dict[str, float], int] | None:
    """The sharps of a key, each letter's accidental, octaves of the clef; None without a key."""
    octave = _OCTAVE.search(text)
    shift = 0
    if octave:
        shift = int(octave[1]) if octave[1] else int(f"{octave[2]}1")
    found = _KEY.match(text.strip())
    word = text.split(maxsplit=1)[0] if text.split() else "none"
    if word in ("HP", "Hp"):
        fifths = 2
    elif word == "none" or "exp" in text.split():  # of which the accidentals say all
        fifths = 0
    elif found is None:
        return None
    else:
        mode = found[3].lower()
        mode = "m" if mode == "m" else mode[:3]
        fifths = SHARPS.index(found[1]) - 1 + 7 * {"#": 1, "b": -1, "": 0}[found[2]]
        fifths += MODES.get(mode, 0)
    alters = {letter: float(key_alter(at, fifths)) for at, letter in enumerate(LETTERS)}
    alters |= {
        letter.upper(): ALTERS[sign] for sign, letter in _ACCIDENTAL.findall(_CLEF.sub("", text))
    }
    return max(min(fifths, 7), -7), alters, shift


def metre_of(text: str) -> Fraction | None:
    """The quarters in a bar; None where it is free or not understood."""
    word = text.strip()
    if word in ("C", "C|"):
        return Fraction(4)
    found = re.fullmatch(r"\(?(\d+(?:\+\d+)*)\)?/(\d+)", word.replace(" ", ""))
    if not found or not 0 < int(found[2][:4]) <= 64:
        return None
    count = sum(int(each[:3]) for each in found[1].split("+"))
    return Fraction(4 * count, int(found[2])) if 0 < count <= 256 else None


def length_of(text: str) -> Fraction | None:
    """A length such as 1/8, in quarters."""
    found = _FRACTION.match(text.strip())
    if found and 0 < int(found[1][:4]) <= 16 and 0 < int(found[2][:4]) <= 512:
        return Fraction(4 * int(found[1]), int(found[2]))
    return Fraction(4) if text.strip() == "1" else None


def tempo_of(text: str, unit: Fraction) -> float | None:
    """Quarters a minute; None where no figure is written."""
    bare = re.sub(r'"[^"]*"', "", text).strip()
    left, equals, right = bare.rpartition("=")
    number = re.match(r"\s*(\d+(?:\.\d+)?)", right)
    if number is None:
        return None
    lengths = [Fraction(int(a), int(b)) for a, b in _FRACTION.findall(left) if 0 < int(b) < 10_000]
    beat = sum(lengths, Fraction(0)) * 4 if equals and lengths else unit
    tempo = float(beat) * float(number[1][:6])
    return tempo if LOWEST_TEMPO <= tempo <= HIGHEST_TEMPO else None


def order_of_parts(text: str) -> list[str]:
    """The parts in the order of a header such as (AB)2C."""
    stack: list[list[str]] = [[]]
    last: list[str] = []
    for sign in re.findall(r"[A-Za-z]|\d+|[()]", text):
        if sign == "(":
            stack.append([])
        elif sign == ")" and len(stack) > 1:
            last = stack.pop()
            stack[-1] += last
        elif sign.isdecimal():
            stack[-1] += last * (min(int(sign[:3]), 20) - 1)
        elif sign.isalpha():
            last = [sign]
            stack[-1] += last
        if sum(map(len, stack)) > MAX_ORDER:
            break
    return [each for level in stack for each in level][:MAX_ORDER]
