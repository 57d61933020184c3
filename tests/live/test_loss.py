"""The audio server dies while the instrument plays, and comes back."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import soundfile

from yehu_server.audio import output
from yehu_server.audio.output import Output, OutputOptions, SharedMemory
from yehu_server.child import Child
from yehu_server.cli import main
from yehu_server.engine.instrument import Instrument
from yehu_server.replay import blocks
from yehu_server.score.capture import CaptureWriter, read_capture

DEVICE = "system, JACK Audio Connection Kit"
SOUNDS = 1e-3
TENSIONS = (49.5, 64.1)  # N


def peak(samples: np.ndarray) -> float:
    return float(np.abs(samples).max())


def begun(serve, folder: Path, *words: object):
    """A server that plays G4 on JACK, and a client of it."""
    files = ("--record", folder / "take.wav", "--capture", folder / "take.jsonl")
    server = serve("--midi-api", "none", *files, *words)
    osc = server.osc()
    server.said(f"playing on {DEVICE}")
    osc.send("/note", 67, 90)
    return server, osc


def same_again(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """The recording, and a replay of the capture."""
    words = ["replay", str(folder / "take.jsonl"), "-o", str(folder / "again.wav"), "--quiet"]
    assert main(words) == 0
    files = (folder / "take.wav", folder / "again.wav")
    return tuple(soundfile.read(file, dtype="float32")[0] for file in files)


def wait_for_frames(osc, frames: int) -> dict:
    """Wait while frames are played; return the status."""
    start = osc.status()["frame"]
    deadline = time.monotonic() + 2.0 + 2.0 * frames / 48000
    while time.monotonic() < deadline:
        status = osc.status()
        if status["frame"] >= start + frames:
            return status
        time.sleep(0.02)
    raise AssertionError(f"only {status['frame'] - start} of {frames} frames were played")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_without_its_audio_server_it_says_so_and_plays_on(
    number, jackd, serve, recorder, tmp_path, until
):
    jackd.start()
    server, osc = begun(serve, tmp_path)
    before = wait_for_frames(osc, 12_000)
    assert before["device"] == DEVICE
    assert before["note"] > 0

    said = len(server.lines)
    jackd.kill(number)
    server.said(f"{DEVICE} is gone; on the silent clock", 5.0, said)
    lost = osc.status()
    assert lost["device"] == "silent clock"
    assert "gone" in lost["problem"]
    assert lost["device_losses"] == 1
    assert lost["note"] == before["note"]
    silent = wait_for_frames(osc, 24_000)
    assert silent["note"] == before["note"]
    assert silent["rms_db"] > -60.0  # nobody hears it, but it sounds
    assert silent["lost_states"] == 0

    jackd.restart()
    server.said(f"playing on {DEVICE}", 10.0, said)
    back = wait_for_frames(osc, 24_000)
    assert back["device"] == DEVICE
    assert back["problem"] == ""
    assert back["note"] == before["note"]

    def sounds() -> bool:
        """Whether it is heard, by a new listener each time: JACK drops one that was too slow."""
        listener = recorder().connected()
        wait_for_frames(osc, 12_000)
        samples = listener.recording().samples[0, -4800:]
        return samples.size > 0 and peak(samples) > SOUNDS

    until(sounds, 15.0, "the instrument to be heard again")

    assert server.end() == 0
    recorded, again = same_again(tmp_path)
    np.testing.assert_array_equal(again, recorded)


def test_it_outlives_an_audio_server_that_dies_again_and_again(jackd, serve, tmp_path):
    jackd.start()
    server, osc = begun(serve, tmp_path)
    for losses in (1, 2):
        wait_for_frames(osc, 2_000)
        said = len(server.lines)
        jackd.kill()
        server.said("is gone", 5.0, said)
        jackd.restart()
        server.said(f"playing on {DEVICE}", 15.0, said)
        assert osc.status()["device_losses"] == losses
    assert server.end() == 0
    recorded, again = same_again(tmp_path)
    np.testing.assert_array_equal(again, recorded)


def test_it_ends_cleanly_while_its_audio_server_is_gone(jackd, serve, tmp_path):
    jackd.start()
    server, osc = begun(serve, tmp_path)
    wait_for_frames(osc, 4_000)
    jackd.kill()
    server.said("is gone", 5.0)
    assert server.end() == 0
    assert peak(soundfile.read(tmp_path / "take.wav")[0]) > SOUNDS


def test_an_audio_server_that_hangs_is_left_and_taken_up_again(jackd, serve, tmp_path):
    jackd.start()
    server, osc = begun(serve, tmp_path)
    before = wait_for_frames(osc, 4_000)
    said = len(server.lines)
    os.kill(jackd.pid, signal.SIGSTOP)
    server.said("is gone", 5.0, said)
    hung = wait_for_frames(osc, 12_000)
    assert hung["note"] == before["note"]
    os.kill(jackd.pid, signal.SIGCONT)
    server.said(f"playing on {DEVICE}", 20.0, said)
    wait_for_frames(osc, 4_000)
    assert server.end() == 0
    recorded, again = same_again(tmp_path)
    np.testing.assert_array_equal(again, recorded)


def test_an_audio_process_that_crashes_is_replaced(jackd, serve, tmp_path):
    jackd.start()
    server, osc = begun(serve, tmp_path)
    before = wait_for_frames(osc, 4_000)
    said = len(server.lines)
    (audio,) = server.family()
    os.kill(audio, signal.SIGKILL)
    server.said(f"playing on {DEVICE}", 10.0, said)
    after = wait_for_frames(osc, 4_000)
    assert after["note"] == before["note"]
    assert server.end() == 0


def test_a_server_that_starts_before_its_audio_server_takes_it_up_when_it_comes(
    jackd, serve, tmp_path
):
    jackd.start()
    jackd.stop()
    server = serve("--midi-api", "none", "--capture", tmp_path / "take.jsonl")
    osc = server.osc()
    server.said("playing on a silent clock")
    osc.send("/note", 67, 90)
    wait_for_frames(osc, 4_000)
    jackd.restart()
    server.said(f"playing on {DEVICE}", 10.0)
    status = wait_for_frames(osc, 4_000)
    assert status["note"] > 0
    assert status["device_losses"] == 0
    assert server.end() == 0


# ---------------------------------------------------------------- killed while it played

PLAYS_ON = """
import mmap, sys
import numpy as np
from yehu_server.engine import native
memory = mmap.mmap(int(sys.argv[1]), native.RIG.itemsize)
rig = np.frombuffer(memory, np.uint8).ctypes.data
out = np.zeros(8192, np.float32)
native.warm_up()
print("plays", flush=True)
while True:
    native.callback.call(None, out.ctypes.data, len(out), None, 0, rig)
"""


def bow(instrument: Instrument) -> None:
    frame = instrument.frame + 100
    instrument.write("/finger/1/position", 0.1, frame=frame, ramp_ms=0.0)
    instrument.write("/finger/1/press", 1.5, frame=frame)
    instrument.write("/bow/side", 1.0, frame=frame)
    instrument.write("/bow/speed", 0.2, frame=frame)


def test_what_was_recorded_over_a_kill_in_the_middle_of_a_block_is_replayed(tmp_path):
    memory = SharedMemory()
    live = Instrument(48000.0, memory=memory.buffer)
    live.report_events()
    capture = CaptureWriter(tmp_path / "take.jsonl", rate=live.rate, seed=0, tensions=TENSIONS)
    recorded = np.zeros(0, np.float32)
    for _ in range(3):
        bow(live)
        audio = subprocess.Popen(
            [sys.executable, "-c", PLAYS_ON, str(memory.descriptor)],
            stdout=subprocess.PIPE,
            pass_fds=[memory.descriptor],
        )
        assert audio.stdout.readline() == b"plays\n"
        time.sleep(0.1)
        audio.kill()
        audio.communicate()
        live.recover()
        capture.events(live.applied_events())
        begin, samples = live.taped(len(recorded))
        assert begin == len(recorded)
        recorded = np.concatenate([recorded, samples])
    bow(live)
    live.process(np.zeros(9600, np.float32))
    capture.events(live.applied_events())
    for since, frame in live.rests:
        capture.note("rest", frame, since=since)
    capture.close(live.frame)
    recorded = np.concatenate([recorded, live.taped(len(recorded))[1]])
    again = list(blocks(read_capture(tmp_path / "take.jsonl"), Instrument(live.rate)))
    np.testing.assert_array_equal(np.concatenate(again), recorded)


class Refusing:
    """An audio process whose stream opens but does not start."""

    def __init__(self, _module, heard, share=()) -> None:
        del share
        self._heard = heard

    def send(self, order: str, **_details: object) -> None:
        answers = {
            "look": {"event": "found", "name": "card", "rate": 48000.0, "channels": 2},
            "open": {"event": "ready", "latency_ms": 5.0},
            "start": {"event": "failed", "reason": "it does not start"},
        }
        self._heard(answers[order])

    def kill(self) -> None:
        pass

    stop = kill


def test_while_a_device_does_not_start_time_goes_on(monkeypatch):
    monkeypatch.setattr(output, "Child", Refusing)
    way_out = Output(OutputOptions(), lambda _line: None)
    instrument = Instrument(way_out.find(), memory=way_out.memory.buffer)
    try:
        way_out.begin(instrument)  # waits once
        longest, last, since = 0.0, instrument.frame, time.monotonic()
        start = since
        while (now := time.monotonic()) < start + 2.5:
            if instrument.frame != last:
                last, since = instrument.frame, now
            longest = max(longest, now - since)
            time.sleep(0.005)
    finally:
        way_out.end()
    assert longest < 0.5


def open_files() -> set[str]:
    return {entry.name for entry in Path("/proc/self/fd").iterdir()}


def test_a_helper_process_that_is_ended_leaves_no_pipe_open(until):
    before = open_files()
    helper = Child("yehu_server.control.midi_process", lambda _event: None)
    helper.stop()
    until(lambda: open_files() <= before, 2.0, "its pipes to be closed")


def test_a_helper_process_that_crashes_leaves_no_pipe_open(until):
    before = open_files()
    events = []
    helper = Child("yehu_server.control.midi_process", events.append)
    helper._process.kill()
    until(lambda: {"event": "gone"} in events, 2.0, "its end")
    time.sleep(0.1)
    assert open_files() <= before


@pytest.mark.parametrize("started", [0, 1])
def test_a_helper_process_that_nobody_could_listen_to_is_ended(monkeypatch, started):
    before, threads = open_files(), iter([True] * started + [False])
    start = threading.Thread.start

    def fail(thread: threading.Thread) -> None:
        if not next(threads):
            raise RuntimeError("can't start new thread")
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", fail)
    with pytest.raises(RuntimeError, match="thread"):
        Child("yehu_server.control.midi_process", lambda _event: None)
    monkeypatch.undo()
    assert open_files() <= before


TALKS = """
import time
from yehu_server.child import Parent
parent = Parent()
for _ in range(5000):
    parent.tell("midi", port="keystep", at=time.monotonic_ns(), bytes=[144, 60, 100])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere pipes hold what they hold")
def test_a_helper_process_need_not_wait_for_a_parent_that_is_stopped(monkeypatch, until):
    held = threading.Event()

    def hear(_event: dict) -> None:
        held.wait()  # as if we were stopped

    popen = subprocess.Popen
    monkeypatch.setattr(
        subprocess,
        "Popen",
        lambda _words, **options: popen([sys.executable, "-c", TALKS], **options),
    )
    helper = Child("talks", hear)
    try:
        until(lambda: not helper.is_alive, 20.0, "5,000 messages of it to be said")
    finally:
        held.set()
        helper.stop()
