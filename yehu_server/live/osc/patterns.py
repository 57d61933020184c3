"""Match OSC address patterns: ``* ? [a-z] [!a-z] {this,that}`` ([OSC] section on matching).

All positions in the address that a piece of the pattern can reach are followed at once, so that
no pattern takes longer than its length times the address's: a regular expression may take for ever.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

SPECIAL = frozenset("*?[{")
_PIECES = re.compile(r"(\*+)|(\?)|\[(!?)([^]]*)\]|\{([^}]*)\}|([^*?[{]+)|(.)", re.DOTALL)
_RANGES = re.compile(r"(.)-(.)|(.)", re.DOTALL)

Piece = Callable[[set[int], str], set[int]]  # the positions after it, from those before it


class PatternError(ValueError):
    """A pattern with an unclosed bracket."""


def is_pattern(address: str) -> bool:
    """Whether an address has characters of a pattern."""
    return not SPECIAL.isdisjoint(address)


def matches(pattern: str, address: str) -> bool:
    """Whether a pattern matches the whole of an address.

    Raises PatternError where a bracket is not closed.
    """
    places = {0}
    for piece in _pieces(pattern):
        places = piece(places, address)
        if not places:
            return False
    return len(address) in places


@lru_cache(maxsize=256)
def _pieces(pattern: str) -> tuple[Piece, ...]:
    """The pieces of a pattern; raises PatternError."""
    return tuple(map(_piece, _PIECES.finditer(pattern)))


def _piece(found: re.Match[str]) -> Piece:
    stars, question, negated, members, words, plain, unclosed = found.groups()
    if unclosed:
        raise PatternError(f"{unclosed} is never closed")
    if stars:
        return _any_number
    if question:
        return _one_of("", is_negated=True)
    if members is not None:
        return _one_of(members, is_negated=bool(negated))
    return _either([plain] if words is None else words.split(","))


def _any_number(places: set[int], address: str) -> set[int]:
    reached: set[int] = set()
    for at in sorted(places):
        if at not in reached:  # else an earlier position has reached all that this one would
            end = address.find("/", at)
            reached.update(range(at, (end if end >= 0 else len(address)) + 1))
    return reached


def _one_of(members: str, *, is_negated: bool) -> Piece:
    """One character of a set; never a slash."""
    ranges = [(lo or one, hi or one) for lo, hi, one in _RANGES.findall(members)]

    def fits(char: str) -> bool:
        return char != "/" and any(lo <= char <= hi for lo, hi in ranges) != is_negated

    return lambda places, address: {at + 1 for at in places if fits(address[at : at + 1] or "/")}


def _either(words: list[str]) -> Piece:
    return lambda places, address: {
        at + len(word) for at in places for word in words if address.startswith(word, at)
    }
