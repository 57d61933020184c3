"""Match OSC address patterns: ``* ? [a-z] [!a-z] {this,that}`` ([OSC] section on matching).

All positions in the address that a piece of the pattern can reach are followed at once, so that
no pattern takes longer than its length times the address's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

SPECIAL = frozenset("*?[{")


class PatternError(ValueError):
    """A pattern with an unclosed bracket."""


@dataclass(frozen=True)
class One:
    """One character of a set."""

    fits: Callable[[str], bool]


@dataclass(frozen=True)
class AnyNumber:
    """Any number of characters within a part of the address."""


@dataclass(frozen=True)
class Either:
    """One of several words."""

    words: tuple[str, ...]


Piece = One | AnyNumber | Either


def is_pattern(address: str) -> bool:
    """Whether an address has characters of a pattern."""
    return not SPECIAL.isdisjoint(address)


def matches(pattern: str, address: str) -> bool:
    """Whether a pattern matches the whole of an address.

    Raises
    ------
    PatternError
        Where a bracket is not closed.
    """
    places = {0}
    for piece in _pieces(pattern):
        places = _after(piece, places, address)
        if not places:
            return False
    return len(address) in places


def _after(piece: Piece, places: set[int], address: str) -> set[int]:
    """Positions in the address after `piece`, from all positions before it."""
    if isinstance(piece, Either):
        return {at + len(w) for at in places for w in piece.words if address.startswith(w, at)}
    if isinstance(piece, One):
        return {at + 1 for at in places if at < len(address) and piece.fits(address[at])}
    reached: set[int] = set()
    for at in sorted(places):
        if at not in reached:  # else an earlier position has reached all that this one would
            end = address.find("/", at)
            reached.update(range(at, (end if end >= 0 else len(address)) + 1))
    return reached


@lru_cache(maxsize=256)
def _pieces(pattern: str) -> tuple[Piece, ...]:
    """The pieces of a pattern; raises PatternError."""
    pieces: list[Piece] = []
    at = 0
    while at < len(pattern):
        char = pattern[at]
        if char == "*":
            if not pieces or not isinstance(pieces[-1], AnyNumber):  # "**" is "*"
                pieces.append(AnyNumber())
        elif char == "?":
            pieces.append(One(lambda c: c != "/"))
        elif char == "[":
            end = _closing(pattern, at, "]")
            pieces.append(One(_set(pattern[at + 1 : end])))
            at = end
        elif char == "{":
            end = _closing(pattern, at, "}")
            pieces.append(Either(tuple(pattern[at + 1 : end].split(","))))
            at = end
        else:
            end = _end_of_plain(pattern, at)
            pieces.append(Either((pattern[at:end],)))
            at = end - 1
        at += 1
    return tuple(pieces)


def _end_of_plain(pattern: str, at: int) -> int:
    """Position after the characters that stand for themselves."""
    while at < len(pattern) and pattern[at] not in SPECIAL:
        at += 1
    return at


def _closing(pattern: str, at: int, bracket: str) -> int:
    end = pattern.find(bracket, at + 1)
    if end < 0:
        raise PatternError(f"{pattern[at]} is never closed")
    return end


def _set(text: str) -> Callable[[str], bool]:
    negated, text = (True, text[1:]) if text.startswith("!") else (False, text)
    ranges = []
    at = 0
    while at < len(text):
        is_range = text[at + 1 : at + 2] == "-" and at + 2 < len(text)
        ranges.append((text[at], text[at + 2] if is_range else text[at]))
        at += 3 if is_range else 1

    def fits(char: str) -> bool:
        return char != "/" and any(lo <= char <= hi for lo, hi in ranges) != negated

    return fits
