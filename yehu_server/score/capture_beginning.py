"""What a captured session starts from: the first line of its file; docs/capture.md describes it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from yehu_server.engine.ensemble import Ensemble
from yehu_server.engine.instrument import Instrument
from yehu_server.engine.rig import MOST_PARTS
from yehu_server.errors import ParameterError
from yehu_server.params.table import find
from yehu_server.physics.grid import check_rate
from yehu_server.physics.layout import STRINGS
from yehu_server.physics.quantities import (
    Body,
    Quantities,
    check_body,
    measured_body,
    override,
)
from yehu_server.player.bowing import ordinary_table
from yehu_server.player.calibration import Calibration
from yehu_server.player.fingering import OpenStrings
from yehu_server.playing.calibrations import as_data, read_calibration
from yehu_server.score.capture_format import FORMAT, VERSION, build, frames_of

LOWEST_A4, HIGHEST_A4 = 1.0, 20000.0  # Hz


@dataclass(frozen=True)
class Start:
    """All that an instrument and its player start from."""

    quantities: Quantities  # as tuned
    seed: int = 0
    open_strings: OpenStrings = OpenStrings.ALWAYS
    calibration: Calibration | None = None
    bowing: Any = field(default_factory=ordinary_table)
    values: Mapping[str, float] = field(default_factory=dict)  # of parameters; others: default
    body: int = 0

    def instrument(self, rate: float, memory: Any = None) -> Instrument:
        """An instrument that starts so."""
        return Instrument(
            rate,
            self.quantities,
            calibration=self.calibration,
            bowing=self.bowing,
            open_strings=self.open_strings,
            seed=self.seed,
            start_values=self.values,
            body=self.body,
            memory=memory,
        )


@dataclass(frozen=True)
class Beginning:
    """All that a session starts from."""

    rate: float
    players: tuple[Start, ...]  # in their order on the stage
    has_room: bool = False

    def ensemble(self) -> Ensemble:
        """Instruments on their stage that start so."""
        makes = [partial(_make, start, self.rate) for start in self.players]
        return Ensemble(makes, has_room=self.has_room)


def _make(start: Start, rate: float, memory: Any) -> Instrument:
    return start.instrument(rate, memory)


def beginning_of(instruments: Sequence[Instrument], *, has_room: bool) -> Beginning:
    """What instruments on one stage started from."""
    players = tuple(
        Start(
            one.quantities,
            one.seed,
            one.open_strings,
            one.calibration,
            one.bowing,
            one.start_values,
            one.body,
        )
        for one in instruments
    )
    return Beginning(instruments[0].rate, players, has_room)


# ---------------------------------------------------------------- as JSON values


def header_of(beginning: Beginning) -> dict[str, Any]:
    """The first line of a capture."""
    starts = beginning.players
    return {
        "format": FORMAT,
        "version": VERSION,
        "rate": beginning.rate,
        "room": beginning.has_room,
        "build": build(),
        "players": [_as_data(start, starts[:number]) for number, start in enumerate(starts)],
    }


def _as_data(start: Start, before: Sequence[Start]) -> dict[str, Any]:
    """The JSON values of a player, where some come before; what is one's of those is named so."""
    calibration: Any = None if start.calibration is None else as_data(start.calibration)
    bowing: Any = start.bowing.tolist()
    for number, other in enumerate(before, start=1):
        if other.calibration is not None and other.calibration == start.calibration:
            calibration = number
            break
    for number, other in enumerate(before, start=1):
        if np.array_equal(other.bowing, start.bowing):
            bowing = number
            break
    return {
        "seed": start.seed,
        "open_strings": start.open_strings.value,
        "calibration": calibration,
        "bowing": bowing,
        "body": start.body,
        "quantities": _changes(start.quantities, Quantities()),
        "values": dict(start.values),
    }


def _changes(own: Any, usual: Any) -> dict[str, Any]:
    """What differs between quantities, as ``physics.quantities.override`` takes it."""
    changes: dict[str, Any] = {}
    for item in fields(own):
        value, base = getattr(own, item.name), getattr(usual, item.name)
        if value == base:
            continue
        if isinstance(value, Body):
            changes[item.name] = {part.name: getattr(value, part.name) for part in fields(value)}
        else:
            changes[item.name] = _changes(value, base) if is_dataclass(value) else value
    return changes


# ---------------------------------------------------------------- reading


def read_header(header: Any, version: int) -> Beginning:
    """What a session starts from, by the first line of its capture.

    Raises
    ------
    ParameterError
        Where a value is out of range.
    ValueError, TypeError, KeyError, IndexError, AttributeError, OverflowError
        Where it is none.
    """
    rate = float(header["rate"])
    check_rate(rate)
    if version < VERSION:
        start = _start(header, _tuned(header["tensions"]), []) if version > 1 else _first(header)
        return Beginning(rate, (start,), bool(header.get("room", False)))
    entries, starts = header["players"], list[Start]()
    if not isinstance(entries, list) or not 1 <= len(entries) <= MOST_PARTS:
        raise ParameterError(f"expected 1 to {MOST_PARTS} players")
    for entry in entries:
        starts.append(_start(entry, _quantities(entry["quantities"]), starts))
    if type(header["room"]) is not bool:
        raise ValueError("room")
    return Beginning(rate, tuple(starts), header["room"])


def _first(header: Any) -> Start:
    """The start of a session of version 1, which has no player."""
    return Start(_tuned(header["tensions"]), values=_values(header["values"]))


def _tuned(tensions: Any) -> Quantities:
    first, second = map(float, tensions)
    return override(Quantities(), {"string_1": {"T": first}, "string_2": {"T": second}})


def _start(entry: Any, quantities: Quantities, before: Sequence[Start]) -> Start:
    """The start of a player, some of which come before."""
    return Start(
        quantities,
        seed=frames_of(entry["seed"]),
        open_strings=OpenStrings(entry["open_strings"]),
        calibration=_calibration(entry["calibration"], before),
        bowing=_bowing(entry["bowing"], before),
        values=_values(entry["values"]),
        body=frames_of(entry.get("body", 0)),
    )


def _calibration(data: Any, before: Sequence[Start]) -> Calibration | None:
    if data is None:
        return None
    if type(data) is int:
        return before[_number(data) - 1].calibration
    a4 = float(data["a4"])
    if not LOWEST_A4 <= a4 <= HIGHEST_A4:
        raise ValueError("a4")
    return read_calibration(data, Quantities(), a4)


def _bowing(data: Any, before: Sequence[Start]) -> Any:
    if type(data) is int:
        return before[_number(data) - 1].bowing
    bowing = np.array(data, np.float64)
    if bowing.ndim == 3:  # of captures made when both strings were bowed by one table
        bowing = np.stack([bowing] * STRINGS)
    if bowing.shape != ordinary_table().shape or not np.all(np.isfinite(bowing)):
        raise ValueError("bowing")
    return bowing


def _number(data: int) -> int:
    if not 1 <= data <= MOST_PARTS:
        raise ValueError("a player that is not there")
    return data


def _values(values: Mapping[str, float]) -> dict[str, float]:
    """Values of parameters, by address; raises ParameterError where one is unknown or outside."""
    for address, value in values.items():
        param = find(address)
        if param.accept(value) != value:
            raise ParameterError(f"{address}: {value} is not within {param.range_text}")
    return dict(values)


def _quantities(changes: Any) -> Quantities:
    """Quantities by what differs from the measured ones; raises ParameterError, ValueError."""
    others = {name: value for name, value in changes.items() if name != "body"}
    quantities = override(Quantities(), others)
    if "body" not in changes:
        return quantities
    return replace(quantities, body=_body(changes["body"]))


def _body(data: Any) -> Body:
    """A body with as many modes as the measured one, which is passive and stable."""
    usual = measured_body()
    body = Body(
        frequency_hz=_floats(data["frequency_hz"], len(usual.frequency_hz)),
        mass=_floats(data["mass"], len(usual.mass)),
        damping=_floats(data["damping"], len(usual.damping)),
        radiation_rate=usual.radiation_rate,
        sections=tuple(_section(data["sections"][number]) for number in range(len(usual.sections))),
        direct_gain=_floats([data["direct_gain"]], 1)[0],
    )
    check_body(body)
    return body


def _section(data: Any) -> tuple[float, float, float, float]:
    b0, b1, a1, a2 = _floats(data, 4)
    return b0, b1, a1, a2


def _floats(data: Any, count: int) -> tuple[float, ...]:
    numbers = tuple(map(float, data))
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise ValueError(f"expected {count} numbers")
    return numbers
