"""Addresses of what OSC reads and writes: all of them, those of a pattern, the nearest to one.

Patterns are ``* ? [a-z] [!a-z] {this,that}`` ([OSC] section on matching). All positions in the
address that a piece of the pattern can reach are followed at once, so that no pattern takes longer
than its length times the address's: a regular expression may take for ever.
"""

import re
from collections.abc import Callable, Collection, Iterable
from functools import cache, lru_cache

from yehu_server.errors import ParameterError, RefusedError, near_address
from yehu_server.live import part_addresses
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.status import PART_STATUS, STATUS, STATUS_PREFIX
from yehu_server.params.table import PREFIX, TABLE, UNIT

SPECIAL = frozenset("*?[{")
_PIECES = re.compile(r"(\*+)|(\?)|\[(!?)([^]]*)\]|\{([^}]*)\}|([^*?[{]+)|(.)", re.DOTALL)
_RANGES = re.compile(r"(.)-(.)|(.)", re.DOTALL)

Piece = Callable[[set[int], str], set[int]]  # the positions after it, from those before it


def is_pattern(address: str) -> bool:
    """Whether an address has characters of a pattern."""
    return not SPECIAL.isdisjoint(address)


def matches(pattern: str, address: str) -> bool:
    """Whether a pattern matches a whole address; raises RefusedError for an unclosed bracket."""
    places = {0}
    for piece in _pieces(pattern):
        places = piece(places, address)
        if not places:
            return False
    return len(address) in places


@lru_cache(maxsize=256)
def _pieces(pattern: str) -> tuple[Piece, ...]:
    """The pieces of a pattern; raises RefusedError for an unclosed bracket."""
    return tuple(map(_piece, _PIECES.finditer(pattern)))


def _piece(found: re.Match[str]) -> Piece:
    stars, question, negated, members, words, plain, unclosed = found.groups()
    if unclosed:
        raise RefusedError(f"{unclosed} is never closed")
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


ROOM_GUESSES = ("/room", "/room/load", "/room/name", "/room/preset", "/room/type")
NAMES = [row.name for row in STATUS]
PART_NAMES = [row.name for row in PART_STATUS]


@cache
def readable(parts: int) -> dict[str, None]:
    """The addresses of all values, of parameters and then of the status, in order."""
    groups = (part_addresses.FIRST, *map(part_addresses.group_of, range(parts)))
    values = (
        group + param.address + form
        for group in groups
        for form in ("", UNIT)
        for param in (part_addresses.PART_PARAMS if group else TABLE)
    )
    status = (
        group + STATUS_PREFIX + name
        for group in groups
        for name in (PART_NAMES if group else NAMES)
    )
    return dict.fromkeys((*values, *status))


def unknown(address: str, parts: int, known: Collection[str]) -> str:
    """The reason for an unknown address, with one of those known that it may be meant for."""
    address = address[: limits.PATTERN]
    if not address.startswith(PREFIX + "/"):
        hint = near_address(address, known) or near_address(PREFIX + address, known, prefix=PREFIX)
        return f"unknown address (all but learned ones begin with {PREFIX}/){hint}"
    group, own = part_addresses.split_group(address.removeprefix(PREFIX))
    try:
        part_addresses.check_part(group, parts)
    except ParameterError as error:
        return str(error)
    if group and PREFIX + own in known and not own.startswith(part_addresses.PART):
        return f"{own} is one for all parts: {PREFIX}{own}"
    if own.startswith(STATUS_PREFIX):
        known = [PREFIX + one for one in readable(parts)]
        if address in known:
            return f"the status cannot be set; ask for it by {PREFIX}/get"
    if own.startswith(part_addresses.PART):
        hint = f"; a part is a number: {PREFIX}{part_addresses.group_of(0)}/..."
    elif own in ROOM_GUESSES:
        hint = f"; a room is a preset: {PREFIX}/preset/load hall"
    else:
        of_group = [each for each in known if _group(each) == group]
        hint = near_address(address, of_group, prefix=PREFIX + group)
    return f"unknown address{hint}"


def _group(address: str) -> str:
    return part_addresses.split_group(address.removeprefix(PREFIX))[0]


def fitting(pattern: str, addresses: Iterable[str]) -> list[str]:
    """The addresses that a pattern matches; raises RefusedError if it is wrong or matches none."""
    if len(pattern) > limits.PATTERN:
        raise RefusedError("the pattern is too long")
    literal = re.split(r"[*?\[{]", pattern, maxsplit=1)[0]  # which most lack
    matches(pattern, "")  # raises where it is wrong, whatever there is
    found = [each for each in addresses if each.startswith(literal) and matches(pattern, each)]
    if not found:
        raise RefusedError("the pattern matches no address; * ends at a /")
    return found
