"""Events in columns: the same as objects, and few steps for a message of a dense file."""

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import mido
import numpy as np
import pytest
from midi_bytes import END, midi, off, on

from yehu_server.scores.events import Events, ScoreEvent, Setting
from yehu_server.scores.reading import ReadOptions, read_any

DATA = [(0x83, 5, 127), (0x93, 5, 127), (0xA3, 5, 127), (0xB3, 5, 127), (0xC3, 5), (0xD3, 5)]
MESSAGES = [
    *map(mido.Message.from_bytes, DATA),
    mido.Message("pitchwheel", pitch=-8192),
    mido.Message("pitchwheel", pitch=8191, channel=15),
    mido.Message("reset"),
    Setting("/playing/bend", None, 2),
]


def test_messages_of_any_kind_come_back_from_columns():
    rows = [ScoreEvent(0.1 * at, message, 0.5 * at, at) for at, message in enumerate(MESSAGES)]
    events = Events.of(rows)
    assert [*events] == rows
    order = np.arange(len(rows))[::-1]
    assert [*events.where(order)] == rows[::-1]
    assert events.where(order) != events
    assert events.channel.tolist() == [3] * 6 + [0, 15, -1, 2]


def test_more_events_come_before_those_at_their_places():
    first, second, third = (ScoreEvent(at, Setting(f"/{at}", at), at) for at in (1.0, 2.0, 3.0))
    key = ScoreEvent(2.0, mido.Message("note_on", note=60), 2.0)
    events = Events.of([first, key])
    assert [*events.with_before([(2, third), (1, second), (1, key)])] == [
        first, second, key, key, third
    ]  # fmt: skip
    assert [*events.with_before([])] == [first, key]


def test_a_key_struck_again_ends_its_note():
    struck = [(0x90, 60, 9), (0x90, 62, 9), (0x90, 60, 9), (0x90, 62, 0), (0x91, 60, 9)]
    messages = map(mido.Message.from_bytes, struck)
    events = Events.of(ScoreEvent(at, message) for at, message in enumerate(messages))
    assert [each.tolist() for each in events.struck_and_ends] == [[0, 1, 2, 4], [2, 3, -1, -1]]


def notes(count: int, delta: int = 0) -> bytes:
    return b"".join(on(delta, 60 + at % 30) + off(delta, 60 + at % 30) for at in range(count))


def tunings(count: int) -> bytes:
    tuned = (b"\0\xf0\7\x7f\x7f\4\4\0" + bytes([at % 99]) + b"\xf7" for at in range(count))
    return b"".join(tuned) + notes(count)


# Files of so many of something, and the most calls that reading takes for each.
DENSE: dict[str, tuple[Callable[[int], bytes], int]] = {
    "notes": (lambda count: midi(notes(count) + END), 12),
    "notes at moments of their own": (lambda count: midi(notes(count, 9) + END), 12),
    "hanging notes": (lambda count: midi(notes(count).replace(b"\x80", b"\x81") + END), 12),
    "notes of two parts": (lambda count: midi(notes(count) + END, notes(count) + END), 24),
    "controllers": (lambda count: midi(on(0, 60) + b"\1\xb0\1\1\1\xb0\7\2" * count + END), 12),
    "notes far too low": (lambda count: midi((on(0, 9) + off(1, 9)) * count + END), 12),
    "tunings": (lambda count: midi(tunings(count) + END), 50),
    "tracks": (lambda count: midi(*[notes(1) + END] * count), 160),
    "songs": (lambda count: midi(*[notes(1) + END] * count, kind=2), 200),
}


def calls(function: Callable[[], object]) -> int:
    """How many functions a function calls, of Python and of C."""
    count = 0

    def call(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(call)
    try:
        function()
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.parametrize("kind", DENSE)
def test_a_message_of_a_dense_file_takes_few_calls(tmp_path: Path, kind):
    make, most = DENSE[kind]
    found = []
    for count in (9, 400, 900):  # the first loads modules
        path = tmp_path / f"{count}.mid"
        path.write_bytes(make(count))
        options = ReadOptions(all_parts=True, leaves_low_keys=True)
        found.append(calls(partial(read_any, path, options)))
    assert found[2] - found[1] < 500 * most


def test_events_are_objects_only_when_asked_for(tmp_path):
    path = tmp_path / "tune.mid"
    path.write_bytes(midi(notes(9, 100) + END))
    score = read_any(path)
    assert "rows" not in vars(score.events)
    assert len(score.events) == len([*score.events]) == 18
