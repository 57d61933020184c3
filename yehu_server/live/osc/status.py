"""The one table of status values: name, kind, meaning, unit, and how each is read.

OSC, OSCQuery, the metrics, the status line of `serve` and docs/osc.md take them from here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from yehu_server.live.osc.part_status import PART_ROWS, Kind, PartSources, decibels

if TYPE_CHECKING:
    from yehu_server.core.engine.ensemble import Ensemble
    from yehu_server.live.midi.ports import MidiPorts
    from yehu_server.live.osc.peers import Traffic, WebTraffic
    from yehu_server.playing.delay import Delay

STATUS_PREFIX = "/status/"  # before the names, in addresses
INT_MAX = (1 << 31) - 1


class OutputState(Protocol):
    """See ``live.audio.output.OutputState``."""

    device: str | None
    latency_ms: float
    losses: int
    problem: str


@dataclass
class Counts:
    """Numbers of OSC messages since the start."""

    messages: int = 0
    malformed: int = 0
    errors: int = 0  # wrong types, unknown addresses, refused calls
    late_bundles: int = 0
    scheduled: int = 0


@dataclass(frozen=True)
class StatusSources:
    """What the status values are read from."""

    parts: Sequence[PartSources]
    ensemble: Ensemble
    delay: Delay
    output: OutputState
    blocksize: int
    osc: Traffic
    messages: Counts
    scheduled: int
    subscribers: int
    web: WebTraffic
    midi: MidiPorts | None
    recording: str
    uptime_s: float


@dataclass(frozen=True)
class StatusValue:
    """A row of the table."""

    name: str
    kind: Kind
    doc: str
    read: Callable[[StatusSources], float | str]
    unit: str = "1"


TEXT, GAUGE, COUNTER = Kind.TEXT, Kind.GAUGE, Kind.COUNTER


def _count(name: str) -> Callable[[StatusSources], int]:
    """Read a whole number of the callback's meters, which the first instrument has."""
    return lambda now: int(now.parts[0].meters[0][name])


def _number(name: str) -> Callable[[StatusSources], float]:
    """Read another number of the callback's meters."""
    return lambda now: float(now.parts[0].meters[0][name])


def _count_of_midi(name: str) -> Callable[[StatusSources], int]:
    """Add up a count of what the parts were sent."""
    return lambda now: sum(int(part.instruments[0].midi[name]) for part in now.parts)


def _of_parts(name: str) -> StatusValue:
    """The status value of all parts that is the sum of theirs, or the first one's."""
    row = PART_ROWS[name]

    def read(now: StatusSources) -> float:
        counted = now.parts if row.is_sum else now.parts[:1]
        values = [row.read(part) for part in counted]
        return sum(values[1:], values[0])

    return StatusValue(row.name, row.kind, row.doc, read, row.unit)


STATUS: tuple[StatusValue, ...] = (
    StatusValue(
        "device",
        TEXT,
        "Device that plays, or silent clock.",
        lambda now: now.output.device or "silent clock",
    ),
    StatusValue(
        "problem",
        TEXT,
        "Why no device plays; empty where one does.",
        lambda now: now.output.problem,
    ),
    StatusValue("rate", GAUGE, "Sample rate of the device.", lambda now: now.ensemble.rate, "Hz"),
    StatusValue(
        "blocksize",
        GAUGE,
        "Frames computed at a time, as set by --blocksize.",
        lambda now: now.blocksize,
    ),
    StatusValue(
        "period",
        GAUGE,
        "Largest number of frames that the device asks for at once.",
        lambda now: now.delay.period,
    ),
    StatusValue(
        "latency_ms",
        GAUGE,
        "Latency that the device reports.",
        lambda now: now.output.latency_ms,
        "ms",
    ),
    StatusValue(
        "delay_ms",
        GAUGE,
        "Delay from a message to its sound, without the device's latency.",
        lambda now: 1e3 * now.parts[0].player.delay / now.ensemble.rate,
        "ms",
    ),
    StatusValue("uptime_s", GAUGE, "Time since the start.", lambda now: now.uptime_s, "s"),
    StatusValue("frame", COUNTER, "Frames played since the start.", _count("frame")),
    StatusValue(
        "peak_db",
        GAUGE,
        "Peak of the last sixtieth of a second, dBFS.",
        lambda now: decibels(now.ensemble.level[0]),
        "dB",
    ),
    StatusValue(
        "rms_db",
        GAUGE,
        "Level of the last sixtieth of a second, dBFS.",
        lambda now: decibels(now.ensemble.level[1]),
        "dB",
    ),
    StatusValue("parts", GAUGE, "Number of parts.", lambda now: len(now.parts)),
    _of_parts("note"),
    _of_parts("bow_speed"),
    _of_parts("bow_side"),
    StatusValue(
        "load",
        GAUGE,
        "CPU time of the callback divided by its deadline, mean of a second.",
        _number("load"),
    ),
    StatusValue("worst_load", GAUGE, "The same, largest since the start.", _number("worst_load")),
    StatusValue(
        "missed_deadlines",
        COUNTER,
        "Callbacks that took more CPU time than their deadline.",
        _count("missed"),
    ),
    StatusValue(
        "late_callbacks",
        COUNTER,
        "Requests of the device that came two periods late or more.",
        _count("late_callbacks"),
    ),
    StatusValue("underruns", COUNTER, "Under-runs that the device reported.", _count("underruns")),
    StatusValue(
        "device_losses",
        COUNTER,
        "Number of times the device disappeared.",
        lambda now: now.output.losses,
    ),
    _of_parts("applied_events"),
    _of_parts("late_events"),
    _of_parts("dropped_events"),
    _of_parts("waiting_events"),
    _of_parts("unconverged_solves"),
    _of_parts("lost_states"),
    StatusValue("osc_packets", COUNTER, "OSC packets received.", lambda now: now.osc.packets),
    StatusValue(
        "osc_messages",
        COUNTER,
        "OSC messages received.",
        lambda now: now.messages.messages,
    ),
    StatusValue(
        "osc_malformed",
        COUNTER,
        "Packets that are not OSC.",
        lambda now: now.messages.malformed,
    ),
    StatusValue(
        "osc_errors",
        COUNTER,
        "Messages that could not be carried out.",
        lambda now: now.messages.errors,
    ),
    StatusValue(
        "osc_refused",
        COUNTER,
        "Packets of senders that are not allowed, and refused connections.",
        lambda now: now.osc.refused,
    ),
    StatusValue(
        "osc_dropped",
        COUNTER,
        "Packets dropped by the system because its buffer was full.",
        lambda now: now.osc.kernel_drops,
    ),
    StatusValue(
        "osc_excess",
        COUNTER,
        "Packets dropped because their sender had too many waiting.",
        lambda now: now.osc.excess,
    ),
    StatusValue(
        "osc_unsent",
        COUNTER,
        "Answers dropped because they were too many, or not read.",
        lambda now: now.osc.unsent,
    ),
    StatusValue(
        "osc_failures",
        COUNTER,
        "Messages that met a defect of the server; please report it, with the log.",
        lambda now: now.osc.failures,
    ),
    StatusValue(
        "osc_buffer_bytes",
        GAUGE,
        "Size of the system's buffer for packets.",
        lambda now: now.osc.buffer_bytes,
        "bytes",
    ),
    StatusValue(
        "osc_connections",
        GAUGE,
        "Number of TCP connections for OSC.",
        lambda now: now.osc.connections,
    ),
    StatusValue(
        "osc_subscribers",
        GAUGE,
        "Number of subscribers.",
        lambda now: now.subscribers,
    ),
    StatusValue(
        "scheduled",
        GAUGE,
        "Messages that wait for their time tag.",
        lambda now: now.scheduled,
    ),
    StatusValue(
        "late_bundles",
        COUNTER,
        "Bundles that came after their time tag.",
        lambda now: now.messages.late_bundles,
    ),
    StatusValue(
        "midi_ports",
        TEXT,
        "Names of connected MIDI inputs.",
        lambda now: "; ".join(now.midi.connected) if now.midi else "",
    ),
    StatusValue(
        "midi_connected",
        GAUGE,
        "Number of connected MIDI inputs.",
        lambda now: len(now.midi.connected) if now.midi else 0,
    ),
    StatusValue(
        "midi_messages",
        COUNTER,
        "MIDI messages that parts received.",
        _count_of_midi("messages"),
    ),
    StatusValue(
        "midi_malformed",
        COUNTER,
        "Damaged MIDI messages that parts received.",
        _count_of_midi("malformed"),
    ),
    StatusValue(
        "http_requests",
        COUNTER,
        "HTTP requests received, with those for WebSockets.",
        lambda now: now.web.requests,
    ),
    StatusValue(
        "http_refused",
        COUNTER,
        "Requests refused because they were not allowed, or too many.",
        lambda now: now.web.refused,
    ),
    StatusValue(
        "http_failures",
        COUNTER,
        "Requests that met a defect of the server.",
        lambda now: now.web.failures,
    ),
    StatusValue(
        "http_unsent",
        COUNTER,
        "Messages dropped because a WebSocket read too slowly.",
        lambda now: now.web.unsent,
    ),
    StatusValue(
        "web_sockets", GAUGE, "Number of open WebSockets.", lambda now: now.web.web_sockets
    ),
    StatusValue("recording", TEXT, "Names of the files being recorded.", lambda now: now.recording),
)
STATUS_ADDRESSES = frozenset(STATUS_PREFIX + row.name for row in STATUS)


def read_status(now: StatusSources) -> dict[str, float | str]:
    """All status values, by name, in the table's order."""
    return {row.name: row.read(now) for row in STATUS}


def as_argument(value: float | str) -> float | str:
    """A status value for OSC, where Pure Data and Max read no ints of 64 bits: those as floats."""
    return float(value) if isinstance(value, int) and abs(value) > INT_MAX else value
