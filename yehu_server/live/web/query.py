"""The OSCQuery tree of parameters, status values and calls, as dicts for JSON.

Source: the OSCQuery proposal (github.com/Vidvox/OSCQueryProposal), third revision.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from functools import cache, partial
from itertools import chain
from typing import Any

from yehu_server.live.osc.all_calls import CALLS
from yehu_server.live.osc.call import Argument, Call
from yehu_server.live.osc.status import (
    PART_STATUS,
    STATUS,
    STATUS_PREFIX,
    AnyValue,
    PartValue,
    as_argument,
)
from yehu_server.live.part_addresses import FIRST, PART_PARAMS, group_of
from yehu_server.params.spec import Param
from yehu_server.params.table import PREFIX, TABLE, offered
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
PART_DOC = "Part {}: a player of its own, with the instrument that it plays."


Values = Callable[[str], Mapping[str, float]]  # of parameters of a group, by address
Status = Callable[[str], Mapping[str, float | str]]  # status values of a group, by name


def node_at(
    path: str, values: Values, status: Status, parts: int = 1, more_calls: Iterable[Call] = ()
) -> Node | None:
    """The node at a path with all that is below it, or None where there is none.

    Nothing else is built, and only groups of addresses that are needed are read.

    `values`, `status`: called with a group of addresses: `FIRST`, or that of a part.
    `parts`: number of parts; where there are several, each has addresses of its own, too.
    `more_calls`: calls added to `CALLS`, or in place of some; their addresses include the prefix.
    """
    below = path.strip("/")
    values, status = cache(values), cache(status)
    root: Node = {"FULL_PATH": "/", "ACCESS": NO_VALUE, "DESCRIPTION": ROOT_DOC}
    nodes: list[Iterable[tuple[str, Callable[[], Node]]]] = [_nodes(FIRST, values, status)]
    for number in range(parts) if parts > 1 else ():
        described: Node = {"DESCRIPTION": PART_DOC.format(number + 1)}
        nodes.append([(PREFIX + group_of(number), partial(dict, described))])
        nodes.append(_nodes(group_of(number), values, status))
    nodes.append((call.address, partial(_of_call, call)) for call in more_calls)
    for address, describe in chain.from_iterable(nodes):
        if not below or f"{address}/".startswith(f"/{below}/"):
            _put(root, address, describe())
    return find(root, path)


def _nodes(group: str, values: Values, status: Status) -> Iterable[tuple[str, Callable[[], Node]]]:
    """The addresses of a group, and what describes each."""
    prefix = PREFIX + group
    for param in PART_PARAMS if group else TABLE:
        yield prefix + param.address, partial(_of_param, param, group, values)
        yield prefix + param.address + AS_UNIT, partial(_of_unit, param, group, values)
    for row in PART_STATUS if group else STATUS:
        yield prefix + STATUS_PREFIX + row.name, partial(_of_status, row, group, status)
    for call in CALLS:
        if not (group and call.is_for_all):
            yield prefix + call.address, partial(_of_call, call)


def find(root: Node, path: str) -> Node | None:
    """The node at a path, or None where there is none."""
    node: Node | None = root
    for name in path.strip("/").split("/") if path.strip("/") else ():
        node = None if node is None else node.get("CONTENTS", {}).get(name)
    return node


def _put(root: Node, address: str, described: Node) -> None:
    """Add a node, and the containers above it that are missing."""
    node, path = root, ""
    for name in address.strip("/").split("/"):
        path += f"/{name}"
        contents = node.setdefault("CONTENTS", {})
        node = contents.setdefault(name, {"FULL_PATH": path, "ACCESS": NO_VALUE})
    node.update(described)


def _of_param(param: Param, group: str, values: Values) -> Node:
    value = values(group)[param.address]
    doc = f"{param.doc} At {AS_UNIT[1:]} below, the same as 0 to 1."
    return _of_number(value, param.lo, offered(param).hi, doc) | _units([param.unit])


def _of_unit(param: Param, group: str, values: Values) -> Node:
    value = offered(param).to_unit(values(group)[param.address])
    return _of_number(value, 0.0, 1.0, f"{param.doc} As 0 to 1.")


def _of_number(value: float, lo: float, hi: float, doc: str) -> Node:
    return {
        "ACCESS": READ_WRITE,
        "TYPE": "f",
        "VALUE": [_json(value)],
        "RANGE": [{"MIN": lo, "MAX": hi}],
        "CLIPMODE": ["both"],
        "DESCRIPTION": doc,
    }


def _of_status(row: AnyValue | PartValue, group: str, status: Status) -> Node:
    value = as_argument(status(group)[row.name])
    described = {"ACCESS": READ, "TYPE": _type(value), "VALUE": [_json(value)]}
    return described | {"DESCRIPTION": row.doc} | _units([row.unit])


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
