"""The OSCQuery tree of parameters, status values and calls, as dicts for JSON.

Source: the OSCQuery proposal (github.com/Vidvox/OSCQueryProposal), third revision.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from yehu_server.control.calls import CALLS, Argument, Call
from yehu_server.control.status import PLACE, STATUS, as_argument
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
# Addresses to which clients may listen, without the prefix.
LISTENABLE = frozenset(
    [param.address + form for param in TABLE for form in ("", AS_UNIT)]
    + [PLACE + row.name for row in STATUS]
)


def tree(
    values: Mapping[str, float],
    status: Mapping[str, float | str],
    more_calls: Iterable[Call] = (),
) -> Node:
    """The whole tree.

    Parameters
    ----------
    values, status : mapping
        Parameters by address, status values by name.
    more_calls : iterable of Call
        Calls added to `CALLS`, or in place of some; their addresses include the prefix.
    """
    root: Node = {"FULL_PATH": "/", "ACCESS": NO_VALUE, "DESCRIPTION": ROOT_DOC}
    for param in TABLE:
        address = PREFIX + param.address
        _put(root, address, _of_param(param, values[param.address]))
        _put(root, address + AS_UNIT, _of_unit(param, values[param.address]))
    for row in STATUS:
        value = as_argument(status[row.name])
        described = {"ACCESS": READ, "TYPE": _type(value), "VALUE": [_json(value)]}
        _put(
            root,
            PREFIX + PLACE + row.name,
            described | {"DESCRIPTION": row.doc} | _units([row.unit]),
        )
    for call in CALLS:
        _put(root, PREFIX + call.address, _of_call(call))
    for call in more_calls:
        _put(root, call.address, _of_call(call))
    return root


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
