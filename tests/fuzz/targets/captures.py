"""Captured sessions."""

from __future__ import annotations

import numpy as np
from fuzz.target import scratch, target, written

from yehu_server.engine.controls import SILENCE
from yehu_server.errors import YehuError
from yehu_server.params.table import ENGINE
from yehu_server.physics.grid import check_rate
from yehu_server.physics.quantities import Quantities, override
from yehu_server.score.capture import MOST_FRAMES, CaptureWriter, read_capture

WORDS = (
    b'{"end": ',
    b'{"rest": ',
    b', "since": ',
    b'{"lost": 1, "events": 1}',
    b"\n[0, ",
    b", 0]\n",
    b'"/bow/speed"',
    b'"/finger/1/position"',
    b'"silence"',
    b"1e308",
    b"NaN",
    b"Infinity",
)


@target("capture", YehuError, words=WORDS)
def capture(data: bytes) -> None:
    """A capture has a length, its events are in range, and it can be written again."""
    path = written(data, "file.jsonl")
    taken = read_capture(path)
    check_rate(taken.rate)  # replay begins with these two checks
    first, second = taken.tensions
    override(Quantities(), {"string_1": {"T": first}, "string_2": {"T": second}})
    assert 0 <= taken.frames <= MOST_FRAMES  # replay sets a bound of its own: --max-duration
    assert all(0 <= since <= rest <= MOST_FRAMES for rest, since in taken.rests.items())
    events = taken.events
    for frame, index, value, ramp in events.tolist():
        assert 0 <= frame <= taken.frames
        assert 0 <= ramp <= MOST_FRAMES
        if index != SILENCE:
            assert ENGINE[index].lo <= value <= ENGINE[index].hi
    again = scratch() / "again.jsonl"
    again.unlink(missing_ok=True)
    writer = CaptureWriter(again, rate=taken.rate, seed=0, tensions=taken.tensions)
    writer.events(events)
    for rest, since in taken.rests.items():
        writer.note("rest", rest, since=since)
    writer.close(taken.frames)
    read = read_capture(again)
    assert np.array_equal(read.events, events)
    assert (read.rate, read.tensions, read.rests) == (taken.rate, taken.tensions, taken.rests)
    assert read.end == taken.frames
