"""The table of status values that each part has: name, kind, meaning, unit, how each is read."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yehu_server.core.engine.instrument import Instrument
    from yehu_server.playing.live_player import LivePlayer

SILENT_DB = -120.0


class Kind(Enum):
    """Kind of a status value."""

    TEXT = "text"
    GAUGE = "gauge"  # a number that may rise and fall
    COUNTER = "counter"  # a number that only grows


@dataclass(frozen=True)
class PartSources:
    """What the status values of a part are read from."""

    player: LivePlayer
    instruments: Sequence[Instrument]  # one, or those of a section
    meters: Sequence[Any]  # of each: a record of dtype telemetry.METERS


@dataclass(frozen=True)
class PartValue:
    """A row of the table."""

    name: str
    kind: Kind
    doc: str
    read: Callable[[PartSources], float]
    unit: str = "1"
    # Whether there is a status value of all parts, too: their sum, or that of the first.
    is_sum: bool = False
    is_first: bool = False


def _sum(name: str) -> Callable[[PartSources], int]:
    """Add up a whole number of the meters of the instruments."""
    return lambda part: sum(int(meters[name]) for meters in part.meters)


def _level(name: str) -> Callable[[PartSources], float]:
    """Read the largest amplitude of the instruments, in decibels."""
    return lambda part: decibels(max(float(meters[name]) for meters in part.meters))


def decibels(amplitude: float) -> float:
    """An amplitude relative to full scale in dB, at least `SILENT_DB`."""
    return 20.0 * math.log10(max(amplitude, 10.0 ** (SILENT_DB / 20.0)))


def _pitch(part: PartSources) -> float:
    pitch = part.player.pitch
    return -1.0 if pitch is None else pitch


PART_STATUS: tuple[PartValue, ...] = (
    PartValue(
        "note",
        Kind.GAUGE,
        "Pitch that sounds, of a note or of a bow drawn by hand; -1 for none.",
        _pitch,
        "MIDI note",
        is_first=True,
    ),
    PartValue("keys", Kind.GAUGE, "Number of keys that are held.", lambda part: part.player.keys),
    PartValue(
        "bow_speed",
        Kind.GAUGE,
        "Speed of the bow; the sign is its direction.",
        lambda part: part.player.value("/bow/speed"),
        "m/s",
        is_first=True,
    ),
    PartValue(
        "bow_side",
        Kind.GAUGE,
        "String that the bow is on: 1 inner (F4), -1 outer (C5), 0 for none.",
        lambda part: part.player.value("/bow/side"),
        is_first=True,
    ),
    PartValue(
        "peak_db", Kind.GAUGE, "Peak before the stage, of a sixtieth of a second, dBFS.",
        _level("peak"), "dB",
    ),
    PartValue(
        "rms_db", Kind.GAUGE, "Level before the stage, of a sixtieth of a second, dBFS.",
        _level("rms"), "dB",
    ),
    PartValue(
        "applied_events",
        Kind.COUNTER,
        "Events (moves of bow or finger) that reached the model.",
        _sum("applied"),
        is_sum=True,
    ),
    PartValue(
        "late_events",
        Kind.COUNTER,
        "Events that came after their frame.",
        _sum("late_events"),
        is_sum=True,
    ),
    PartValue(
        "dropped_events",
        Kind.COUNTER,
        "Events dropped because the ring was full.",
        lambda part: sum(instrument.dropped_events for instrument in part.instruments),
        is_sum=True,
    ),
    PartValue(
        "waiting_events",
        Kind.GAUGE,
        "Events that wait for their frame.",
        _sum("waiting"),
        is_sum=True,
    ),
    PartValue(
        "unconverged_solves",
        Kind.COUNTER,
        "Friction solves that did not converge.",
        _sum("unconverged"),
        is_sum=True,
    ),
    PartValue(
        "lost_states",
        Kind.COUNTER,
        "Number of times the model lost its state and was put back to rest.",
        _sum("lost"),
        is_sum=True,
    ),
)  # fmt: skip
PART_ROWS = {row.name: row for row in PART_STATUS}


def read_part_status(part: PartSources) -> dict[str, float]:
    """All status values of a part, by name, in the table's order."""
    return {row.name: row.read(part) for row in PART_STATUS}
