"""Read one mapping file (mappings/README.md), or all errors in it with their lines."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from yehu_server.core.midi.tables import MAX_BINDS
from yehu_server.core.player.note_range import LOWEST_NOTE
from yehu_server.errors import MappingError, ParameterError
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import find
from yehu_server.playing import sources
from yehu_server.playing.bind import Bind, Breakpoints
from yehu_server.playing.sources import CHANNELS
from yehu_server.util.documents import MAX_ERRORS, Document, Fields
from yehu_server.util.values import brief, choice, flag, line, number, whole

MAX_BYTES = 1 << 17  # one that is watched is parsed beside the playing


@dataclass(frozen=True)
class MappingFile:
    """The contents of one file, without its base; `mpe` is None where it is not given."""

    name: str
    binds: tuple[Bind, ...] = ()
    start: tuple[tuple[str, float], ...] = ()
    base: str | None = None
    mpe: bool | None = None
    key_switches: int | None = None
    about: str = ""


def document_of(path: Path, text: str = "") -> Document:
    """A mapping file, whose text is known or will be read."""
    return Document(path, "a mapping file", MappingError, text=text, most_errors=MAX_ERRORS)


def text_of(path: Path) -> str:
    """The text of a file; raises MappingError where it cannot be read or is not UTF-8."""
    return document_of(path).read(path, MAX_BYTES).text


def read_mapping_file(path: Path, text: str | None = None) -> MappingFile:
    """Read a TOML file, or the text of one; raises MappingError, naming file and line."""
    return mapping_file_from(document_of(path, text_of(path) if text is None else text).toml())


def mapping_file_of_json(path: Path, text: str) -> MappingFile:
    """Read what ``yehu-server mappings show --json`` prints; raises MappingError if wrong."""
    table = document_of(path, text).json()
    data = _without_null(table.data)
    binds = data.get("bind", [])
    if isinstance(binds, list):
        data["bind"] = _binds_of_json(binds)
        for bind in data["bind"]:
            if isinstance(bind, dict) and isinstance(bind.get("replaces"), list):
                bind["replaces"] = _binds_of_json(bind["replaces"])
    return mapping_file_from(Fields(data, table.document))


def _binds_of_json(binds: list[Any]) -> list[Any]:
    return [_of_json(bind) if isinstance(bind, dict) else bind for bind in binds]


def _of_json(entry: dict[str, Any]) -> dict[str, Any]:
    ends = [entry.pop(name, None) for name in ("from", "to")]
    # Older versions printed no span beside them; both are null for the bend range.
    if "span" not in entry and ends != [None, None]:
        entry["span"] = ends
    return _without_null(entry)


def _without_null(table: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in table.items() if value is not None}


LONGEST_SMOOTHING_MS = 5000.0
MAX_POINTS = 1024
MAX_PARTS = 16  # engine.rig.MAX_PARTS, which takes a second to import


def settable_param(address: str, instead: str) -> Param:
    """Find a parameter that the player does not move; `instead` begins the advice in the error."""
    param = find(address)
    if param.player_controlled:
        raise ParameterError(f"{address} is moved by the player; {instead} under /playing")
    return param


def read_settings(table: Fields) -> tuple[tuple[str, float], ...]:
    """Read a table of addresses and the values that they start with."""
    return tuple(table.each(_start).items())


def _start(address: str, value: Any) -> float:
    return settable_param(address, "set one").within(value)


def read_input_range(value: Any) -> tuple[float, float]:
    """Read two different numbers."""
    lo, hi = read_pair(value, "[from, to]")
    if not 0.0 < abs(hi - lo) < math.inf:
        raise ParameterError(f"expected two different numbers, got {brief(value)}")
    return lo, hi


def read_pair(
    value: Any, form: str, lo: float = -math.inf, hi: float = math.inf
) -> tuple[float, float]:
    """Read a list of two numbers within bounds."""
    if not isinstance(value, list) or len(value) != 2:
        raise ParameterError(f"expected {form}, got {brief(value)}")
    return number(value[0], lo, hi), number(value[1], lo, hi)


def read_curve(value: Any) -> Curve | Breakpoints:
    """Read a curve by its name or by its points."""
    if isinstance(value, list):
        return _breakpoints(value)
    return Curve(choice(value, [known.value for known in Curve]))


def _breakpoints(value: list[Any]) -> Breakpoints:
    points = tuple(read_pair(point, "points [from, to]", 0.0, 1.0) for point in value)
    positions = [position for position, _ in points]
    if len(positions) < 2 or (positions[0], positions[-1]) != (0.0, 1.0):
        raise ParameterError("the points have to begin at 0 and end at 1")
    if any(later <= position for position, later in itertools.pairwise(positions)):
        raise ParameterError("each point has to lie beyond the one before it")
    if len(points) > MAX_POINTS:
        raise ParameterError(f"{len(points)} points are more than {MAX_POINTS}")
    return Breakpoints(points)


def read_channels(value: Any) -> tuple[int, ...]:
    """Read one MIDI channel or several."""
    numbers = value if isinstance(value, list) else [value]
    if not numbers:
        raise ParameterError("expected a channel or several, got []")
    return tuple(sorted({whole(each, 1, CHANNELS) for each in numbers}))


# ---------------------------------------------------------------- entries


def mapping_file_from(table: Fields) -> MappingFile:
    """Check and convert the entries of a file; raises MappingError, naming file and line."""
    mapping_file = MappingFile(
        name=table.read("name", line, Path(table.document.name).stem),
        about=table.read("about", line, ""),
        base=table.read("base", line, None),
        mpe=table.read("mpe", flag, None),
        key_switches=table.read("key_switches", whole, None, 0, LOWEST_NOTE - len(ARTICULATIONS)),
        start=read_settings(table.table("start")),
        binds=tuple(filter(None, map(_bind, table.tables("bind", 0, MAX_BINDS)))),
    )
    table.refuse_others()
    table.document.raise_errors()
    return mapping_file


def _bind(table: Fields, *, may_replace: bool = True) -> Bind | None:
    source = table.read("source", lambda value: sources.canonical(line(value)), None)
    param: Param | None = table.read(
        "target", lambda value: settable_param(line(value), "map to one"), None
    )
    curve: Curve | Breakpoints | None = table.read("curve", read_curve, None)
    lo, hi = (param.lo, param.hi) if param else (-math.inf, math.inf)
    span = table.read("span", read_pair, None, "[from, to]", lo, hi)
    bind = Bind(
        source or "",
        param.address if param else "",
        span=span if param else None,
        curve=curve or (param.curve if param else Curve.LIN),
        invert=table.read("invert", flag, False),
        smoothing_ms=table.read("smoothing", number, 0.0, 0.0, LONGEST_SMOOTHING_MS, "ms"),
        channels=table.read("channel", read_channels, ()),
        part=table.read("part", whole, 0, 1, MAX_PARTS),
        is_soft=table.read("soft", flag, False),
        input_range=table.read("input", read_input_range, (0.0, 1.0)),
        is_exclusive=table.read("alone", flag, False),
        is_global=table.read("global", flag, False),
        is_learned=table.read("learned", flag, False),
        replaces=tuple(
            filter(None, (_bind(each, may_replace=False) for each in table.tables("replaces")))
        )
        if may_replace
        else (),
    )
    table.refuse_others()
    if not {"source", "target"} <= table.data.keys():
        table.add_error("", "needs a source and a target")
    if source is None or param is None:
        return None
    for name, reason in _conflicts(bind, table.data):
        table.add_error(name, reason)
    return bind


def _conflicts(bind: Bind, entry: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Entries of a bind that exclude each other, and why."""
    found = []
    if bind.curve is Curve.EXP and min(bind.ends) <= 0.0:
        found.append(("curve", "an exp curve needs a span above zero"))
    if sources.is_address(bind.source):
        if "channel" in entry:
            found.append(("channel", "an OSC address has no channel"))
        if bind.is_global:
            found.append(("global", "an OSC address always is global"))
    else:
        for name, what in (("input", "an input range"), ("part", "a part")):
            if name in entry:
                found.append((name, f"only OSC addresses have {what}"))
    if bind.is_soft and (bind.source in sources.OF_ONE_NOTE or bind.is_by_range):
        what = "the bend by the bend range" if bind.is_by_range else bind.source
        found.append(("soft", f"{what} cannot wait for the target"))
    if bind.is_global and bind.source in sources.OF_ONE_NOTE:
        found.append(("global", f"{bind.source} belongs to one note"))
    return found
