"""Time tags: scheduled messages, and the frames of their times."""

import itertools
import random
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wire import FakePeer

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.schedule import AHEAD_S, Schedule, TagClock
from yehu_server.system import clocks

RATE = 48000
MS = RATE // 1000
ME, OTHER = FakePeer(1), FakePeer(2)


# ---------------------------------------------------------------- waiting


def due(waiting: Schedule) -> list[tuple[float, bytes]]:
    """All that is due now."""
    return [(due_s, packet) for due_s, packet, _ in iter(waiting.due, None)]


@given(st.lists(st.floats(0.0, 100.0)))
def test_messages_are_handed_out_once_in_order_of_their_times(moments):
    waiting = Schedule()
    for number, moment in enumerate(moments):
        assert waiting.add(moment, b"%4d" % number, ME)
    assert len(waiting) == len(moments)
    in_order = sorted((moment, b"%4d" % number) for number, moment in enumerate(moments))
    assert due(waiting) == in_order
    assert not waiting


def test_there_is_room_for_so_much_half_of_it_for_one_and_again_when_it_is_gone():
    size = 4096
    waiting, message = Schedule(most_bytes=8 * size), bytes(size - limits.OVERHEAD)
    said = [waiting.add(0.0, message, peer) for peer in (ME, OTHER) for _ in range(5)]
    assert said == [True] * 4 + [False] + [True] * 2 + [False] * 3
    waiting.due()
    waiting.due()
    assert waiting.add(0.0, message, OTHER)
    waiting.drop_part("")
    assert waiting.add(0.0, b"last", ME)
    assert due(waiting) == [(0.0, b"last")]


# ---------------------------------------------------------------- frames of moments


class Device:
    """A device that runs at some pace; stands in for a player with an instrument."""

    def __init__(self, clock, pace: float = 1.0) -> None:
        self.pace = pace
        self.stray = 0.0  # s; the error of the estimated time
        self._began = clock.now
        self.instrument = SimpleNamespace(rate=RATE, frame_at=self.frame_at)

    def frame_at(self, time_ns: int) -> float:
        return 1234.5 + (1e-9 * time_ns - self._began + self.stray) * RATE * self.pace


def true_frame(device: Device, clock, due_s: float) -> float:
    return device.frame_at(round(1e9 * (due_s - clock.since_1970)))


@pytest.mark.parametrize("pace", [1.0, 1.0 + 1e-5, 1.0 - 1e-5])
def test_distances_are_exact_to_the_frame(still_time, pace):
    device = Device(still_time, pace)
    tags = TagClock(device)
    chance = random.Random(1)
    first = still_time.time() + 0.5
    places = sorted(chance.randrange(0, 20 * RATE) for _ in range(2000))
    frames = []
    for place in places:
        due_s = first + place / RATE
        still_time.now = due_s - still_time.since_1970 - chance.uniform(0.0, AHEAD_S)
        frames.append(tags.frame_at(due_s))
    assert [frame - frames[0] for frame in frames] == [place - places[0] for place in places]


@pytest.mark.parametrize("pace", [1.0, 1.0 + 2e-4, 1.0 - 2e-4])
def test_times_stay_within_a_millisecond_and_a_bit_for_minutes(still_time, pace):
    device = Device(still_time, pace)
    tags = TagClock(device)
    first = still_time.time() + 0.5
    frames = []
    for number in range(1200):
        due_s = first + 0.1 * number
        still_time.now = due_s - still_time.since_1970 - 0.005
        frames.append(tags.frame_at(due_s))
        assert abs(frames[-1] - true_frame(device, still_time, due_s)) <= 1.01 * MS
    steps = [after - before for before, after in itertools.pairwise(frames)]
    drift_ms = 120.0 * abs(pace - 1.0) * 1e3
    assert sum(step != RATE // 10 for step in steps) <= drift_ms + 1.0  # one for each ms of drift


@pytest.mark.parametrize("step_s", [-3600.0, -0.01, 0.01, 3600.0])
def test_a_step_of_the_worlds_clock_is_followed(still_time, step_s):
    device = Device(still_time)
    tags = TagClock(device)
    tags.frame_at(still_time.time() + 0.005)
    still_time.since_1970 += step_s
    due_s = still_time.time() + 0.005
    assert abs(tags.frame_at(due_s) - true_frame(device, still_time, due_s)) <= 1.0


def test_being_held_up_while_reading_the_clocks_moves_nothing(still_time, monkeypatch):
    device = Device(still_time)
    tags = TagClock(device)
    held_up = iter([0.0, 0.0, 0.004, 0.0, 0.0])  # s, after the first clock is read

    def read() -> float:
        now = type(still_time).time(still_time)
        still_time.now += next(held_up, 0.0)
        return now

    monkeypatch.setattr(clocks, "now_s", read)
    first = type(still_time).time(still_time) + 0.5
    frames = []
    for number in range(5):
        due_s = first + 0.02 * number
        still_time.now = due_s - still_time.since_1970 - 0.008
        frames.append(tags.frame_at(due_s))
    assert [frame - frames[0] for frame in frames] == [960 * number for number in range(5)]
