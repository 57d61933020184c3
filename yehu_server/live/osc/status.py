"""The tables of status values: name, kind, meaning, unit, and how each is read.

OSC, OSCQuery, the metrics, the status line of `serve` and docs/osc.md take them from here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from yehu_server.core.midi.packing import unpacked

if TYPE_CHECKING:
    from yehu_server.core.engine.ensemble import Ensemble
    from yehu_server.live.audio.output import OutputState
    from yehu_server.live.midi.midi_inputs import MidiInputs
    from yehu_server.live.osc.peers import Traffic, WebTraffic
    from yehu_server.playing.delay import Delay
    from yehu_server.playing.player import Player

STATUS_PREFIX = "/status/"  # before the names, in addresses
INT_MAX = (1 << 31) - 1
SILENT_DB = -120.0


class Kind(Enum):
    """Kind of a status value."""

    TEXT = "text"
    GAUGE = "gauge"  # a number that may rise and fall
    COUNTER = "counter"  # a number that only grows


@dataclass
class Counts:
    """Numbers of OSC messages since the start."""

    messages: int = 0
    malformed: int = 0
    errors: int = 0  # wrong types, unknown addresses, refused calls
    late_bundles: int = 0


@dataclass(frozen=True)
class PartSources:
    """What the status values of a part are read from."""

    player: Player
    meters: Sequence[Any]  # of each of its instruments: a record of dtype telemetry.METERS

    @classmethod
    def of(cls, player: Player) -> PartSources:
        """What they are now."""
        return cls(player, [instrument.meters() for instrument in player.instruments])


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
    midi: MidiInputs | None
    recording: str
    uptime_s: float


S = TypeVar("S")
V = TypeVar("V", float, float | str)


@dataclass(frozen=True)
class StatusValue(Generic[S, V]):
    """A row of a table."""

    kind: Kind
    name: str
    doc: str
    read: Callable[[S], V]
    unit: str = "1"


PartValue = StatusValue[PartSources, float]
AnyValue = StatusValue[StatusSources, float | str]

_part_gauge, _part_counter = (partial(PartValue, kind) for kind in (Kind.GAUGE, Kind.COUNTER))
_text, _gauge, _counter = (partial(AnyValue, kind) for kind in Kind)


def decibels(amplitude: float) -> float:
    """An amplitude relative to full scale in dB, at least `SILENT_DB`."""
    return 20.0 * math.log10(max(amplitude, 10.0 ** (SILENT_DB / 20.0)))


def _pitch(part: PartSources) -> float:
    pitch = part.player.pitch
    return -1.0 if pitch is None else pitch


def _level(name: str) -> Callable[[PartSources], float]:
    """Read the largest amplitude of a part's instruments, in decibels."""
    return lambda part: decibels(max(float(meters[name]) for meters in part.meters))


def _sum(name: str) -> Callable[[PartSources], int]:
    """Add up a whole number of the meters of a part's instruments."""
    return lambda part: sum(int(meters[name]) for meters in part.meters)


# Of each part.
PART_STATUS: tuple[PartValue, ...] = (
    _part_gauge("note", "Pitch that sounds, of a note or of a bow drawn by hand; -1 for none.",
        _pitch, "MIDI note"),
    _part_gauge("keys", "Number of keys that are held.", lambda p: p.player.keys),
    _part_gauge("bow_speed", "Speed of the bow; the sign is its direction.",
        lambda p: p.player.value("/bow/speed"), "m/s"),
    _part_gauge("bow_side", "String that the bow is on: 1 inner (F4), -1 outer (C5), 0 for none.",
        lambda p: p.player.value("/bow/side")),
    _part_gauge("peak_db", "Peak before the stage, of a sixtieth of a second, dBFS.",
        _level("peak"), "dB"),
    _part_gauge("rms_db", "Level before the stage, of a sixtieth of a second, dBFS.",
        _level("rms"), "dB"),
    _part_counter("applied_events", "Events (moves of bow or finger) that reached the model.",
        _sum("applied")),
    _part_counter("late_events", "Events that came after their frame.", _sum("late_events")),
    _part_counter("dropped_events",
        "Events dropped: the ring was full, or their time was too far ahead.",
        lambda p: sum(one.dropped_events for one in p.player.instruments)),
    _part_gauge("waiting_events", "Events that wait for their frame.", _sum("waiting")),
    _part_counter("unconverged_solves", "Friction solves that did not converge.",
        _sum("unconverged")),
    _part_counter("lost_states",
        "Number of times the model lost its state and was put back to rest.", _sum("lost")),
)  # fmt: skip
_OF_PARTS = {row.name: row for row in PART_STATUS}


def _of_first(name: str) -> AnyValue:
    """The status value of the first part."""
    row = _OF_PARTS[name]
    return AnyValue(row.kind, name, row.doc, lambda s: row.read(s.parts[0]), row.unit)


def _of_all(name: str) -> AnyValue:
    """The sum of a status value of all parts."""
    row = _OF_PARTS[name]
    return AnyValue(row.kind, name, row.doc, lambda s: sum(map(row.read, s.parts)), row.unit)


def _meter(name: str) -> Callable[[StatusSources], float]:
    """Read a number of the callback's meters, which the first instrument has."""
    return lambda s: s.parts[0].meters[0][name].item()


def _count_of_midi(name: str) -> Callable[[StatusSources], int]:
    """Add up a count of what the parts were sent."""
    return lambda s: sum(int(part.player.instrument.midi[name]) for part in s.parts)


def _last_malformed(s: StatusSources) -> str:
    """The last damaged message of each part that has received one."""
    texts: dict[str, None] = {}
    for part in s.parts:
        midi = part.player.instrument.midi
        if midi["malformed"]:
            data, port = unpacked(int(midi["malformed_last"]))
            texts[f"{data.hex(' ')} {s.midi.name_of(port) if s.midi else ''}".strip()] = None
    return "; ".join(texts)


STATUS: tuple[AnyValue, ...] = (
    _text("device", "Device that plays, or silent clock.",
        lambda s: s.output.device or "silent clock"),
    _text("problem", "Why no device plays; empty where one does.", lambda s: s.output.problem),
    _gauge("rate", "Sample rate of the device.", lambda s: s.ensemble.rate, "Hz"),
    _gauge("blocksize", "Frames computed at a time, as set by --blocksize.", lambda s: s.blocksize),
    _gauge("period", "Largest number of frames that the device asks for at once.",
        lambda s: s.delay.period),
    _gauge("latency_ms", "Latency that the device reports; 0 where it knows none.",
        lambda s: s.output.latency_ms, "ms"),
    _gauge("delay_ms", "Delay from a message to its sound, without the device's latency.",
        lambda s: 1e3 * s.parts[0].player.delay / s.ensemble.rate, "ms"),
    _gauge("uptime_s", "Time since the start.", lambda s: s.uptime_s, "s"),
    _counter("frame", "Frames played since the start.", _meter("frame")),
    _gauge("peak_db", "Peak of the last sixtieth of a second, dBFS.",
        lambda s: decibels(s.ensemble.level[0]), "dB"),
    _gauge("rms_db", "Level of the last sixtieth of a second, dBFS.",
        lambda s: decibels(s.ensemble.level[1]), "dB"),
    _gauge("parts", "Number of parts.", lambda s: len(s.parts)),
    _of_first("note"),
    _of_first("bow_speed"),
    _of_first("bow_side"),
    _gauge("load", "CPU time of the callback divided by its deadline, mean of a second.",
        _meter("load")),
    _gauge("worst_load", "The same, largest since the start.", _meter("worst_load")),
    _counter("missed_deadlines", "Callbacks that took more CPU time than their deadline.",
        _meter("missed")),
    _counter("late_callbacks", "Requests of the device that came two periods late or more.",
        _meter("late_callbacks")),
    _counter("underruns", "Under-runs that the device reported.", _meter("underruns")),
    _counter("device_losses", "Number of times the device disappeared.", lambda s: s.output.losses),
    _of_all("applied_events"),
    _of_all("late_events"),
    _of_all("dropped_events"),
    _of_all("waiting_events"),
    _of_all("unconverged_solves"),
    _of_all("lost_states"),
    _counter("osc_packets", "OSC packets received.", lambda s: s.osc.packets),
    _counter("osc_messages", "OSC messages received.", lambda s: s.messages.messages),
    _counter("osc_malformed", "Packets that are not OSC.", lambda s: s.messages.malformed),
    _counter("osc_errors", "Messages that could not be carried out.", lambda s: s.messages.errors),
    _counter("osc_refused", "Packets of senders that are not allowed, and refused connections.",
        lambda s: s.osc.refused),
    _counter("osc_dropped", "Packets dropped by the system, as its buffer was full.",
        lambda s: s.osc.kernel_drops),
    _counter("osc_excess",
        "Packets dropped that were too long, or whose sender had too many waiting.",
        lambda s: s.osc.excess),
    _counter("osc_unsent", "Answers dropped because they were too many, or not read.",
        lambda s: s.osc.unsent),
    _counter("osc_failures",
        "Messages that met a defect of the server; please report it, with the log.",
        lambda s: s.osc.failures),
    _gauge("osc_buffer_bytes", "Size of the system's buffer for packets.",
        lambda s: s.osc.buffer_bytes, "bytes"),
    _gauge("osc_connections", "Number of TCP connections for OSC.", lambda s: s.osc.connections),
    _gauge("osc_subscribers", "Number of subscribers.", lambda s: s.subscribers),
    _gauge("scheduled", "Messages that wait for their time tag.", lambda s: s.scheduled),
    _counter("late_bundles", "Bundles that came after their time tag.",
        lambda s: s.messages.late_bundles),
    _text("midi_ports", "Names of connected MIDI inputs.",
        lambda s: "; ".join(s.midi.connected) if s.midi else ""),
    _gauge("midi_connected", "Number of connected MIDI inputs.",
        lambda s: len(s.midi.connected) if s.midi else 0),
    _counter("midi_messages", "MIDI messages that parts received.", _count_of_midi("messages")),
    _counter("midi_late", "MIDI messages that came after their frame.",
        lambda s: sum(part.player.instrument.late_midi for part in s.parts)),
    _counter("midi_malformed", "Damaged MIDI messages that parts received.",
        _count_of_midi("malformed")),
    _text("midi_malformed_last", "The last of them, in hexadecimal, and the input that gave it.",
        _last_malformed),
    _counter("http_requests", "HTTP requests received, with those for WebSockets.",
        lambda s: s.web.requests),
    _counter("http_refused", "Requests refused because they were not allowed, or too many.",
        lambda s: s.web.refused),
    _counter("http_failures", "Requests that met a defect of the server.",
        lambda s: s.web.failures),
    _counter("http_unsent", "Messages dropped because a WebSocket read too slowly.",
        lambda s: s.web.unsent),
    _gauge("web_sockets", "Number of open WebSockets.", lambda s: s.web.web_sockets),
    _text("recording", "Names of the files being recorded.", lambda s: s.recording),
)  # fmt: skip


def read_status(rows: Iterable[StatusValue[S, V]], sources: S) -> dict[str, V]:
    """The status values of a table, by name, in its order."""
    return {row.name: row.read(sources) for row in rows}


def as_argument(value: float | str) -> float | str:
    """A status value for OSC, where Pure Data and Max read no ints of 64 bits: those as floats."""
    return float(value) if isinstance(value, int) and abs(value) > INT_MAX else value
