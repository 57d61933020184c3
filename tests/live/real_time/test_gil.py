"""The sound goes on while Python stands still: ``test_native.py`` reads why in the machine code."""

import ctypes
import time

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
        instrument.report_commands()
        beginning = session_start_of([instrument], has_room=False)
        capture = CaptureWriter(tmp_path / "take.jsonl", beginning=beginning)
        output.begin(stage)
        listener = recorder(1).connected()
        bow(instrument)
        time.sleep(0.1)
        capture.commands(instrument.applied_commands())

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
