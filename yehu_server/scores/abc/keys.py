"""Read keys of ABC, and what a key or a voice says of its clef, octave and transposition."""

import re
from collections import Counter
from collections.abc import Sequence

from yehu_server.errors import one_line
from yehu_server.scores.abc.keywords import ALTERS, CLEFS, MODES, PLAYED, PROPERTIES
from yehu_server.scores.abc.tokens import ACCIDENTAL, ACCIDENTALS, CLEF, GLUED, KEY, PROPERTY
from yehu_server.scores.written.layout import LETTERS, key_alter

SHARPS = "FCGDAEB"  # in the order in which keys get them
SIGNS = {"": 0, "#": 1, "♯": 1, "sharp": 1, "b": -1, "♭": -1, "flat": -1}

Key = tuple[int, dict[str, float]]  # its sharps, and the accidental of each letter


def properties_of(text: str, unknown: Counter[str]) -> tuple[dict[str, int], str, list[str]]:
    """What a field says of where notes sound, a name, and the words that are of something else.

    Octaves of the clef, `octave` and semitones of `transpose` are independent of each other
    (standard 2.1, 4.6); `middle` and lines of the staff are of the print alone.
    """
    found: dict[str, int] = {}
    name, others = "", []
    for word in PROPERTY.findall(text):
        key, equals, value = word.partition("=")
        key, value = key.lower(), value.strip('"')
        is_bare = CLEF.fullmatch(word) and _octaves_of(word, bare=True) is not None
        if is_bare or (equals and key == "clef"):
            octaves = _octaves_of(word if is_bare else value)
            if octaves is None:
                unknown[one_line(word[:40])] += 1
            else:
                found["clef"] = octaves
        elif not equals or not key:
            others.append(word)
        elif key in ("name", "nm"):
            name = "".join(filter(str.isprintable, value))[:80]
        elif key in ("octave", "transpose") and re.fullmatch(r"[+-]?\d{1,2}", value):
            found[key] = int(value)
        elif PROPERTIES.get(key, PLAYED) == PLAYED:
            unknown[one_line(word[:40])] += 1
    return found, name, others


def _octaves_of(clef: str, *, bare: bool = False) -> int | None:
    """The octaves by which a clef, no key, sounds otherwise; None where it is none."""
    found = CLEF.fullmatch(clef)
    if not found or found[1] not in CLEFS or (bare and found[1] in (*"PGCF", "none")):
        return None
    octaves = {None: 0, "8": 1, "15": 2}[found[3]]
    return -octaves if found[2] in ("-", "_") else octaves


def key_of(words: Sequence[str], unknown: Counter[str]) -> Key | None:
    """Return the key that words name; None, and counted in `unknown`, where they name none."""
    words = [part for word in words for part in GLUED.split(word)]  # C^f^c
    first, rest = (words[0], words[1:]) if words else ("none", [])
    if first in ("HP", "Hp"):
        fifths = 2
    elif first == "none" or "exp" in words or ACCIDENTALS.fullmatch(first):
        fifths, rest = 0, list(words)  # of which the accidentals say all
    else:
        signed = bool(rest) and rest[0].lower() in ("sharp", "flat")
        found = KEY.fullmatch(first + (rest.pop(0).lower() if signed else ""))
        mode = (found[3] if found else "").lower()
        if found and not mode and rest and rest[0][:3].lower() in MODES:
            mode = rest.pop(0).lower()
        if found is None or (found[1].islower() and mode[:3] not in MODES):
            unknown[one_line(f"K:{' '.join(words)}"[:40])] += 1
            return None
        if mode and mode[:3] not in MODES:
            rest.insert(0, mode)
        fifths = SHARPS.index(found[1].upper()) - 1 + 7 * SIGNS[found[2] or ""]
        fifths += MODES.get(mode[:3], 0)
    alters = {letter: float(key_alter(at, fifths)) for at, letter in enumerate(LETTERS)}
    for word in rest:
        if ACCIDENTALS.fullmatch(word):
            alters |= {letter.upper(): ALTERS[sign] for sign, letter in ACCIDENTAL.findall(word)}
        elif word not in ("exp", "none"):
            unknown[one_line(f"{word} in K:{' '.join(words)}"[:40])] += 1
    return max(min(fifths, 7), -7), alters
