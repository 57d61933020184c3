"""Events to the instrument: rings between threads and processes, the heap in sample time."""

from __future__ import annotations

import mmap
import os
import random
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from functools import partial
from itertools import combinations, product

import numba
import numpy as np
import pytest
import sound
from hypothesis import given, settings
from hypothesis import strategies as st

from yehu_server.engine import native
from yehu_server.engine.controls import SILENCE
from yehu_server.engine.instrument import RIG_BYTES, Instrument
from yehu_server.engine.mailbox import APPLIED_AT_ONCE, HEAP, LINE, LIVE_BUDGET, RING
from yehu_server.params.table import ENGINE, SLOT

RATE = 22050
PATIENCE_S = 120.0  # for other threads and processes; they took 20 s on a busy machine
# Parameters that are not heard while no bow is on the strings.
INERT = [SLOT["/bow/force"], SLOT["/bow/pressure"]]
run = partial(sound.run, block=4096)
FAR = 10**9  # a frame that never comes

needs_memfd = pytest.mark.skipif(not hasattr(os, "memfd_create"), reason="no memfd_create here")


def values(instrument: Instrument) -> tuple[float, ...]:
    """The values of the inert parameters."""
    return tuple(float(value) for value in instrument._rig["controls"]["value"][0, INERT])


def post_numbered(instrument: Instrument, number: int, frame: int = 0) -> bool:
    """Post an event that carries its number in each of its parts."""
    return instrument.post(frame, INERT[number % 2], float(number), -number)


def numbers(events: np.ndarray) -> np.ndarray:
    """The numbers of events posted by `post_numbered`; all parts of each must agree."""
    found = -events["ramp"]
    np.testing.assert_array_equal(events["target"], found)
    np.testing.assert_array_equal(events["index"], np.array(INERT)[found % 2])
    return found


def live(rate: float = RATE) -> Instrument:
    """An instrument in given memory."""
    return Instrument(rate, memory=mmap.mmap(-1, RIG_BYTES))


# ---------------------------------------------------------------- the ring between threads

_post = numba.njit(native.post._function)
EVEN, ODD = INERT


@numba.cfunc("int64(voidptr, int64, int64)")
def storm(rig, start, count):
    """Post numbered events as fast as possible, each until it is taken; return the refusals."""
    refused = 0
    for number in range(start, start + count):
        index = ODD if number % 2 else EVEN
        while _post(rig, 0, index, float(number), -number) == 0:
            refused += 1
    return refused


def post_by_storm(instrument: Instrument, count: int) -> int:
    return sum(storm.ctypes(instrument.address, start, 1000) for start in range(0, count, 1000))


def post_by_python(instrument: Instrument, count: int) -> int:
    refused = 0
    for number in range(count):
        while not post_numbered(instrument, number):
            refused += 1
    return refused


def thread(work: Callable[[], object]) -> threading.Thread:
    return threading.Thread(target=work, daemon=True)  # a test that fails may not hang


class Aside:
    """A thread that repeats some work within the block."""

    def __init__(self, work: Callable[[], object]) -> None:
        self._work, self._stop = work, threading.Event()
        self._thread = thread(self._run)

    def _run(self) -> None:
        while not self._stop.is_set():
            self._work()

    def __enter__(self) -> None:
        self._thread.start()

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()


def collect(
    instrument: Instrument, count: int, meanwhile: Callable[[], object] = bool
) -> np.ndarray:
    """Read reports until there are `count` of them."""
    reports, read = [], 0
    deadline = time.monotonic() + PATIENCE_S
    while read < count and time.monotonic() < deadline:
        meanwhile()
        reports.append(instrument.applied_events().copy())  # without the room for more
        read += len(reports[-1])
    return np.concatenate(reports)


@pytest.mark.parametrize("make", [lambda: Instrument(RATE), live], ids=["offline", "live"])
@pytest.mark.parametrize(("post", "count"), [(post_by_storm, 300_000), (post_by_python, 80_000)])
def test_events_come_whole_and_in_order_from_thread_to_thread(make, post, count):
    instrument = make()
    instrument.report_events()
    out = np.zeros(64, np.float32)
    mail = instrument._rig["mail"]
    refused = []

    def play() -> None:
        unread = mail["reported"][0, 0] - mail["read"][0, 0]
        if unread <= RING - len(out) * APPLIED_AT_ONCE:  # or reports would be dropped
            instrument.process(out)

    poster = thread(lambda: refused.append(post(instrument, count)))
    with Aside(play):
        poster.start()
        events = collect(instrument, count)
        poster.join(PATIENCE_S)
    run(instrument, 64)
    assert not len(instrument.applied_events())
    np.testing.assert_array_equal(numbers(events), np.arange(count))
    assert (np.diff(events["frame"]) >= 0).all()
    assert instrument.dropped_events == refused[0]
    meters = instrument.meters()
    assert (meters["applied"], meters["waiting"], meters["unreported"]) == (count, 0, 0)


# ---------------------------------------------------------------- and between processes

PLAYER = """
import mmap, sys, threading
import numpy as np
from yehu_server.engine import native
rig = np.frombuffer(mmap.mmap(int(sys.argv[1]), 0), np.uint8)
out = np.zeros(64, np.float32)
over = threading.Event()
threading.Thread(target=lambda: (sys.stdin.read(), over.set())).start()
while not over.is_set():
    native.callback.call(None, out.ctypes.data, len(out), None, 0, rig.ctypes.data)
"""
POSTER = """
import mmap, sys
import numpy as np
from yehu_server.engine import native
rig = np.frombuffer(mmap.mmap(int(sys.argv[1]), 0), np.uint8)
count, even, odd = map(int, sys.argv[2:])
for number in range(count):
    while not native.post.call(
        rig.ctypes.data, 0, odd if number % 2 else even, float(number), -number
    ):
        pass
"""


class Shared:
    """An instrument in memory that another process shares, which runs some Python."""

    def __init__(self, code: str, *arguments: int) -> None:
        descriptor = os.memfd_create("rig")
        os.ftruncate(descriptor, RIG_BYTES)
        self.instrument = Instrument(RATE, memory=mmap.mmap(descriptor, RIG_BYTES))
        self.instrument.report_events()
        self._process = subprocess.Popen(
            [sys.executable, "-c", code, str(descriptor), *map(str, arguments)],
            pass_fds=[descriptor],
            stdin=subprocess.PIPE,
        )
        os.close(descriptor)

    def __enter__(self) -> Instrument:
        return self.instrument

    def __exit__(self, *_: object) -> None:
        try:
            self._process.communicate(timeout=PATIENCE_S)  # its input ends here
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.communicate()
            raise
        assert self._process.returncode == 0


@needs_memfd
def test_events_come_whole_and_in_order_to_another_process_and_its_reports_back():
    count = 80_000
    with Shared(PLAYER) as instrument:
        posted = 0

        def post_some() -> None:
            nonlocal posted
            for _ in range(min(500, count - posted)):
                posted += post_numbered(instrument, posted)

        events = collect(instrument, count, post_some)
    assert not len(instrument.applied_events())
    np.testing.assert_array_equal(numbers(events), np.arange(count))
    assert (np.diff(events["frame"]) >= 0).all()
    meters = instrument.meters()
    assert meters["applied"] == count
    assert meters["frame"] + meters["block"] == instrument.frame == 64 * meters["callbacks"]


@needs_memfd
def test_events_come_whole_and_in_order_from_another_process():
    count = 80_000
    with Shared(POSTER, count, *INERT) as instrument:
        out = np.zeros(64, np.float32)
        events = collect(instrument, count, lambda: instrument.process(out))
    run(instrument, 64)
    assert not len(instrument.applied_events())
    np.testing.assert_array_equal(numbers(events), np.arange(count))


# ---------------------------------------------------------------- full rings


@pytest.mark.parametrize("make", [lambda: Instrument(RATE), live], ids=["offline", "live"])
def test_a_full_ring_drops_and_counts_what_comes_and_keeps_what_it_has(make):
    instrument = make()
    instrument.report_events()
    for number in range(RING):
        assert post_numbered(instrument, number)
    for number in range(RING, RING + 10):
        assert not post_numbered(instrument, number)
    assert instrument.dropped_events == 10
    run(instrument, 2 * RING // (LIVE_BUDGET // 64) + 1000)
    np.testing.assert_array_equal(numbers(instrument.applied_events()), np.arange(RING))
    # And afterwards it is as before.
    for number in range(RING):
        assert post_numbered(instrument, number)
    assert not post_numbered(instrument, RING)
    assert instrument.dropped_events == 11
    run(instrument, 2 * RING // (LIVE_BUDGET // 64) + 1000)
    np.testing.assert_array_equal(numbers(instrument.applied_events()), np.arange(RING))


def test_a_ring_that_is_drained_a_little_has_room_for_as_much():
    instrument = live()
    for number in range(RING):
        post_numbered(instrument, number, FAR)
    run(instrument, 1)
    room = sum(post_numbered(instrument, number, FAR) for number in range(2 * LIVE_BUDGET))
    assert room == LIVE_BUDGET
    assert instrument.dropped_events == LIVE_BUDGET


def test_reports_nobody_reads_are_dropped_and_counted_and_the_older_kept():
    instrument = Instrument(RATE)
    instrument.report_events()
    for number in range(RING):
        post_numbered(instrument, number)
    run(instrument, 4096)
    for number in range(RING, RING + 100):
        post_numbered(instrument, number)
    run(instrument, 4096)
    assert instrument.meters()["applied"] == RING + 100
    assert instrument.meters()["unreported"] == 100
    np.testing.assert_array_equal(numbers(instrument.applied_events()), np.arange(RING))
    post_numbered(instrument, 7)
    run(instrument, 64)
    np.testing.assert_array_equal(numbers(instrument.applied_events()), [7])
    assert instrument.meters()["unreported"] == 100


def test_nothing_is_reported_unless_it_is_asked_for():
    instrument = Instrument(RATE)
    post_numbered(instrument, 1)
    run(instrument, 64)
    assert not len(instrument.applied_events())
    assert instrument.meters()["unreported"] == 0


def test_cursors_are_words_of_their_own_in_cache_lines_of_their_own():
    posted, read = native.POSTED_AT, native.READ_AT
    drained, reported = native.DRAINED_AT, native.REPORTED_AT
    for at in (posted, read, drained, reported, native.VERSION_AT, native.TAPED_AT):
        assert at % 8 == 0  # an atomic word may not lie across two
    for one, other in combinations([(posted,), (read,), (drained, reported)], 2):
        for mine, its in product(one, other):
            assert abs(mine - its) >= 8 * LINE


# ---------------------------------------------------------------- the heap: a plain model


def target(index: int, order: int) -> float:
    """A value within the parameter's range that no other event has."""
    param = ENGINE[index]
    return param.lo + (param.hi - param.lo) * order / (1 << 16)


class Model:
    """The mailbox in plain Python: a list that is sorted at each frame."""

    def __init__(self) -> None:
        self.frame, self.late, self.order = 0, 0, 0
        self.waiting: list[tuple[int, int, int]] = []  # frame, order, index
        self.applied: list[tuple[int, int, float]] = []  # frame, index, target
        self.values: list[tuple[float, ...]] = []  # after each frame

    def post(self, frame: int, index: int) -> float:
        """Post an event; return its target, which no other event has."""
        self.order += 1
        self.late += frame < self.frame
        self.waiting.append((frame, self.order, index))
        return target(index, self.order)

    def play(self, frames: int, start: tuple[float, ...]) -> None:
        now = dict(zip(INERT, self.values[-1] if self.values else start, strict=True))
        for _ in range(frames):
            due = [event for event in sorted(self.waiting) if event[0] <= self.frame]
            for event in due[:APPLIED_AT_ONCE]:
                self.waiting.remove(event)
                _, order, index = event
                self.applied.append((self.frame, index, target(index, order)))
                now[index] = target(index, order)
            self.values.append(tuple(now.values()))
            self.frame += 1


def reported(instrument: Instrument) -> list[tuple[int, int, float]]:
    events = instrument.applied_events()
    assert not events["ramp"].any()
    return [(int(event["frame"]), int(event["index"]), event["target"]) for event in events]


def postings(frames: int, most: int) -> st.SearchStrategy:
    event = st.tuples(st.integers(-2, frames), st.sampled_from(INERT))
    # What is posted before a block, and how long that block is.
    return st.lists(st.tuples(st.lists(event, max_size=most), st.integers(1, frames)), max_size=6)


@settings(max_examples=40)
@given(st.one_of(postings(100, 30), postings(5, 60), postings(2, 120)))
def test_events_apply_by_frame_and_then_as_posted_whatever_the_order_of_posting(batches):
    instrument, model = Instrument(RATE), Model()
    instrument.report_events()
    start = values(instrument)
    seen = []
    for events, frames in [*batches, ([], 130)]:
        for frame, index in events:
            assert instrument.post(frame, index, model.post(frame, index), 0)
        model.play(frames, start)
        for _ in range(frames):
            run(instrument, 1)
            seen.append(values(instrument))
    assert reported(instrument) == model.applied
    assert seen == model.values
    meters = instrument.meters()
    assert meters["late_events"] == model.late
    assert meters["applied"] == len(model.applied)
    assert meters["waiting"] == len(model.waiting)


@settings(max_examples=30)
@given(postings(300, 60), st.sampled_from([64, 100, 333, 4096]))
def test_within_longer_blocks_they_apply_on_the_same_frames(batches, block):
    instrument, model = Instrument(RATE), Model()
    instrument.report_events()
    for events, frames in [*batches, ([], 600)]:
        for frame, index in events:
            instrument.post(frame, index, model.post(frame, index), 0)
        model.play(frames, values(instrument))
        run(instrument, frames, block=block)
    assert reported(instrument) == model.applied
    assert instrument.meters()["late_events"] == model.late


@pytest.mark.parametrize("seed", range(5))
def test_thousands_in_any_order_come_out_sorted(seed):
    chance = random.Random(seed)
    instrument = Instrument(RATE)
    instrument.report_events()
    frames = [chance.randrange(2000) for _ in range(HEAP)]
    for number, frame in enumerate(frames):
        post_numbered(instrument, number, frame)
    run(instrument, 2100)
    events = instrument.applied_events()
    expected = sorted(range(len(frames)), key=lambda number: (frames[number], number))
    np.testing.assert_array_equal(numbers(events), expected)
    np.testing.assert_array_equal(events["frame"], sorted(frames))  # none has 32 on a frame


# ---------------------------------------------------------------- the heap: single promises


def test_events_for_frames_that_have_passed_apply_at_once_and_are_counted():
    instrument = Instrument(RATE)
    instrument.report_events()
    run(instrument, 1000)
    for number, frame in enumerate([999, 0, -5, 1000, 1001]):
        post_numbered(instrument, number, frame)
    run(instrument, 100)
    events = instrument.applied_events()
    assert numbers(events).tolist() == [2, 1, 0, 3, 4]
    assert events["frame"].tolist() == [1000, 1000, 1000, 1000, 1001]
    assert instrument.meters()["late_events"] == 3


def test_at_most_so_many_events_apply_on_one_frame_and_the_rest_on_the_next():
    instrument = Instrument(RATE)
    instrument.report_events()
    for number in range(3 * APPLIED_AT_ONCE + 4):
        post_numbered(instrument, number, 50)
    for number in range(3 * APPLIED_AT_ONCE + 4, 3 * APPLIED_AT_ONCE + 10):
        post_numbered(instrument, number, 51)
    run(instrument, 100)
    events = instrument.applied_events()
    np.testing.assert_array_equal(numbers(events), np.arange(3 * APPLIED_AT_ONCE + 10))
    frames, counts = np.unique(events["frame"], return_counts=True)
    assert frames.tolist() == [50, 51, 52, 53]
    assert counts.tolist() == [APPLIED_AT_ONCE] * 3 + [10]
    assert instrument.meters()["late_events"] == 0  # they were posted in time


def test_more_than_wait_at_once_in_the_order_of_frames_apply_on_their_frames():
    instrument = Instrument(RATE)
    instrument.report_events()
    count = HEAP + HEAP // 2
    for number in range(count):
        post_numbered(instrument, number, 100 + number // 10)
    run(instrument, 100 + count)
    events = instrument.applied_events()
    np.testing.assert_array_equal(numbers(events), np.arange(count))
    np.testing.assert_array_equal(events["frame"], 100 + np.arange(count) // 10)
    assert instrument.meters()["late_events"] == 0


def test_a_live_instrument_takes_in_so_many_events_for_each_64_frames():
    instrument = live()
    for number in range(3 * LIVE_BUDGET - 1):
        post_numbered(instrument, number, FAR)
    for waiting in (LIVE_BUDGET, 2 * LIVE_BUDGET, 3 * LIVE_BUDGET - 1, 3 * LIVE_BUDGET - 1):
        run(instrument, 64)
        assert instrument.meters()["waiting"] == waiting


@pytest.mark.parametrize("index", [-1, -2, SILENCE + 1, SILENCE + 5])
def test_an_event_for_no_parameter_changes_nothing(index):
    instrument = Instrument(RATE)
    run(instrument, 64)
    before = instrument._rig["controls"].copy()
    instrument.post(0, index, 0.125, 0)
    run(instrument, 64)
    after = instrument._rig["controls"].copy()
    for name in ("value", "target", "slope", "remaining", "silence_in", "sounding_from"):
        np.testing.assert_array_equal(after[name], before[name])


def test_a_reset_leaves_nothing_to_apply():
    instrument = Instrument(RATE)
    instrument.report_events()
    post_numbered(instrument, 1, 200)
    run(instrument, 100)
    post_numbered(instrument, 2, 0)
    instrument.reset()
    run(instrument, 300)
    assert not len(instrument.applied_events())
    assert instrument.meters()["waiting"] == 0


def test_a_reset_leaves_nothing_to_tell_of():
    instrument = Instrument(RATE)
    instrument.report_events()
    run(instrument, 100)
    post_numbered(instrument, 1, 0)
    run(instrument, 100)
    instrument.reset()
    run(instrument, 100)
    assert not len(instrument.applied_events())
    assert instrument.meters()["applied"] == 0
    assert instrument.meters()["late_events"] == 0


# ---------------------------------------------------------------- blocks


def crowded(block: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sound, reports and last parameters of a crowded half second."""
    chance = random.Random(3)
    instrument = Instrument(RATE)
    instrument.report_events()
    instrument.write("/bow/side", 1.0)
    instrument.write("/bow/speed", 0.2)
    speed, side, level = SLOT["/bow/speed"], SLOT["/bow/side"], SLOT["/output/level"]
    for _ in range(40):
        frame = chance.randrange(RATE // 2)
        for _ in range(chance.choice([1, 5, 30, 250])):
            index, low = chance.choice([(speed, -0.4), (side, -1.0), (level, 0.0)])
            target, ramp = chance.uniform(low, -low or 1.0), chance.choice([0, 3, 64, 500])
            instrument.post(frame + chance.randrange(3), index, target, ramp)
    instrument.post(RATE // 4, SILENCE, 0.0, 0)
    instrument.write("/output/level", 1.0, frame=RATE // 4 + 400)
    out = run(instrument, RATE // 2, block=block)
    return out, instrument.applied_events(), instrument._rig["controls"]["value"].copy()


@pytest.fixture(scope="module")
def whole() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    out, events, _ = crowded(RATE)
    assert np.abs(out).max() > 0.01
    assert np.bincount(events["frame"]).max() == APPLIED_AT_ONCE  # it is crowded
    return crowded(RATE)


@pytest.mark.parametrize("block", [1, 64, 100, 333, 4096])
def test_a_crowd_of_events_sounds_the_same_in_blocks_of_any_size(whole, block):
    for part, expected in zip(crowded(block), whole, strict=True):
        np.testing.assert_array_equal(part, expected)


def test_even_more_than_can_wait_at_once_apply_the_same_in_blocks_of_any_size():
    def applied(block: int) -> np.ndarray:
        instrument = Instrument(RATE)
        instrument.report_events()
        for number in range(HEAP):
            post_numbered(instrument, number, 10 + number // 20)
        for number in range(500):
            post_numbered(instrument, number, 30 + 7 * number % 500)
        run(instrument, 3200, block=block)
        return instrument.applied_events()

    np.testing.assert_array_equal(applied(1), applied(64))
