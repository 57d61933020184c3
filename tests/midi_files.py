"""MIDI files for tests, from messages at their times in seconds."""

from collections.abc import Iterable
from pathlib import Path

import mido

Timed = tuple[float, mido.Message]


def notes(*events: tuple[float, float, int, int], channel: int = 1) -> list[Timed]:
    """Notes, each given as its start (s), length (s), note and velocity."""
    messages = []
    for start, length, note, velocity in events:
        of = {"channel": channel - 1, "note": note}
        messages.append((start, mido.Message("note_on", velocity=velocity, **of)))
        messages.append((start + length, mido.Message("note_off", **of)))
    return messages


def midi_file(path: Path, messages: Iterable[Timed]) -> Path:
    """Write messages to a file that lasts until the last one."""
    file = mido.MidiFile(ticks_per_beat=500)  # at 120 bpm, a tick is a millisecond
    track = file.add_track()
    now = 0
    for time, message in sorted(messages, key=lambda pair: pair[0]):
        track.append(message.copy(time=round(1000 * time) - now))
        now = round(1000 * time)
    file.save(path)
    return path
