"""Make text from files and the network safe to print: on a terminal, in a log, in an answer."""

from __future__ import annotations

import unicodedata

FIRST, LAST = 600, 400  # characters kept of a long line; the reason may be at either end


def shortened(text: str) -> str:
    """Text with the middle cut out where it is long."""
    return text if len(text) <= FIRST + LAST else f"{text[:FIRST]} ... {text[-LAST:]}"


def one_line(text: str) -> str:
    """Text for a terminal: shortened, with everything escaped that is not printable.

    That is, control codes, line ends, marks of writing direction, and bytes of a file name that
    are not valid text.
    """
    text = shortened(text)
    return text if text.isprintable() else "".join(map(_escaped, text))


def _escaped(character: str) -> str:
    if character.isprintable() or unicodedata.category(character) == "Zs":
        return character
    return character.encode("unicode_escape").decode("ascii")
