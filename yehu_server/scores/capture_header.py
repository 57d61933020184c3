"""What a captured session starts from: the first line of its file; docs/capture.md describes it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import MOST_PARTS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.grid import check_rate
from yehu_server.core.physics.layout import STRINGS
from yehu_server.core.physics.quantities import (
    Body,
    Quantities,
    check_body,
    measured_body,
    override,
)
from yehu_server.core.player.bowing import default_recipes
from yehu_server.core.player.calibration import Calibration
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.errors import ParameterError
from yehu_server.params.table import find
from yehu_server.playing.calibration_store import as_data, read_calibration
from yehu_server.scores.capture_format import FORMAT, VERSION, build, frames_of

LOWEST_A4, HIGHEST_A4 = 1.0, 20000.0  # Hz


@dataclass(frozen=True)
class SessionStart:
    """All that a session starts from: the players in their order on the stage."""

    players: tuple[InstrumentSpec, ...]
    has_room: bool = False

    @property
    def rate(self) -> float:
        """Sample rate (Hz)."""
        return self.players[0].rate

    def ensemble(self) -> Ensemble:
        """Instruments on their stage that start so."""
        return Ensemble(self.players, has_room=self.has_room)


def session_start_of(instruments: Sequence[Instrument], *, has_room: bool) -> SessionStart:
    """What instruments on one stage started from."""
    return SessionStart(tuple(instrument.spec for instrument in instruments), has_room)


# ---------------------------------------------------------------- as JSON values


def header_of(beginning: SessionStart) -> dict[str, Any]:
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


def _as_data(start: InstrumentSpec, before: Sequence[InstrumentSpec]) -> dict[str, Any]:
    """The JSON values of a player; what an earlier player has too is given as its number."""
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
        "values": start.values,
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


def read_header(header: Any, version: int) -> SessionStart:
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
        tuned = _tuned(header["tensions"])
        start = _start(header, rate, tuned, []) if version > 1 else _first(header, rate, tuned)
        return SessionStart((start,), bool(header.get("room", False)))
    entries, starts = header["players"], list[InstrumentSpec]()
    if not isinstance(entries, list) or not 1 <= len(entries) <= MOST_PARTS:
        raise ParameterError(f"expected 1 to {MOST_PARTS} players")
    for entry in entries:
        starts.append(_start(entry, rate, _quantities(entry["quantities"]), starts))
    if type(header["room"]) is not bool:
        raise ValueError("room")
    return SessionStart(tuple(starts), header["room"])


def _first(header: Any, rate: float, quantities: Quantities) -> InstrumentSpec:
    """The start of a session of version 1, which has no player."""
    return InstrumentSpec(rate, quantities, start_values=_values(header["values"]))


def _tuned(tensions: Any) -> Quantities:
    first, second = map(float, tensions)
    return override(Quantities(), {"string_1": {"T": first}, "string_2": {"T": second}})


def _start(
    entry: Any, rate: float, quantities: Quantities, before: Sequence[InstrumentSpec]
) -> InstrumentSpec:
    """The start of a player, some of which come before."""
    return InstrumentSpec(
        rate,
        quantities,
        seed=frames_of(entry["seed"]),
        open_strings=OpenStrings(entry["open_strings"]),
        calibration=_calibration(entry["calibration"], before),
        bowing=_bowing(entry["bowing"], before),
        start_values=_values(entry["values"]),
        body=frames_of(entry.get("body", 0)),
    )


def _calibration(data: Any, before: Sequence[InstrumentSpec]) -> Calibration | None:
    if data is None:
        return None
    if type(data) is int:
        return before[_number(data) - 1].calibration
    a4 = float(data["a4"])
    if not LOWEST_A4 <= a4 <= HIGHEST_A4:
        raise ValueError("a4")
    return read_calibration(data, Quantities(), a4)


def _bowing(data: Any, before: Sequence[InstrumentSpec]) -> Any:
    if type(data) is int:
        return before[_number(data) - 1].bowing
    bowing = np.array(data, np.float64)
    if bowing.ndim == 3:  # of captures made when both strings were bowed by one table
        bowing = np.stack([bowing] * STRINGS)
    if bowing.shape != default_recipes().shape or not np.all(np.isfinite(bowing)):
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
