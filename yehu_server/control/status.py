"""The status values, as OSC, OSCQuery, the metrics and docs/osc.md know them.

What each is at the moment is in ``Server.status``.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

PLACE = "/status/"  # before the names, in addresses
INT_MAX = (1 << 31) - 1


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
    unit: str = "1"


TEXT, GAUGE, COUNTER = Kind.TEXT, Kind.GAUGE, Kind.COUNTER

STATUS: tuple[StatusValue, ...] = (
    StatusValue("device", TEXT, "What plays."),
    StatusValue("problem", TEXT, "Why no device does."),
    StatusValue("rate", GAUGE, "Sample rate of the device.", "Hz"),
    StatusValue("blocksize", GAUGE, "Frames asked for at a time, as --blocksize has it."),
    StatusValue("period", GAUGE, "Frames the device really asks for at once, at most."),
    StatusValue("latency_ms", GAUGE, "Latency of the device, as it says.", "ms"),
    StatusValue("delay_ms", GAUGE, "From a message to its sound, before the device.", "ms"),
    StatusValue("uptime_s", GAUGE, "Time since the start.", "s"),
    StatusValue("frame", COUNTER, "Frames played since the start."),
    StatusValue("peak_db", GAUGE, "Peak of the last sixtieth of a second, dBFS.", "dB"),
    StatusValue("rms_db", GAUGE, "Level of the last sixtieth of a second, dBFS.", "dB"),
    StatusValue(
        "note",
        GAUGE,
        "The pitch that sounds, of a note or drawn by hand; -1 where none does.",
        "MIDI note",
    ),
    StatusValue("bow_speed", GAUGE, "Speed of the bow; the sign is its direction.", "m/s"),
    StatusValue("bow_side", GAUGE, "Which string the bow lies on; 0 lifted."),
    StatusValue("load", GAUGE, "CPU time of the callback over its deadline, mean of a second."),
    StatusValue("worst_load", GAUGE, "The same, worst since the start."),
    StatusValue("missed_deadlines", COUNTER, "Callbacks that took more CPU time than they have."),
    StatusValue("late_callbacks", COUNTER, "Requests of the device two periods late or more."),
    StatusValue("underruns", COUNTER, "Under-runs, as the device reports them."),
    StatusValue("device_losses", COUNTER, "How often the device went away."),
    StatusValue("applied_events", COUNTER, "Moves of bow and finger that reached the model."),
    StatusValue("late_events", COUNTER, "Moves that came after their frame."),
    StatusValue("dropped_events", COUNTER, "Moves that found the ring full."),
    StatusValue("waiting_events", GAUGE, "Moves that wait for their frame."),
    StatusValue("unconverged_solves", COUNTER, "Friction solves that did not converge."),
    StatusValue("lost_states", COUNTER, "How often the model was put back to rest."),
    StatusValue("osc_packets", COUNTER, "OSC packets that came in."),
    StatusValue("osc_messages", COUNTER, "OSC messages that came in."),
    StatusValue("osc_malformed", COUNTER, "Packets that are no OSC."),
    StatusValue("osc_errors", COUNTER, "Messages that could not be done."),
    StatusValue(
        "osc_refused", COUNTER, "Packets of senders who are not allowed, and connections refused."
    ),
    StatusValue("osc_dropped", COUNTER, "Packets the system lost for want of room."),
    StatusValue("osc_excess", COUNTER, "Packets dropped since their sender has too many waiting."),
    StatusValue("osc_unsent", COUNTER, "Answers dropped: too many, or nobody takes them."),
    StatusValue(
        "osc_failures",
        COUNTER,
        "Messages that met a defect of the server: please report it, with the log.",
    ),
    StatusValue("osc_buffer_bytes", GAUGE, "Room for packets that the system grants.", "bytes"),
    StatusValue("osc_connections", GAUGE, "TCP connections for OSC."),
    StatusValue("osc_subscribers", GAUGE, "Who is told of every change."),
    StatusValue("scheduled", GAUGE, "Messages that wait for their time."),
    StatusValue("late_bundles", COUNTER, "Bundles that came after their time."),
    StatusValue("midi_ports", TEXT, "The MIDI inputs that are connected."),
    StatusValue("midi_connected", GAUGE, "Number of connected MIDI inputs."),
    StatusValue("midi_messages", COUNTER, "MIDI messages that came in."),
    StatusValue("midi_malformed", COUNTER, "Damaged MIDI messages."),
    StatusValue("http_requests", COUNTER, "HTTP requests that came in, and WebSockets."),
    StatusValue("http_refused", COUNTER, "Requests that are not allowed, or are too many."),
    StatusValue("http_failures", COUNTER, "Requests that met a defect of the server."),
    StatusValue("http_unsent", COUNTER, "What WebSockets missed because they read too slowly."),
    StatusValue("web_sockets", GAUGE, "WebSockets that are open."),
    StatusValue("recording", TEXT, "The file being written."),
)


STATUS_ADDRESSES = frozenset(PLACE + value.name for value in STATUS)


def as_argument(value: float | str) -> float | str:
    """A status value as OSC carries it: Pure Data and Max read no ints of 64 bits."""
    return float(value) if isinstance(value, int) and abs(value) > INT_MAX else value
