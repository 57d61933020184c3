"""Addresses of what OSC reads and writes: all of them, those of a pattern, the nearest to one."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from yehu_server.errors import ParameterError, RefusedError, YehuError, did_you_mean
from yehu_server.live.osc.patterns import PatternError, matches
from yehu_server.live.osc.status import PART_STATUS, STATUS, STATUS_PREFIX
from yehu_server.live.part_addresses import PART_PARAMS, check_own, check_part, split_group
from yehu_server.params.table import PREFIX, TABLE, UNIT, find

NAMES = [row.name for row in STATUS]
PART_NAMES = [row.name for row in PART_STATUS]
LONGEST_PATTERN = 256


def readable(groups: Iterable[str]) -> Iterator[str]:
    """The addresses of all values, of parameters and then of the status, of some groups."""
    for addressed in groups:
        for form in ("", UNIT):
            yield from (
                addressed + param.address + form for param in (PART_PARAMS if addressed else TABLE)
            )
    for addressed in groups:
        names = PART_NAMES if addressed else NAMES
        yield from (addressed + STATUS_PREFIX + name for name in names)


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


def near(address: str, parts: int) -> str:
    """The reason for an unknown address, with a similar one if there is one."""
    if not address.startswith(PREFIX + "/"):
        return f"unknown address (all begin with {PREFIX}/)"
    try:
        addressed, own = split_group(address.removeprefix(PREFIX)[:LONGEST_PATTERN])
        check_part(addressed, parts)
        check_own(addressed, own)
        parameter_of(own.removesuffix(UNIT))
    except YehuError as error:
        return str(error)
    return "unknown address"


def fitting(pattern: str, addresses: Iterable[str], prefix: str = "") -> list[str]:
    """The addresses that a pattern matches.

    Raises RefusedError where the pattern is wrong or matches none.
    """
    if len(pattern) > LONGEST_PATTERN:
        raise RefusedError("the pattern is too long")
    literal = re.split(r"[*?\[{]", pattern, maxsplit=1)[0]  # by which most are told apart
    try:
        matches(pattern, "")  # raises where it is wrong, whatever there is
        found = [
            address
            for address in addresses
            if (prefix + address).startswith(literal) and matches(pattern, prefix + address)
        ]
    except PatternError as error:
        raise RefusedError(str(error)) from error
    if not found:
        raise RefusedError("the pattern matches no address")
    return found
