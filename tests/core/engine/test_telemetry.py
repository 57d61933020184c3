"""Telemetry of the audio side: levels, string shapes, load, the time of a frame."""

import itertools
import threading
import time
from functools import partial

import numba
import numpy as np
import pytest
import sound

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine import native, telemetry
from yehu_server.core.engine.atomics import at, load_acquire
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import METERS_AT, POSTED_AT
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.engine.telemetry import BINS_PER_DEADLINE, LOAD_BINS, METERS, SHAPE_POINTS
from yehu_server.core.physics.layout import GHOST, STRINGS
from yehu_server.core.player.commands import RAMP

RATE = 44100
run = partial(sound.run, block=4096)
# PortAudio's flags: the one that counts; input under- and overflow, output overflow, priming.
OUTPUT_UNDERFLOW, OTHER_FLAGS = 4, [0, 1, 2, 8, 16]


def bowed(rate: float = RATE) -> Instrument:
    instrument = Instrument(InstrumentSpec(rate))
    sound.bow(instrument, press=1.5)
    return instrument


# ---------------------------------------------------------------- level


def windows(frames: int, block: int, rate: float) -> list[tuple[int, int]]:
    """Where windows of a sixtieth of a second begin and end: at the ends of chunks."""
    found, begin, now = [], 0, 0
    while now < frames:
        left = min(block, frames - now)
        for chunk in [CHUNK] * (left // CHUNK) + [left % CHUNK]:
            now += chunk
            if now - begin >= rate / 60.0:
                found.append((begin, now))
                begin = now
    return found


@pytest.mark.parametrize("rate", [22050, 44100, 96000])
@pytest.mark.parametrize("block", [1, 64, 100, 333, 4096])
def test_peak_and_rms_are_those_of_the_last_whole_window(rate, block):
    instrument = bowed(rate)
    frames = rate // 5 + 7
    out = run(instrument, frames, block=block).astype(np.float64)
    expected = windows(frames, block, rate)
    begin, end = expected[-1]
    meters = instrument.meters()
    assert meters["window"] == len(expected) > 3
    assert meters["peak"] == pytest.approx(np.abs(out[begin:end]).max(), rel=1e-6)
    assert meters["peak"] > 0.001
    assert meters["rms"] == pytest.approx(np.sqrt(np.mean(out[begin:end] ** 2)), rel=1e-5)
    assert meters["window_frames"] == frames - end


# ---------------------------------------------------------------- shapes


@pytest.mark.parametrize("rate", [22050, 44100, 192000])
def test_shapes_are_the_strings_as_they_were_when_the_window_closed(rate):
    instrument = bowed(rate)
    run(instrument, rate // 5)
    before = instrument.meters()["window"]
    while instrument.meters()["window"] == before:
        run(instrument, CHUNK)
    model, state = instrument._rig["model"][0], instrument._rig["state"][0]
    now = state["motion"]["u"][state["motion"]["level"]]
    shapes = instrument.meters()["shapes"]
    assert shapes.shape == (STRINGS, SHAPE_POINTS)
    for i in range(STRINGS):
        N = int(model["N"][i])
        string = now[i, GHOST : GHOST + N + 1]
        places = np.arange(SHAPE_POINTS) * N / (SHAPE_POINTS - 1)
        expected = np.interp(places, np.arange(N + 1), string)
        np.testing.assert_allclose(shapes[i], expected, rtol=1e-5, atol=1e-12)
    assert np.abs(shapes[0]).max() > 1e-6
    # Between windows they stay.
    kept = shapes.copy()
    run(instrument, CHUNK)
    np.testing.assert_array_equal(instrument.meters()["shapes"], kept)


# ---------------------------------------------------------------- load


def test_the_load_is_there_and_its_histogram_counts_every_callback():
    instrument = bowed()
    for number in range(1, 201):
        run(instrument, 256)
        meters = instrument.meters()
        assert meters["callbacks"] == meters["loads"].sum() == number
        assert meters["running"] == 0
        assert 0.0 < meters["load"] <= meters["worst_load"]
    assert meters["missed"] == meters["loads"][BINS_PER_DEADLINE:].sum()
    worst = min(int(meters["worst_load"] * BINS_PER_DEADLINE), LOAD_BINS - 1)
    assert np.flatnonzero(meters["loads"]).max() == worst


def test_the_load_is_cpu_time_over_the_deadline():
    instrument = bowed()
    out = np.zeros(RATE, np.float32)  # the mean of a second is all of this
    instrument.process(out)
    before = time.thread_time_ns()
    instrument.process(out)
    spent = 1e-9 * (time.thread_time_ns() - before)
    assert instrument.meters()["load"] == pytest.approx(spent, rel=0.2)


def account(meters: np.ndarray, *loads: float) -> None:
    """Account for callbacks of these loads, without flags."""
    for load in loads:
        seconds = meters[0]["block"] / meters[0]["rate"]
        telemetry.account(meters[0], round(1e9 * load * seconds), 0)


def fresh(rate: float = 48000.0, block: int = 480) -> np.ndarray:
    meters = np.zeros(1, METERS)
    meters["rate"], meters["block"] = rate, block
    meters["loop"]["ns_per_frame"] = 1e9 / rate
    return meters


def test_loads_are_sorted_by_sixty_fourths_of_the_deadline_and_missed_ones_counted():
    meters = fresh()
    account(meters, 0.0, 0.001, 0.51, 0.51, 0.99, 1.01, 1.99, 2.5, 1e6)
    bins = {int(at): int(meters["loads"][0, at]) for at in np.flatnonzero(meters["loads"][0])}
    assert bins == {0: 2, 32: 2, 63: 1, 64: 1, 127: 3}
    assert meters["missed"] == 4
    assert meters["worst_load"] == pytest.approx(1e6)


def test_under_runs_are_counted_as_the_device_flags_them_and_it_goes_on():
    instrument, out = Instrument(InstrumentSpec(RATE)), np.zeros(64, np.float32)
    for count, others in enumerate(itertools.product(OTHER_FLAGS, OTHER_FLAGS)):
        for flags in (sum(set(others)), sum(set(others)) + OUTPUT_UNDERFLOW):
            call = native.callback.call(None, out.ctypes.data, 64, None, flags, instrument.address)
            assert call == 0  # paContinue
        assert instrument.meters()["underruns"] == count + 1


# ---------------------------------------------------------------- the delay-locked loop


class Clock:
    """A device with jittering callbacks, and the delay-locked loop that follows it."""

    def __init__(self, rate: float, block: int, drift: float = 1.0, jitter_ns: float = 0.0) -> None:
        self.meters = fresh(rate, 0)
        self.block, self.exact_ns = block, 5e12
        self.ns_per_frame = 1e9 / (rate * drift)
        self._jitter_ns, self._chance = jitter_ns, np.random.default_rng(1)
        self.frame = 0

    def tick(self, late_ns: float = 0.0) -> int:
        """Begin one callback; return when it began."""
        started = round(self.exact_ns + late_ns + self._jitter_ns * self._chance.uniform(-1.0, 1.0))
        telemetry.update_clock(self.meters[0], self.frame, started, self.block)
        assert self.meters["frame"] == self.frame
        assert self.meters["block"] == self.block
        self.frame += self.block
        self.exact_ns += self.block * self.ns_per_frame
        return started

    def follow(self, seconds: float) -> np.ndarray:
        """Errors of start and frame time (ns), and ns per frame: one row per callback."""
        rows = []
        for _ in range(round(seconds * 1e9 / (self.block * self.ns_per_frame))):
            exact = self.exact_ns
            started = self.tick()
            loop = self.meters["loop"][0]
            rows.append((started - exact, loop["due_ns"] - exact, loop["ns_per_frame"]))
        return np.array(rows).T


@pytest.mark.parametrize("gap_ns", [0.3e9, 10e9, -0.3e9])
def test_after_a_stall_the_loop_starts_anew_at_once(gap_ns):
    clock = Clock(48000.0, 256, 0.9999, jitter_ns=0.1e6)
    clock.follow(6.0)
    clock.exact_ns += gap_ns
    started = clock.tick()
    assert clock.meters["loop"]["due_ns"] == started
    assert clock.meters["loop"]["ns_per_frame"] == 1e9 / 48000.0
    assert clock.meters["late_callbacks"] == (1 if gap_ns > 0.0 else 0)
    _, error, _ = clock.follow(1.0)
    assert np.abs(error).max() < 0.2e6
    assert clock.meters["late_callbacks"] == (1 if gap_ns > 0.0 else 0)


# ---------------------------------------------------------------- requests of several blocks


class Host(Clock):
    """A sound server with its own period, which keeps the rest of each block."""

    def __init__(self, period: int, block: int, **options: float) -> None:
        super().__init__(48000.0, block, **options)
        self.period, self._kept = period, 0
        self.begun_ns = self.exact_ns
        self._instrument = Instrument(InstrumentSpec(48000.0))
        self.ahead: list[float] = []  # frames played before their time, after each request

    def frame_at(self, moment_ns: float) -> float:
        """The frame stamped on an arrival at some time, without the delay."""
        return publishing(self._instrument, self.meters).frame_at(round(moment_ns))

    def ask(self, late_ns: float = 0.0, takes_ns: float = 50e3) -> None:
        """Let one period pass."""
        begun = now = self.begun_ns + late_ns
        while self._kept < self.period:
            self.exact_ns = now
            self.tick()
            self.meters["ended_ns"] = round(now + takes_ns)
            now += takes_ns + 2e3
            self._kept += self.block
        self.ahead.append(self.frame - self.frame_at(begun))
        self._kept -= self.period
        self.begun_ns += self.period * self.ns_per_frame

    def ask_for(self, seconds: float) -> None:
        for _ in range(round(seconds * 48000.0 / self.period)):
            self.ask()


@pytest.mark.parametrize("takes_ns", [20e3, 500e3])
@pytest.mark.parametrize(("period", "block"), [(64, 64), (64, 128), (1024, 128), (8192, 128)])
def test_how_much_a_device_asks_for_at_once_is_reported(period, block, takes_ns):
    host = Host(period, block)
    for _ in range(4 * 48000 // period):
        host.ask(takes_ns=takes_ns)
    assert host.meters["longest"] == max(period, block)
    assert host.meters["ahead"] == pytest.approx(max(period, block), abs=1.0)
    assert host.meters["late_callbacks"] == 0


@pytest.mark.parametrize("period", [256, 1024, 2048])
def test_time_goes_on_where_a_device_begins_to_ask_for_more_at_once(period):
    host = Host(128, 128)
    host.ask_for(6.0)
    for now in (period, 128):
        host.period, begun, first = now, host.begun_ns, host.frame
        for _ in range(20):
            host.ask()
            assert host.frame_at(begun) == pytest.approx(first, abs=1.0)
            begun, first = host.begun_ns, host.frame
        host.ask_for(0.3)
        assert host.meters["longest"] == now
        assert host.meters["ahead"] == pytest.approx(now, abs=1.0)
    assert host.meters["late_callbacks"] == 0


# ---------------------------------------------------------------- the frame of a moment


def publishing(instrument: Instrument, meters: np.ndarray) -> Instrument:
    """Let an instrument publish a record."""
    instrument._rig["published"] = meters
    return instrument


def test_the_first_frame_of_a_block_falls_on_when_it_was_due():
    instrument = bowed()
    for number in range(20):
        before = time.monotonic_ns()
        run(instrument, 441)
        after = time.monotonic_ns()
        meters = instrument.meters()
        assert meters["frame"] == 441 * number
        assert instrument.frame_at(int(meters["loop"]["due_ns"])) == 441 * number
        if number == 0:
            assert before <= meters["loop"]["due_ns"] <= after  # the clock is the same


def test_what_comes_at_a_steady_pace_is_stamped_at_a_steady_pace():
    clock = Clock(48000.0, 256, 0.9999, jitter_ns=0.5e6)
    clock.follow(6.0)
    instrument = Instrument(InstrumentSpec(48000.0))
    stamps = []
    for _ in range(1000):
        moment = clock.exact_ns + 3.1e6  # the same moment of each block
        clock.tick()
        stamps.append(publishing(instrument, clock.meters).frame_at(round(moment)))
    pace = np.diff(stamps)
    assert np.mean(pace) == pytest.approx(256.0, rel=1e-4)
    assert np.std(pace) < 0.5  # frames; the callbacks' own starts vary by 20


def test_time_goes_on_evenly_and_in_a_stall_stands_still_a_little_after_the_last_block():
    clock = Clock(48000.0, 480, 0.9999)
    clock.follow(8.0)
    instrument = publishing(Instrument(InstrumentSpec(48000.0)), clock.meters)
    first, due = int(clock.meters["frame"][0]), int(clock.meters["loop"]["due_ns"][0])
    end = first + 480 + native.STALL_NS / clock.ns_per_frame
    moments = [due + round(1e6 * ms) for ms in np.linspace(0.0, 100.0, 301)]
    frames = np.array([instrument.frame_at(moment) for moment in moments])
    assert (np.diff(frames) >= 0.0).all()
    elapsed = (np.array(moments) - due) / clock.ns_per_frame
    np.testing.assert_allclose(frames, np.minimum(first + elapsed, end), atol=0.01)
    assert instrument.frame_at(due + 10**15) == pytest.approx(end, abs=0.01)


# ---------------------------------------------------------------- readers


_read_meters = numba.njit(native.read_meters.function)
_publish = numba.njit(native.publish.function)


def write(rig, times):
    """Publish records that hold one number in all their fields."""
    t = numba.carray(at(rig, METERS_AT), (1,), METERS)[0]
    for number in range(times):
        t.frame, t.callbacks, t.unreported = number, number, number
        for i in range(LOAD_BINS):
            t.loads[i] = number
        _publish(rig)
        for _ in range(500):  # so that there is time to read
            load_acquire(rig, POSTED_AT)
    return times


def read(rig, into, times):
    """Read records; return the number of whole ones, or minus the number of torn ones."""
    t = numba.carray(into, (1,), METERS)[0]
    whole, torn = 0, 0
    for _ in range(times):
        if _read_meters(rig, into) == 1:
            is_whole = t.frame == t.callbacks == t.unreported
            for i in range(LOAD_BINS):
                is_whole = is_whole and t.loads[i] == t.frame
            whole += 1 if is_whole else 0
            torn += 0 if is_whole else 1
    return whole if torn == 0 else -torn


def test_a_reader_never_sees_half_of_a_record():
    instrument, into, times = Instrument(InstrumentSpec(RATE)), np.zeros(1, METERS), 200_000
    writing = numba.cfunc("int64(voidptr, int64)")(write).ctypes
    reading = numba.cfunc("int64(voidptr, voidptr, int64)")(read).ctypes
    writer = threading.Thread(target=lambda: writing(instrument.address, times))
    writer.start()
    found = []
    while writer.is_alive():
        found.append(reading(instrument.address, into.ctypes.data, 10_000))
    writer.join()
    assert min(found) >= 0
    assert sum(found) > 1000
    assert instrument.meters()["frame"] == times - 1


def test_while_a_block_is_being_published_the_one_before_is_read():
    instrument = Instrument(InstrumentSpec(RATE))
    run(instrument, 64)
    before = instrument.meters().copy()
    instrument._rig["version"][0, 0] += 1  # the audio side was interrupted here
    instrument._rig["published"]["callbacks"] = 777
    assert instrument.meters()["callbacks"] == before["callbacks"]


def test_lost_states_and_commands_are_reported():
    instrument = bowed()
    run(instrument, 4096)
    instrument._rig["state"]["motion"]["u"] = np.nan
    instrument.post(RAMP, frame=0, value=0.1)  # for a frame that has passed
    instrument.post(RAMP, frame=10**9, value=0.1)
    run(instrument, 64)
    meters = instrument.meters()
    assert meters["lost"] == instrument.lost_states == 1
    assert meters["unconverged"] == instrument.unconverged_solves
    assert meters["late_events"] == 1
    assert meters["applied"] == 5
    assert meters["waiting"] == 1
