"""The OSCQuery tree of parameters, status values and calls, as dicts for JSON.

Source: the OSCQuery proposal (github.com/Vidvox/OSCQueryProposal), third revision.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.live.osc.calls import CALLS, Argument, Call
from yehu_server.live.osc.part_status import PART_STATUS, PartValue
from yehu_server.live.osc.status import PLACE, STATUS, StatusValue, as_argument
from yehu_server.live.part_addresses import FIRST, OF_PARTS, OWN, PLAIN, check_part, divided, group
from yehu_server.params.spec import Param
from yehu_server.params.table import PREFIX, TABLE
from yehu_server.params.table import UNIT as AS_UNIT

Node = dict[str, Any]

NO_VALUE, READ, WRITE, READ_WRITE = 0, 1, 2, 3
ATTRIBUTES = (
    "FULL_PATH", "CONTENTS", "TYPE", "ACCESS", "VALUE", "RANGE", "DESCRIPTION", "UNIT", "CLIPMODE",
)  # fmt: skip
EXTENSIONS = dict.fromkeys((*ATTRIBUTES[3:], "LISTEN", "PATH_CHANGED"), True)
ROOT_DOC = "A virtual yehu, the Chinese two-stringed fiddle."
NO_ARGUMENTS = "N"  # a type for which clients show a button, and send nil
# Names of units in the proposal's units.md; others stay as they are.
UNIT_NAMES = {
    "m": "distance.m",
    "m/s": "speed.m/s",
    "s": "time.second",
    "ms": "time.ms",
    "Hz": "time.hz",
    "cents": "time.cents",
    "MIDI note": "time.midinote",
    "dB": "gain.db",
}
# Addresses to which clients may listen, without the prefix, and below a part.
LISTENABLE = PLAIN | {PLACE + row.name for row in STATUS}
LISTENABLE_OF_PARTS = OF_PARTS | {PLACE + row.name for row in PART_STATUS}
PART_DOC = "Part {}: a player of its own, with the instrument that it plays."


@dataclass(frozen=True)
class Told:
    """The values of a group of addresses (``parts``): parameters by address, status by name."""

    values: Mapping[str, float]
    status: Mapping[str, float | str]


def is_listenable(address: str, parts: int) -> bool:
    """Whether clients may listen to an address, without the prefix."""
    addressed, own = divided(address)
    try:
        check_part(addressed, parts)
    except ParameterError:
        return False
    return own in (LISTENABLE_OF_PARTS if addressed else LISTENABLE)


def tree(told: Told, more_calls: Iterable[Call] = (), parts: Sequence[Told] = ()) -> Node:
    """The whole tree.

    Parameters
    ----------
    told : Told
        What addresses without a part have.
    more_calls : iterable of Call
        Calls added to `CALLS`, or in place of some; their addresses include the prefix.
    parts : sequence of Told
        What those of each part have, where there are several.
    """
    root: Node = {"FULL_PATH": "/", "ACCESS": NO_VALUE, "DESCRIPTION": ROOT_DOC}
    _put_group(root, FIRST, told)
    for part, own in enumerate(parts):
        described = {"DESCRIPTION": PART_DOC.format(part + 1)}
        _put(root, PREFIX + group(part), described)
        _put_group(root, group(part), own)
    for call in more_calls:
        _put(root, call.address, _of_call(call))
    return root


def _put_group(root: Node, addressed: str, told: Told) -> None:
    """Add the nodes of a group of addresses."""
    prefix = PREFIX + addressed
    for param in OWN if addressed else TABLE:
        number = told.values[param.address]
        _put(root, prefix + param.address, _of_param(param, number))
        _put(root, prefix + param.address + AS_UNIT, _of_unit(param, number))
    rows: Iterable[StatusValue | PartValue] = PART_STATUS if addressed else STATUS
    for row in rows:
        value = as_argument(told.status[row.name])
        described = {"ACCESS": READ, "TYPE": _type(value), "VALUE": [_json(value)]}
        described |= {"DESCRIPTION": row.doc} | _units([row.unit])
        _put(root, prefix + PLACE + row.name, described)
    for call in CALLS:
        if not (addressed and call.is_for_all):
            _put(root, prefix + call.address, _of_call(call))


def find(root: Node, path: str) -> Node | None:
    """The node at a path, or None where there is none."""
    node: Node | None = root
    for name in path.strip("/").split("/") if path.strip("/") else ():
        node = None if node is None else node.get("CONTENTS", {}).get(name)
    return node


def host_info(name: str, osc: tuple[str, int], web: tuple[str, int]) -> dict[str, Any]:
    """The server's HOST_INFO: its name, extensions and addresses."""
    return {
        "NAME": name,
        "EXTENSIONS": EXTENSIONS,
        "OSC_IP": osc[0],
        "OSC_PORT": osc[1],
        "OSC_TRANSPORT": "UDP",
        "WS_IP": web[0],
        "WS_PORT": web[1],
    }


def _put(root: Node, address: str, described: Node) -> None:
    """Add a node, and the containers above it that are missing."""
    node, path = root, ""
    for name in address.strip("/").split("/"):
        path += f"/{name}"
        contents = node.setdefault("CONTENTS", {})
        node = contents.setdefault(name, {"FULL_PATH": path, "ACCESS": NO_VALUE})
    node.update(described)


def _of_param(param: Param, value: float) -> Node:
    return {
        "ACCESS": READ_WRITE,
        "TYPE": "f",
        "VALUE": [_json(value)],
        "RANGE": [{"MIN": param.lo, "MAX": param.hi}],
        "CLIPMODE": ["both"],
        "DESCRIPTION": f"{param.doc} At {AS_UNIT[1:]} below, the same as 0 to 1.",
    } | _units([param.unit])


def _of_unit(param: Param, value: float) -> Node:
    return {
        "ACCESS": READ_WRITE,
        "TYPE": "f",
        "VALUE": [_json(param.to_unit(value))],
        "RANGE": [{"MIN": 0.0, "MAX": 1.0}],
        "CLIPMODE": ["both"],
        "DESCRIPTION": f"{param.doc} As 0 to 1.",
    }


def _of_call(call: Call) -> Node:
    arguments = call.arguments
    described: Node = {"ACCESS": WRITE, "DESCRIPTION": call.doc}
    if not arguments:
        return described | {"TYPE": NO_ARGUMENTS}
    described["TYPE"] = "".join(argument.kind for argument in arguments)
    ranges = [_range(argument) for argument in arguments]
    if any(ranges):
        described["RANGE"] = ranges
    return described | _units([argument.unit for argument in arguments])


def _range(argument: Argument) -> dict[str, Any]:
    ends = {"MIN": argument.lo, "MAX": argument.hi}
    choices = {"VALS": list(argument.choices)} if argument.choices else {}
    return {name: end for name, end in ends.items() if end is not None} | choices


def _units(units: list[str]) -> Node:
    """The attribute UNIT; nothing where no argument has a unit."""
    if all(unit == "1" for unit in units):
        return {}
    return {"UNIT": [UNIT_NAMES.get(unit, unit) for unit in units]}


def _type(value: float | str) -> str:
    return "s" if isinstance(value, str) else "i" if isinstance(value, int) else "f"


def _json(value: float | str) -> float | str | None:
    """A value as JSON can have it: None for one that is not finite."""
    return None if isinstance(value, float) and not math.isfinite(value) else value
