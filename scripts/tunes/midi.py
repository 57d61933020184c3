"""MIDI files of messages at absolute ticks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from mido import Message, MetaMessage, MidiFile, MidiTrack, bpm2tempo

QUARTER = 480  # ticks
Event = tuple[int, Message]  # tick and message


def control(number: int, value: int, channel: int = 0) -> Message:
    return Message("control_change", channel=channel, control=number, value=value)


def parameter(number: int, value: int, channel: int = 0) -> list[Event]:
    """Return messages that set a registered parameter (RPN) and then deselect it."""
    words = ((101, 0), (100, number), (6, value), (38, 0), (101, 127), (100, 127))
    return [(0, control(*word, channel)) for word in words]


def bend(cents: float, reach_cents: float, channel: int = 0) -> Message:
    """Return a pitch bend, where the wheel reaches so many cents up and down."""
    return Message("pitchwheel", channel=channel, pitch=round(cents / reach_cents * 8192))


def stroke(
    pitch: int, velocity: int, start: int, end: int, channel: int = 0
) -> tuple[Event, Event]:
    """Return the beginning and the end of a note."""
    on = Message("note_on", channel=channel, note=pitch, velocity=velocity)
    return (start, on), (end, Message("note_off", channel=channel, note=pitch, velocity=64))


def track(name: str, events: Iterable[tuple[int, Message | MetaMessage]]) -> MidiTrack:
    """Return a track of events that are in order."""
    written = MidiTrack([MetaMessage("track_name", name=name)])
    now = 0
    for tick, message in events:
        written.append(message.copy(time=tick - now))
        now = tick
    return written


def score(
    name: str,
    about: str,
    key: str,
    tempos: Iterable[tuple[int, float]],
    parts: Mapping[str, Iterable[Event]],
) -> MidiFile:
    """Return a MIDI file in 2/4 with a conductor track, and a track for each part.

    `tempos` are quarters a minute from ticks on. Events are in order.
    """
    conductor = [
        (0, MetaMessage("text", text=about)),
        (0, MetaMessage("time_signature", numerator=2, denominator=4)),
        (0, MetaMessage("key_signature", key=key)),
        *((tick, MetaMessage("set_tempo", tempo=bpm2tempo(bpm))) for tick, bpm in tempos),
    ]
    written = MidiFile(type=1, ticks_per_beat=QUARTER)
    written.tracks.append(track(name, conductor))
    written.tracks += [track(part, events) for part, events in parts.items()]
    return written
