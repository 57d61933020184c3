"""The one table of status values: name, kind, meaning, unit, and how each is read.

OSC, OSCQuery, the metrics, the status line of `serve` and docs/osc.md take them from here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from yehu_server.control.osc import Counts
    from yehu_server.control.peers import Traffic, WebTraffic
    from yehu_server.control.ports import MidiPorts
    from yehu_server.engine.instrument import Instrument
    from yehu_server.playing.delay import Delay
    from yehu_server.playing.live import LivePlayer

PLACE = "/status/"  # before the names, in addresses
INT_MAX = (1 << 31) - 1
SILENT_DB = -120.0


class OutputState(Protocol):
    """See ``audio.output.OutputState``."""

    device: str | None
    latency_ms: float
    losses: int
    problem: str


@dataclass(frozen=True)
class StatusSources:
    """What the status values are read from."""

    meters: Any  # a record of dtype telemetry.METERS
    instrument: Instrument
    player: LivePlayer
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


class Kind(Enum):
    """Kind of a status value."""

    TEXT = "text"
    GAUGE = "gauge"  # a number that may rise and fall
    COUNTER = "counter"  # a number that only grows


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
    """Read a whole number of the meters."""
    return lambda now: int(now.meters[name])


def _number(name: str) -> Callable[[StatusSources], float]:
    """Read another number of the meters."""
    return lambda now: float(now.meters[name])


def _decibels(name: str) -> Callable[[StatusSources], float]:
    """Read an amplitude of the meters, in decibels."""
    least = 10.0 ** (SILENT_DB / 20.0)
    return lambda now: 20.0 * math.log10(max(float(now.meters[name]), least))


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
    StatusValue("rate", GAUGE, "Sample rate of the device.", lambda now: now.instrument.rate, "Hz"),
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
        lambda now: 1e3 * now.player.delay / now.instrument.rate,
        "ms",
    ),
    StatusValue("uptime_s", GAUGE, "Time since the start.", lambda now: now.uptime_s, "s"),
    StatusValue("frame", COUNTER, "Frames played since the start.", _count("frame")),
    StatusValue(
        "peak_db", GAUGE, "Peak of the last sixtieth of a second, dBFS.", _decibels("peak"), "dB"
    ),
    StatusValue(
        "rms_db", GAUGE, "Level of the last sixtieth of a second, dBFS.", _decibels("rms"), "dB"
    ),
    StatusValue(
        "note",
        GAUGE,
        "Pitch that sounds, of a note or of a bow drawn by hand; -1 for none.",
        lambda now: -1.0 if now.player.pitch is None else now.player.pitch,
        "MIDI note",
    ),
    StatusValue(
        "bow_speed",
        GAUGE,
        "Speed of the bow; the sign is its direction.",
        lambda now: now.player.value("/bow/speed"),
        "m/s",
    ),
    StatusValue(
        "bow_side",
        GAUGE,
        "String that the bow is on: 1 inner (F4), -1 outer (C5), 0 for none.",
        lambda now: now.player.value("/bow/side"),
    ),
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
    StatusValue(
        "applied_events",
        COUNTER,
        "Events (moves of bow or finger) that reached the model.",
        _count("applied"),
    ),
    StatusValue(
        "late_events", COUNTER, "Events that came after their frame.", _count("late_events")
    ),
    StatusValue(
        "dropped_events",
        COUNTER,
        "Events dropped because the ring was full.",
        lambda now: now.instrument.dropped_events,
    ),
    StatusValue("waiting_events", GAUGE, "Events that wait for their frame.", _count("waiting")),
    StatusValue(
        "unconverged_solves",
        COUNTER,
        "Friction solves that did not converge.",
        _count("unconverged"),
    ),
    StatusValue(
        "lost_states",
        COUNTER,
        "Number of times the model lost its state and was put back to rest.",
        _count("lost"),
    ),
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
        "MIDI messages received.",
        lambda now: now.midi.received if now.midi else 0,
    ),
    StatusValue(
        "midi_malformed",
        COUNTER,
        "Damaged MIDI messages received.",
        lambda now: now.midi.malformed if now.midi else 0,
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
STATUS_ADDRESSES = frozenset(PLACE + row.name for row in STATUS)


def read_status(now: StatusSources) -> dict[str, float | str]:
    """All status values, by name, in the table's order."""
    return {row.name: row.read(now) for row in STATUS}


def as_argument(value: float | str) -> float | str:
    """A status value for OSC, where Pure Data and Max read no ints of 64 bits: those as floats."""
    return float(value) if isinstance(value, int) and abs(value) > INT_MAX else value
