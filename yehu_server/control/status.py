"""The status values: name, kind, unit, meaning, and how each is read. The one table of them.

OSC, OSCQuery, the metrics, the command's status line and docs/osc.md take them from here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from yehu_server.control.osc import OscHandler
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
    """What the status values are read from at one moment."""

    meters: Any  # a record of dtype telemetry.METERS
    instrument: Instrument
    player: LivePlayer
    delay: Delay
    output: OutputState
    blocksize: int
    handler: OscHandler
    osc: Traffic
    web: WebTraffic
    midi: MidiPorts | None
    recording: str
    uptime_s: float


class Kind(Enum):
    """What a status value is."""

    TEXT = "text"
    GAUGE = "gauge"  # a number that goes up and down
    COUNTER = "counter"  # one that only grows


@dataclass(frozen=True)
class StatusValue:
    """One row of the table."""

    name: str
    kind: Kind
    doc: str
    read: Callable[[StatusSources], float | str]
    unit: str = "1"


TEXT, GAUGE, COUNTER = Kind.TEXT, Kind.GAUGE, Kind.COUNTER


def _count(name: str) -> Callable[[StatusSources], int]:
    """How to read a whole number of the meters."""
    return lambda now: int(now.meters[name])


def _number(name: str) -> Callable[[StatusSources], float]:
    """How to read another number of the meters."""
    return lambda now: float(now.meters[name])


def _decibels(name: str) -> Callable[[StatusSources], float]:
    """How to read an amplitude of the meters as decibels."""
    least = 10.0 ** (SILENT_DB / 20.0)
    return lambda now: 20.0 * math.log10(max(float(now.meters[name]), least))


STATUS: tuple[StatusValue, ...] = (
    StatusValue("device", TEXT, "What plays.", lambda now: now.output.device or "silent clock"),
    StatusValue("problem", TEXT, "Why no device does.", lambda now: now.output.problem),
    StatusValue("rate", GAUGE, "Sample rate of the device.", lambda now: now.instrument.rate, "Hz"),
    StatusValue(
        "blocksize",
        GAUGE,
        "Frames asked for at a time, as --blocksize has it.",
        lambda now: now.blocksize,
    ),
    StatusValue(
        "period",
        GAUGE,
        "Frames the device really asks for at once, at most.",
        lambda now: now.delay.period,
    ),
    StatusValue(
        "latency_ms",
        GAUGE,
        "Latency of the device, as it says.",
        lambda now: now.output.latency_ms,
        "ms",
    ),
    StatusValue(
        "delay_ms",
        GAUGE,
        "From a message to its sound, before the device.",
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
        "The pitch that sounds, of a note or drawn by hand; -1 where none does.",
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
        "Which string the bow lies on; 0 lifted.",
        lambda now: now.player.value("/bow/side"),
    ),
    StatusValue(
        "load",
        GAUGE,
        "CPU time of the callback over its deadline, mean of a second.",
        _number("load"),
    ),
    StatusValue("worst_load", GAUGE, "The same, worst since the start.", _number("worst_load")),
    StatusValue(
        "missed_deadlines",
        COUNTER,
        "Callbacks that took more CPU time than they have.",
        _count("missed"),
    ),
    StatusValue(
        "late_callbacks",
        COUNTER,
        "Requests of the device two periods late or more.",
        _count("late_callbacks"),
    ),
    StatusValue(
        "underruns", COUNTER, "Under-runs, as the device reports them.", _count("underruns")
    ),
    StatusValue(
        "device_losses",
        COUNTER,
        "How often the device went away.",
        lambda now: now.output.losses,
    ),
    StatusValue(
        "applied_events",
        COUNTER,
        "Moves of bow and finger that reached the model.",
        _count("applied"),
    ),
    StatusValue(
        "late_events", COUNTER, "Moves that came after their frame.", _count("late_events")
    ),
    StatusValue(
        "dropped_events",
        COUNTER,
        "Moves that found the ring full.",
        lambda now: now.instrument.dropped_events,
    ),
    StatusValue("waiting_events", GAUGE, "Moves that wait for their frame.", _count("waiting")),
    StatusValue(
        "unconverged_solves",
        COUNTER,
        "Friction solves that did not converge.",
        _count("unconverged"),
    ),
    StatusValue(
        "lost_states", COUNTER, "How often the model was put back to rest.", _count("lost")
    ),
    StatusValue("osc_packets", COUNTER, "OSC packets that came in.", lambda now: now.osc.packets),
    StatusValue(
        "osc_messages",
        COUNTER,
        "OSC messages that came in.",
        lambda now: now.handler.counts.messages,
    ),
    StatusValue(
        "osc_malformed",
        COUNTER,
        "Packets that are no OSC.",
        lambda now: now.handler.counts.malformed,
    ),
    StatusValue(
        "osc_errors",
        COUNTER,
        "Messages that could not be done.",
        lambda now: now.handler.counts.errors,
    ),
    StatusValue(
        "osc_refused",
        COUNTER,
        "Packets of senders who are not allowed, and connections refused.",
        lambda now: now.osc.refused,
    ),
    StatusValue(
        "osc_dropped",
        COUNTER,
        "Packets the system lost for want of room.",
        lambda now: now.osc.kernel_drops,
    ),
    StatusValue(
        "osc_excess",
        COUNTER,
        "Packets dropped since their sender has too many waiting.",
        lambda now: now.osc.excess,
    ),
    StatusValue(
        "osc_unsent",
        COUNTER,
        "Answers dropped: too many, or nobody takes them.",
        lambda now: now.osc.unsent,
    ),
    StatusValue(
        "osc_failures",
        COUNTER,
        "Messages that met a defect of the server: please report it, with the log.",
        lambda now: now.osc.failures,
    ),
    StatusValue(
        "osc_buffer_bytes",
        GAUGE,
        "Room for packets that the system grants.",
        lambda now: now.osc.buffer_bytes,
        "bytes",
    ),
    StatusValue(
        "osc_connections", GAUGE, "TCP connections for OSC.", lambda now: now.osc.connections
    ),
    StatusValue(
        "osc_subscribers",
        GAUGE,
        "Who is told of every change.",
        lambda now: now.handler.clients.subscribers,
    ),
    StatusValue(
        "scheduled",
        GAUGE,
        "Messages that wait for their time.",
        lambda now: now.handler.waiting,
    ),
    StatusValue(
        "late_bundles",
        COUNTER,
        "Bundles that came after their time.",
        lambda now: now.handler.counts.late_bundles,
    ),
    StatusValue(
        "midi_ports",
        TEXT,
        "The MIDI inputs that are connected.",
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
        "MIDI messages that came in.",
        lambda now: now.midi.received if now.midi else 0,
    ),
    StatusValue(
        "midi_malformed",
        COUNTER,
        "Damaged MIDI messages.",
        lambda now: now.midi.malformed if now.midi else 0,
    ),
    StatusValue(
        "http_requests",
        COUNTER,
        "HTTP requests that came in, and WebSockets.",
        lambda now: now.web.requests,
    ),
    StatusValue(
        "http_refused",
        COUNTER,
        "Requests that are not allowed, or are too many.",
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
        "What WebSockets missed because they read too slowly.",
        lambda now: now.web.unsent,
    ),
    StatusValue("web_sockets", GAUGE, "WebSockets that are open.", lambda now: now.web.web_sockets),
    StatusValue("recording", TEXT, "The file being written.", lambda now: now.recording),
)
STATUS_ADDRESSES = frozenset(PLACE + row.name for row in STATUS)


def read_status(now: StatusSources) -> dict[str, float | str]:
    """Every status value at one moment, by name, in the table's order."""
    return {row.name: row.read(now) for row in STATUS}


def as_argument(value: float | str) -> float | str:
    """A status value as OSC carries it: Pure Data and Max read no ints of 64 bits."""
    return float(value) if isinstance(value, int) and abs(value) > INT_MAX else value
