"""Addresses of what OSC reads and writes: all of them, those of a pattern, the nearest to one.

Patterns are ``* ? [a-z] [!a-z] {this,that}`` ([OSC] section on matching). All positions in the
address that a piece of the pattern can reach are followed at once, so that no pattern takes longer
than its length times the address's: a regular expression may take for ever.
"""

import re
from collections.abc import Callable, Iterable
from functools import cache, lru_cache

from yehu_server.errors import ParameterError, RefusedError, YehuError, did_you_mean, near_address
from yehu_server.live import part_addresses
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.status import PART_STATUS, STATUS, STATUS_PREFIX
from yehu_server.params.table import PREFIX, TABLE, UNIT, find

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


def parameter_of(address: str) -> str:
    """Find a parameter; raise ParameterError, with a similar address if there is one."""
    names = list(dict.fromkeys((*NAMES, *PART_NAMES)))
    if address.startswith(STATUS_PREFIX):
        name = address.removeprefix(STATUS_PREFIX)
        if name in names:
            raise ParameterError(f"the status cannot be set; ask for it by {PREFIX}/get")
        hint = did_you_mean(address, [STATUS_PREFIX + name for name in names], 0.8)
        raise ParameterError(f"unknown status value {address!r}{hint}")
    return find(address).address


def near(address: str, parts: int, known: Iterable[str]) -> str:
    """The reason for an unknown address, with a similar one of those known, if there is one."""
    if not address.startswith(PREFIX + "/"):
        bare = address[: limits.PATTERN]
        least = (len(PREFIX) + 0.8 * len(bare)) / (len(PREFIX) + len(bare))  # of `bare` 0.8
        hint = near_address(PREFIX + bare, [PREFIX + one for one in known], least)
        return f"unknown address (all but learned ones begin with {PREFIX}/){hint}"
    group, own = part_addresses.split_group(address.removeprefix(PREFIX)[: limits.PATTERN])
    try:
        part_addresses.check_part(group, parts)
        part_addresses.check_own(group, own)
        if own.startswith(STATUS_PREFIX):
            parameter_of(own)
    except YehuError as error:
        return str(error)
    if own in ROOM_GUESSES:
        return f"unknown address; a room is a preset: {PREFIX}/preset/load hall"
    of_group = [PREFIX + one for one in known if part_addresses.split_group(one)[0] == group]
    return f"unknown address{near_address(address, of_group, 0.75, prefix=PREFIX + group)}"


def fitting(pattern: str, addresses: Iterable[str], prefix: str = "") -> list[str]:
    """The addresses that a pattern matches; raises RefusedError if it is wrong or matches none."""
    if len(pattern) > limits.PATTERN:
        raise RefusedError("the pattern is too long")
    literal = re.split(r"[*?\[{]", pattern, maxsplit=1)[0]  # which most lack
    matches(pattern, "")  # raises where it is wrong, whatever there is
    found = [
        address
        for address in addresses
        if (prefix + address).startswith(literal) and matches(pattern, prefix + address)
    ]
    if not found:
        raise RefusedError("the pattern matches no address")
    return found
