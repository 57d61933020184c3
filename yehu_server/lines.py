"""Text of others, for people to read: on a terminal, in a log, in an answer."""

from __future__ import annotations

import unicodedata

FIRST, LAST = 600, 400  # characters that are left of a long line: reasons are at either end


def shortened(text: str) -> str:
    """Text of bearable length, for answers to what has none."""
    return text if len(text) <= FIRST + LAST else f"{text[:FIRST]} ... {text[-LAST:]}"


def one_line(text: str) -> str:
    """Text as a terminal may show it: of bearable length, and what would steer it spelled out.

    That is, control codes, line ends, marks that turn the direction of writing, and bytes of a file
    name that are no text.
    """
    text = shortened(text)
    return text if text.isprintable() else "".join(map(_spelled, text))


def _spelled(character: str) -> str:
    if character.isprintable() or unicodedata.category(character) == "Zs":
        return character
    return character.encode("unicode_escape").decode("ascii")
