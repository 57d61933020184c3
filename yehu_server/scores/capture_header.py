"""The first line of a capture: what the session starts from; docs/capture.md describes it."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import (
    Body,
    Quantities,
    check_body,
    measured_body,
    override,
)
from yehu_server.core.physics.layout import MAX_MODES, MAX_SECTIONS, STRINGS
from yehu_server.core.player.bowing import NOTES, default_bowing_table
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.core.player.note_tables import NoteTables
from yehu_server.errors import ParameterError
from yehu_server.params.table import find
from yehu_server.playing.calibration_store import read_measured
from yehu_server.scores.capture_format import FORMAT, MAX_FRAMES, VERSION, build
from yehu_server.scores.gesture import sample_rate
from yehu_server.util.documents import Fields
from yehu_server.util.values import brief, choice, flag, number, whole

A4_RANGE = 1.0, 20000.0  # Hz, of files
FORMER_NOTES = 28  # in the bowing tables of captures made when fiddles had fewer high notes


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
    """The start of a session of instruments on one stage."""
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
        "players": [_as_data(start, starts[:place]) for place, start in enumerate(starts)],
    }


def _as_data(start: InstrumentSpec, before: Sequence[InstrumentSpec]) -> dict[str, Any]:
    """The JSON values of a player; what an earlier player has too is given as its number."""
    calibration, others = start.calibration, list(enumerate(before, start=1))
    tuned_alike = (at for at, other in others if calibration and other.calibration == calibration)
    bowed_alike = (at for at, other in others if np.array_equal(other.bowing, start.bowing))
    return {
        "seed": start.seed,
        "open_strings": start.open_strings.value,
        "calibration": next(tuned_alike, None if calibration is None else asdict(calibration)),
        "bowing": next(bowed_alike, None) or start.bowing.tolist(),
        "body": start.body,
        "quantities": _changes(start.quantities, Quantities()),
        "values": start.values,
    }


def _changes(own: Any, default: Any) -> dict[str, Any]:
    """The differences between quantities, as ``physics.default_quantities.override`` takes them."""
    changes: dict[str, Any] = {}
    for item in fields(own):
        value, base = getattr(own, item.name), getattr(default, item.name)
        if value == base:
            continue
        if isinstance(value, Body):
            changes[item.name] = {part.name: getattr(value, part.name) for part in fields(value)}
        else:
            changes[item.name] = _changes(value, base) if is_dataclass(value) else value
    return changes


# ---------------------------------------------------------------- reading


def read_header(table: Fields, version: int) -> SessionStart:
    """The start of a session, from the first line of its capture.

    Raises YehuError, that of the document, or ParameterError, where a value is missing, none or out
    of range.
    """
    rate = table.need("rate", sample_rate)
    if version < VERSION:
        quantities = table.need("tensions", _tuned)
        if version == 1:  # which has no player
            values = table.need("values", _values)
            start = InstrumentSpec(rate, quantities, start_values=values)
        else:
            start = _start(table, rate, quantities, [])
        return SessionStart((start,), bool(table.data.get("room", False)))
    starts = list[InstrumentSpec]()
    for entry in table.tables("players", 1, MAX_PARTS):
        starts.append(_start(entry, rate, entry.need("quantities", _quantities), starts))
    return SessionStart(tuple(starts), table.need("room", flag))


def _tuned(tensions: Any) -> Quantities:
    first, second = _floats(tensions, [2])
    return override(Quantities(), {"string_1": {"T": first}, "string_2": {"T": second}})


def _start(
    table: Fields, rate: float, quantities: Quantities, before: Sequence[InstrumentSpec]
) -> InstrumentSpec:
    """The start of a player, some of which come before."""
    return InstrumentSpec(
        rate,
        quantities,
        seed=table.need("seed", whole, 0, MAX_FRAMES),
        open_strings=OpenStrings(
            table.need("open_strings", choice, [each.value for each in OpenStrings])
        ),
        calibration=table.need("calibration", _calibration, before),
        bowing=table.need("bowing", _bowing, before),
        start_values=table.need("values", _values),
        body=table.read("body", whole, 0, 0, MAX_FRAMES),
    )


def _calibration(data: Any, before: Sequence[InstrumentSpec]) -> NoteTables | None:
    if data is None:
        return None
    if type(data) is int:
        return before[whole(data, 1, len(before)) - 1].calibration
    Fields(data).need("a4", number, *A4_RANGE)
    return read_measured(data)


def _bowing(data: Any, before: Sequence[InstrumentSpec]) -> Any:
    if type(data) is int:
        return before[whole(data, 1, len(before)) - 1].bowing
    try:
        bowing = np.array(data, np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ParameterError(f"expected numbers, got {brief(data)}") from None
    if bowing.ndim == 3:  # of captures made when both strings were bowed by one table
        bowing = np.stack([bowing] * STRINGS)
    if bowing.ndim == 4 and bowing.shape[2] == FORMER_NOTES:
        highest = np.repeat(bowing[:, :, -1:], NOTES - FORMER_NOTES, axis=2)
        bowing = np.concatenate([bowing, highest], axis=2)
    if bowing.shape != default_bowing_table().shape or not np.all(np.isfinite(bowing)):
        raise ParameterError("expected finite numbers for each string, place and note")
    return bowing


def _values(data: Any) -> dict[str, float]:
    """Values of parameters, by address; raises ParameterError where one is unknown or outside."""
    return Fields(data).each(lambda address, value: find(address).within(value))


def _quantities(data: Any) -> Quantities:
    """Quantities by what differs from the measured ones."""
    changes = Fields(data).data
    quantities = override(
        Quantities(), {name: value for name, value in changes.items() if name != "body"}
    )
    if "body" not in changes:
        return quantities
    return replace(quantities, body=_body(Fields(changes["body"], place="body")))


def _body(table: Fields) -> Body:
    """A body that is passive and stable."""
    frequency_hz = table.need("frequency_hz", _floats, range(1, MAX_MODES + 1))
    modes = [len(frequency_hz)]
    body = Body(
        frequency_hz=frequency_hz,
        mass=table.need("mass", _floats, modes),
        damping=table.need("damping", _floats, modes),
        radiation_rate=table.read("radiation_rate", number, measured_body().radiation_rate),
        sections=table.need("sections", _sections),
        direct_gain=table.need("direct_gain", number),
    )
    check_body(body)
    return body


def _sections(data: Any) -> tuple[tuple[float, float, float, float], ...]:
    if not isinstance(data, list) or len(data) > MAX_SECTIONS:
        raise ParameterError(f"expected lists of [b0, b1, a1, a2], got {brief(data)}")
    return tuple((b0, b1, a1, a2) for b0, b1, a1, a2 in (_floats(row, [4]) for row in data))


def _floats(data: Any, counts: Sequence[int]) -> tuple[float, ...]:
    if not isinstance(data, list) or len(data) not in counts:
        number_of = f"{counts[0]}" if len(counts) == 1 else f"{counts[0]} to {counts[-1]}"
        raise ParameterError(f"expected {number_of} numbers, got {brief(data)}")
    return tuple(map(number, data))
