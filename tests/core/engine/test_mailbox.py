"""Commands to the instrument: rings between threads and processes, the heap in sample time."""

import random
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, partial
from itertools import combinations, product

import numba
import numpy as np
import pytest
import sound
from hypothesis import given, settings
from hypothesis import strategies as st

from yehu_server.core.controls.slots import SILENCE
from yehu_server.core.engine import native
from yehu_server.core.engine import rig as memory
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import (
    APPLIED_AT_ONCE,
    BUDGET_PER_FRAME,
    HEAP,
    LINE,
    LIVE_INTAKE,
    MIDI_INPUTS,
    PAGES,
    QUEUE_STARTS,
    RING,
    SERVER,
    SMALL_RING,
    SOUND_INPUT,
)
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.events import TABLES_TO
from yehu_server.core.player.commands import BEGIN, EXPRESS, HOLD, RAMP, WRITE
from yehu_server.core.player.parameter_indices import INDEX, PARAMETER_COUNT
from yehu_server.params.table import ENGINE, SLOT

RATE = 22050
PATIENCE_S = 120.0  # for other threads and processes; they took 20 s on a busy machine
# Parameters that are not heard while no bow is on the strings.
INERT = [SLOT["/bow/force"], SLOT["/bow/pressure"]]
# Kind and index of commands that are not heard either, of even and of odd number.
(EVEN_KIND, EVEN), (ODD_KIND, ODD) = UNHEARD = [
    (RAMP, SLOT["/bow/force"]),
    (EXPRESS, INDEX["/playing/vibrato_rate"]),
]
run = partial(sound.run, block=4096)
FAR = 10**9  # a frame that never comes
LAST = TABLES_TO  # kind of events


def post_numbered(instrument: Instrument, number: int, frame: int = 0) -> bool:
    """Post a command that carries its number in each of its parts."""
    kind, index = UNHEARD[number % 2]
    return instrument.post(kind, frame=frame, index=index, value=number, other=-number)


def post_ramp(instrument: Instrument, frame: int, slot: int, target: float, ramp: int = 0) -> bool:
    """Post the ramp of a parameter of the engine, in frames."""
    return instrument.post(RAMP, frame=frame, index=slot, value=target, other=ramp)


def numbers(commands: np.ndarray) -> np.ndarray:
    """The numbers of commands posted by `post_numbered`; all parts of each must agree."""
    found = commands["value"].astype(int)
    np.testing.assert_array_equal(commands["value"], found)
    np.testing.assert_array_equal(commands["other"], -found)
    np.testing.assert_array_equal(commands["kind"], np.array(UNHEARD)[found % 2, 0])
    np.testing.assert_array_equal(commands["index"], np.array(UNHEARD)[found % 2, 1])
    return found


def offline() -> Instrument:
    return Instrument(InstrumentSpec(RATE))


def live(rate: float = RATE) -> Instrument:
    """An instrument whose blocks take a limited number of commands."""
    return Instrument(InstrumentSpec(rate), is_live=True)


def reporting(instrument: Instrument) -> Instrument:
    """An instrument, made to report the commands that it applies."""
    instrument.report_commands()
    return instrument


# ---------------------------------------------------------------- the ring between threads

_post = numba.njit(native.post.function)


def storm(rig, start, count):
    """Post numbered commands as fast as possible, each until it is taken; return the refusals."""
    refused = 0
    for number in range(start, start + count):
        kind, index = (ODD_KIND, ODD) if number % 2 else (EVEN_KIND, EVEN)
        while _post(rig, 0, kind, index, float(number), -float(number)) == 0:
            refused += 1
    return refused


@cache
def compiled_storm() -> Callable[[int, int, int], int]:
    return numba.cfunc("int64(voidptr, int64, int64)")(storm).ctypes


def post_by_storm(instrument: Instrument, count: int) -> int:
    compiled = compiled_storm()
    return sum(compiled(instrument.address, start, 1000) for start in range(0, count, 1000))


@contextmanager
def aside(work: Callable[[], object]) -> Iterator[None]:
    """A thread that repeats some work within the block."""
    stop = threading.Event()

    def repeat() -> None:
        while not stop.is_set():
            work()

    thread = threading.Thread(target=repeat, daemon=True)  # a test that fails may not hang
    thread.start()
    yield
    stop.set()
    thread.join()


def collect(
    instrument: Instrument, count: int, meanwhile: Callable[[], object] = bool
) -> np.ndarray:
    """Read reports until there are `count` of them."""
    reports, read = [], 0
    deadline = time.monotonic() + PATIENCE_S
    while read < count and time.monotonic() < deadline:
        meanwhile()
        reports.append(instrument.applied_commands().copy())  # without the room for more
        read += len(reports[-1])
    return np.concatenate(reports)


@pytest.mark.parametrize("make", [offline, live], ids=["offline", "live"])
def test_commands_come_whole_and_in_order_from_thread_to_thread(make):
    instrument, count, refused = reporting(make()), 50_000, []
    out = np.zeros(64, np.float32)
    mail = instrument._rig["mail"]

    def play() -> None:
        unread = mail["reported"][0, 0] - mail["read"][0, 0]
        if unread <= RING - len(out) * APPLIED_AT_ONCE:  # or reports would be dropped
            instrument.process(out)

    def post() -> None:
        refused.append(post_by_storm(instrument, count))

    poster = threading.Thread(target=post, daemon=True)
    with aside(play):
        poster.start()
        commands = collect(instrument, count)
        poster.join(PATIENCE_S)
    run(instrument, 64)
    assert not len(instrument.applied_commands())
    np.testing.assert_array_equal(numbers(commands), np.arange(count))
    assert (np.diff(commands["frame"]) >= 0).all()
    assert instrument.dropped_events == refused[0]
    meters = instrument.meters()
    assert (meters["applied"], meters["waiting"], meters["unreported"]) == (count, 0, 0)


# ---------------------------------------------------------------- full rings


@pytest.mark.parametrize("make", [offline, live], ids=["offline", "live"])
def test_a_full_ring_drops_and_counts_what_comes_and_keeps_what_it_has(make):
    instrument = reporting(make())
    for dropped in (10, 20):  # and afterwards it is as before
        for number in range(RING + 10):
            assert post_numbered(instrument, number) == (number < RING)
        assert instrument.dropped_events == dropped
        run(instrument, 2 * RING // BUDGET_PER_FRAME + 1000)
        np.testing.assert_array_equal(numbers(instrument.applied_commands()), np.arange(RING))


def test_a_writer_of_times_far_ahead_leaves_the_heap_to_the_others():
    for writer, far in ((MIDI_INPUTS, 10**15), (PAGES, FAR), (SOUND_INPUT, 10**15)):
        instrument = offline()
        for _ in range(2 * HEAP // SMALL_RING):
            for _ in range(SMALL_RING):
                assert native.post_from.call(
                    instrument.address, writer, far, *UNHEARD[0], 0.0, 0.0
                ), writer
            run(instrument, 1)
        assert instrument._rig["mail"]["pending_events"][0] == 0, writer
        assert instrument.dropped_events == 2 * HEAP, writer


def test_reports_nobody_reads_are_dropped_and_counted_and_the_older_kept():
    instrument = reporting(offline())
    for number in range(RING):
        post_numbered(instrument, number)
    run(instrument, 4096)
    for number in range(RING, RING + 100):
        post_numbered(instrument, number)
    run(instrument, 4096)
    assert instrument.meters()["applied"] == RING + 100
    assert instrument.meters()["unreported"] == 100
    np.testing.assert_array_equal(numbers(instrument.applied_commands()), np.arange(RING))
    post_numbered(instrument, 7)
    run(instrument, 64)
    np.testing.assert_array_equal(numbers(instrument.applied_commands()), [7])
    assert instrument.meters()["unreported"] == 100


def test_cursors_are_words_of_their_own_in_cache_lines_of_their_own():
    posted, read = memory.POSTED_AT, memory.READ_AT
    drained, reported = memory.DRAINED_AT, memory.REPORTED_AT
    for at in (posted, read, drained, reported, memory.VERSION_AT, memory.TAPED_AT):
        assert at % 8 == 0  # an atomic word may not lie across two
    for one, other in combinations([(posted,), (read,), (drained, reported)], 2):
        for mine, its in product(one, other):
            assert abs(mine - its) >= 8 * LINE


# ---------------------------------------------------------------- the heap: a plain model


def target(index: int, order: int) -> float:
    """A value within the parameter's range that no other command has."""
    param = ENGINE[index]
    return param.lo + (param.hi - param.lo) * order / (1 << 16)


class Model:
    """The mailbox in plain Python: a list that is sorted at each frame."""

    def __init__(self) -> None:
        self.frame, self.late, self.order = 0, 0, 0
        self.waiting: list[tuple[int, int, int]] = []  # frame, order, index
        self.applied: list[tuple[int, int, float]] = []  # frame, index, target

    def post(self, frame: int, index: int) -> float:
        """Post a command; return its target, which no other command has."""
        self.order += 1
        self.late += frame < self.frame
        self.waiting.append((frame, self.order, index))
        return target(index, self.order)

    def play(self, frames: int) -> None:
        for _ in range(frames):
            due = [command for command in sorted(self.waiting) if command[0] <= self.frame]
            for command in due[:APPLIED_AT_ONCE]:
                self.waiting.remove(command)
                _, order, index = command
                self.applied.append((self.frame, index, target(index, order)))
            self.frame += 1


def postings(frames: int, most: int) -> st.SearchStrategy:
    command = st.tuples(st.integers(-2, frames), st.sampled_from(INERT))
    # What is posted before a block, and how long that block is.
    return st.lists(st.tuples(st.lists(command, max_size=most), st.integers(1, frames)), max_size=6)


@settings(max_examples=25)
@given(
    st.one_of(postings(300, 60), postings(5, 60), postings(2, 120)),
    st.sampled_from([1, 64, 100, 333, 4096]),
)
def test_commands_apply_by_frame_and_then_as_posted_whatever_the_order_of_posting(batches, block):
    instrument, model = reporting(offline()), Model()
    for commands, frames in [*batches, ([], 600)]:
        for frame, index in commands:
            assert post_ramp(instrument, frame, index, model.post(frame, index))
        model.play(frames)
        run(instrument, frames, block=block)
    commands = instrument.applied_commands()
    assert (commands["kind"] == RAMP).all()
    assert not commands["other"].any()
    assert commands[["frame", "index", "value"]].tolist() == model.applied
    meters = instrument.meters()
    assert meters["late_events"] == model.late
    assert meters["applied"] == len(model.applied)
    assert meters["waiting"] == len(model.waiting)


# ---------------------------------------------------------------- the heap: single promises


def test_a_live_instrument_takes_in_so_many_commands_for_each_64_frames():
    instrument = live()
    for number in range(RING):
        post_numbered(instrument, number, FAR)
    for waiting in (LIVE_INTAKE, 2 * LIVE_INTAKE):
        run(instrument, 64)
        assert instrument.meters()["waiting"] == waiting
        room = sum(post_numbered(instrument, number, FAR) for number in range(2 * LIVE_INTAKE))
        assert room == LIVE_INTAKE
    assert instrument.dropped_events == 2 * LIVE_INTAKE


def test_a_command_of_no_kind_or_for_no_parameter_changes_nothing():
    wild = (-1, -2, 2**62, -(2**62))
    none = [
        *product([RAMP], [*wild, SILENCE + 1, SILENCE + 5]),
        *product([WRITE, HOLD, EXPRESS], [*wild, PARAMETER_COUNT, PARAMETER_COUNT + 5]),
        *product([*wild[1:], LAST + 1, LAST + 5], [0, INDEX["/playing/speed"]]),
    ]
    instrument, usual = offline(), offline()
    for each in (instrument, usual):
        each.post(BEGIN, value=69.0, other=69.0)
        run(each, 64)
    for number, (kind, index) in enumerate(none):
        instrument.post(kind, index=index, value=0.125, other=0.25)
        run(instrument, 64)
        run(usual, 64)
        assert instrument.meters()["applied"] == 2 + number
        for stage in ("controls", "player"):
            same = instrument._rig[stage].tobytes() == usual._rig[stage].tobytes()
            assert same, (stage, kind, index)


def test_a_reset_leaves_nothing_to_apply_or_to_report():
    instrument = reporting(offline())
    post_numbered(instrument, 1, 200)
    run(instrument, 100)
    post_numbered(instrument, 2, 0)
    run(instrument, 1)
    post_numbered(instrument, 3, 0)
    instrument.reset()
    run(instrument, 300)
    assert not len(instrument.applied_commands())
    meters = instrument.meters()
    assert (meters["waiting"], meters["applied"], meters["late_events"]) == (0, 0, 0)


# ---------------------------------------------------------------- a heap left in the middle

MANY = 200


def waiting_commands() -> tuple[Ensemble, list[int]]:
    """An instrument with many commands that wait in any order, and their numbers as due."""
    chance = random.Random(5)
    ensemble = sound.alone(RATE)
    instrument = reporting(ensemble.first)
    frames = [chance.randrange(500, 600) for _ in range(MANY)]
    for number, frame in enumerate(frames):
        post_numbered(instrument, number, frame)
    run(ensemble, 64)
    assert instrument.meters()["waiting"] == MANY
    return ensemble, sorted(range(MANY), key=lambda number: (frames[number], number))


def died(ensemble: Ensemble) -> None:
    """A process died while it computed a block, and another takes over."""
    ensemble.first._rig["meters"]["running"] = 1
    ensemble.recover()


def test_a_command_that_came_while_the_process_died_comes_once_and_no_other_is_lost():
    # While an entry comes or leaves, others move up or down by copies: one of them is there twice,
    # and the one that moves may be nowhere. It is still counted, or no longer.
    for lost in (0, 1, 7, MANY - 1):
        ensemble, expected = waiting_commands()
        instrument, heap = ensemble.first, ensemble.first._rig["events"][0, QUEUE_STARTS[SERVER] :]
        number = int(heap["order"][lost])
        heap[lost] = heap[MANY // 2]
        died(ensemble)
        assert instrument._rig["mail"]["pending_events"][0] == MANY - 1
        run(ensemble, 1000)
        expected.remove(number)
        np.testing.assert_array_equal(numbers(instrument.applied_commands()), expected)
