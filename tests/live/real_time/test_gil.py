"""The sound goes on while Python stands still."""

from __future__ import annotations

import ctypes
import json
import threading
import time

import forks
import numpy as np
import pytest
from sound import alone

from yehu_server.core.engine.instrument import Instrument
from yehu_server.live.audio.output import Output, OutputOptions
from yehu_server.rendering.replay import blocks
from yehu_server.scores.capture import read_capture
from yehu_server.scores.capture_header import session_start_of
from yehu_server.scores.capture_writer import CaptureWriter

pytestmark = pytest.mark.slow

RATE, BLOCK = 48000, 128
A_SECOND_US = 1_000_000


def hold_the_gil() -> None:
    """Let no Python run for a second: calls by PyDLL keep the GIL."""
    ctypes.PyDLL(None).usleep(A_SECOND_US)


def bow(instrument: Instrument) -> None:
    instrument.write("/finger/1/position", 0.1, ramp_ms=0.0)
    instrument.write("/finger/1/press", 1.5)
    instrument.write("/bow/side", 1.0)
    instrument.write("/bow/speed", 0.2)


def places(heard: np.ndarray, played: np.ndarray, period: int = BLOCK) -> np.ndarray:
    """The place in `played` where each period of `heard` begins; -1 for none."""
    at = {played[n : n + 8].tobytes(): n for n in range(len(played) - period)}
    found = []
    for start in range(0, len(heard) - period + 1, period):
        place = at.get(heard[start : start + 8].tobytes(), -1)
        same = place >= 0 and (heard[start : start + period] == played[place : place + period])
        found.append(place if np.all(same) else -1)
    return np.array(found)


def breaks(found: np.ndarray) -> int:
    """Number of periods that do not continue the one before."""
    return int((np.diff(found) != BLOCK).sum())


def test_the_parents_gil_stops_nothing(jackd, recorder, tmp_path):
    jackd.start(BLOCK)
    output = Output(OutputOptions(device="system, JACK", blocksize=BLOCK), lambda _line: None)
    try:
        stage = alone(output.find(), memory=output.memory.buffer, channels=2)
        instrument = stage.first
        instrument.report_wishes()
        beginning = session_start_of([instrument], has_room=False)
        capture = CaptureWriter(tmp_path / "take.jsonl", beginning=beginning)
        output.begin(stage)
        listener = recorder(1).connected()
        bow(instrument)
        time.sleep(0.1)
        capture.wishes(instrument.applied_wishes())

        listener.forget()
        time.sleep(1.0)
        before = instrument.meters()
        hold_the_gil()
        after = instrument.meters()
        recording = listener.recording()
        end = instrument.frame
        tape = stage.taped(0)[1]
    finally:
        output.end()
    capture.close(end)
    assert after["frame"] - before["frame"] > 0.7 * RATE
    assert after["callbacks"] - before["callbacks"] > 0.7 * RATE / BLOCK

    captured = read_capture(tmp_path / "take.jsonl")
    replayed = np.concatenate(list(blocks(captured, captured.beginning.ensemble())))
    np.testing.assert_array_equal(replayed, tape[:end])

    found = places(recording.samples[0], tape[:, 0])
    half = len(found) // 2
    undisturbed, held = breaks(found[:half]), breaks(found[half:])
    assert held <= undisturbed + recording.xruns + 2
    assert (found[half:] >= 0).mean() > 0.95  # nothing but what was played


SECONDS = 4

# The stream and the GIL in one process. While the GIL is held for a second, several times, prints
# what the callback counted in each.
SAME_PROCESS = f"""
import ctypes, json, mmap, os
from yehu_server.live.audio.devices import choose, devices, load_portaudio
from yehu_server.live.audio.output import SharedMemory
from yehu_server.live.audio.stream import Stream
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.spec import InstrumentSpec


memory = SharedMemory()
stage = Ensemble(
    [InstrumentSpec({RATE:.1f})], channels=1, memory=memory.buffer
)
instrument = stage.first
sounddevice = load_portaudio()
device = choose(devices(sounddevice), "system, JACK")
order = {{"memory": memory.descriptor, "size": memory.size, "rate": {RATE:.1f},
         "blocksize": {BLOCK}, "channels": 1, "latency": "low"}}
stream = Stream(sounddevice, device, order)
stream.start()
hold_the_gil = ctypes.PyDLL(None).usleep
ctypes.CDLL(None).usleep(500_000)
counts = []
for _ in range({SECONDS}):
    before = instrument.meters().copy()
    hold_the_gil({A_SECOND_US})
    after = instrument.meters().copy()
    counts.append({{what: int(after[what] - before[what])
                   for what in ("frame", "callbacks", "late_callbacks", "underruns", "missed")}})
print(json.dumps(counts), flush=True)
stream.close()
os._exit(0)
"""


def test_the_gil_of_the_process_that_holds_the_stream_stops_nothing(jackd):
    jackd.start(BLOCK)
    run = forks.run(code=SAME_PROCESS, env=jackd.environment)
    assert run.returncode == 0, run.stderr
    # A callback that needs the GIL loses nearly all of each second's 375 blocks. Other
    # processes cost some of any second's, so the quietest second counts.
    held = min(json.loads(run.stdout), key=lambda second: second["underruns"])
    blocks_a_second = RATE / BLOCK
    assert held["frame"] > 0.7 * RATE
    assert held["callbacks"] > 0.7 * blocks_a_second
    assert held["missed"] < 0.1 * blocks_a_second
    assert held["late_callbacks"] < 0.1 * blocks_a_second
    assert held["underruns"] < 0.1 * blocks_a_second


def test_holding_the_gil_holds_python():
    # The tests above rely on this.
    counts = 0
    ending = threading.Event()

    def count() -> None:
        nonlocal counts
        while not ending.wait(0.001):
            counts += 1

    thread = threading.Thread(target=count)
    thread.start()
    time.sleep(0.2)
    before = counts
    hold_the_gil()
    during = counts - before
    ending.set()
    thread.join()
    assert before > 20
    assert during < before / 3
