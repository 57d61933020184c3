"""Addresses of parts: ``/part/N`` before the addresses of the players on the stage, from 1."""

import re

from yehu_server.errors import ParameterError
from yehu_server.params.table import BY_ADDRESS, PREFIX, TABLE, UNIT

PART = "/part/"
FIRST = ""  # the group of addresses without a part: those of the first, and what all share
_GROUP = re.compile(r"(/part/(?:0|[1-9][0-9]{0,8}))(/.*)", re.DOTALL)
# The parameters that each part has; the others are one for all.
PART_PARAMS = tuple(param for param in TABLE if not param.is_shared)
PLAIN = frozenset(param.address + form for param in TABLE for form in ("", UNIT))
OF_PARTS = frozenset(param.address + form for param in PART_PARAMS for form in ("", UNIT))


def group_of(part: int) -> str:
    """What comes before the addresses of a part, counted from 0."""
    return f"{PART}{part + 1}"


def part_of(group: str) -> int:
    """The part, counted from 0, of a group: of `FIRST`, the first."""
    return int(group.removeprefix(PART)) - 1 if group else 0


def split_group(address: str) -> tuple[str, str]:
    """The group of an address (without the prefix), and the rest."""
    if not address.startswith(PART):  # most do not
        return FIRST, address
    found = _GROUP.fullmatch(address)
    return (found[1], found[2]) if found else (FIRST, address)


def check_part(group: str, parts: int) -> None:
    """Refuse a group that is not there; raises ParameterError where it is not."""
    if group and not 1 <= int(group.removeprefix(PART)) <= parts:
        raise ParameterError(no_part(group.removeprefix(PART), parts))


def no_part(number: object, parts: int) -> str:
    """The error of a part, from 1, that is not there."""
    there = "there is only part 1" if parts == 1 else f"there are parts 1 to {parts}"
    return f"no part {number}: {there}"


def check_own(group: str, address: str) -> None:
    """Refuse a parameter of a part that is one for all; raises ParameterError where it is."""
    param = BY_ADDRESS.get(address.removesuffix(UNIT))
    if group and param is not None and param.is_shared:
        raise ParameterError(f"{param.address} is one for all parts: {PREFIX}{param.address}")
