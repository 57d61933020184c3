"""The audio server dies while the instrument plays, and comes back."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
import soundfile

from yehu_server.cli import main
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.server import Server
from yehu_server.playing.options import PlayingOptions
from yehu_server.util.processes import Child

DEVICE = "system, JACK Audio Connection Kit"
SOUNDS = 1e-3


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


@pytest.mark.slow
def test_without_its_audio_server_it_says_so_and_plays_on_again_and_again(
    jackd, serve, recorder, tmp_path, until
):
    jackd.start()
    server, osc = begun(serve, tmp_path)
    before = wait_for_frames(osc, 12_000)
    assert before["device"] == DEVICE
    assert before["note"] > 0

    for losses, number in enumerate([signal.SIGTERM, signal.SIGKILL], 1):
        said = len(server.lines)
        jackd.kill(number)
        server.said(f"{DEVICE} is gone; on the silent clock", 5.0, said)
        lost = osc.status()
        assert lost["device"] == "silent clock"
        assert "gone" in lost["problem"]
        assert lost["device_losses"] == losses
        silent = wait_for_frames(osc, 24_000)
        assert lost["note"] == silent["note"] == before["note"]
        assert silent["rms_db"] > -60.0  # nobody hears it, but it sounds
        assert silent["lost_states"] == 0

        jackd.restart()
        server.said(f"playing on {DEVICE}", 15.0, said)
        back = wait_for_frames(osc, 24_000)
        assert (back["device"], back["problem"]) == (DEVICE, "")
        assert back["note"] == before["note"]

    def sounds() -> bool:
        """Whether it is heard, by a new listener each time: JACK drops one that was too slow."""
        listener = recorder().connected()
        wait_for_frames(osc, 12_000)
        samples = listener.recording().samples[0, -4800:]
        return samples.size > 0 and peak(samples) > SOUNDS

    until(sounds, "the instrument to be heard again", 15.0)

    assert server.end() == 0
    recorded, again = same_again(tmp_path)
    np.testing.assert_array_equal(again, recorded)


@pytest.mark.slow
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


# ---------------------------------------------------------------- killed while it played


class Stopped:
    """A server that plays G4 on JACK, and its audio process, stopped in a block or between two."""

    def __init__(self, server: Server, until: Callable, *, in_block: bool) -> None:
        self.server, self.player = server, server.player
        self.instrument = server.instrument
        self._until = until
        assert server.output.state.device == DEVICE
        self.player.key_on(67.0, 90.0, frame=self.player.frame_of())
        until(lambda: self.player.pitch == 67.0, "the note", 5.0)
        self._audio = server.output._child._process.pid
        until(lambda: self._stop(in_block=in_block), "the audio process to be there", 60.0)

    def _stop(self, *, in_block: bool) -> bool:
        """Stop the process; let it go on if it is elsewhere."""
        os.kill(self._audio, signal.SIGSTOP)
        threads = Path(f"/proc/{self._audio}/task")
        self._until(
            lambda: all(") T " in (one / "stat").read_text() for one in threads.iterdir()),
            "all threads to be stopped",
            2.0,
        )
        if bool(self.instrument._rig["meters"]["running"][0]) == in_block:
            return True
        os.kill(self._audio, signal.SIGCONT)
        time.sleep(0.0037)
        return False

    def kill(self) -> None:
        """Kill the process, and wait until another one plays."""
        os.kill(self._audio, signal.SIGKILL)
        output = self.server.output
        self._until(lambda: output.state.losses == 1, "the loss", 5.0)
        self._until(lambda: output.state.device == DEVICE, "the device", 15.0)
        self.wait(2000)

    def wait(self, frames: int) -> None:
        end = self.instrument.frame + frames
        self._until(lambda: self.instrument.frame >= end, "frames to be played", 5.0)

    @property
    def keys(self) -> tuple[int, int]:
        """Number of keys that are held, by the audio side and by the server."""
        held = int(self.instrument._rig["player"]["held"][0])
        return held, len(self.player.held())


@pytest.fixture
def stopped(jackd, until) -> Iterator[Callable[..., Stopped]]:
    jackd.start()
    interval = sys.getswitchinterval()
    with contextlib.ExitStack() as ending:
        ending.callback(sys.setswitchinterval, interval)

        def make(*, in_block: bool) -> Stopped:
            options = ServeOptions(
                output=OutputOptions(device="system, JACK"),
                midi=None,
                osc=("127.0.0.1", 0),
                parts=[PartOptions(PlayingOptions(settings=(("/playing/variation", 0.0),)))],
            )
            server = Server(options, lambda _line: None)
            ending.callback(server.stop)
            server.start()
            return Stopped(server, until, in_block=in_block)

        yield make


def test_a_note_in_the_middle_of_which_the_audio_process_dies_does_not_hang(stopped, until):
    it = stopped(in_block=True)
    assert it.keys == (1, 1)
    it.kill()
    (gap,) = it.server.ensemble.gaps
    assert it.keys == (0, 0)
    assert it.player.pitch is None
    assert it.player.value("/bow/speed") == it.player.value("/bow/side") == 0.0
    assert not it.server.ensemble.taped(gap[0])[1].any()
    it.player.key_off(67.0, frame=it.player.frame_of())  # let go later
    it.wait(4800)
    assert not it.server.ensemble.taped(gap[0])[1].any()
    it.player.key_on(69.0, 90.0, frame=it.player.frame_of())
    until(lambda: it.player.pitch == 69.0, "a new note", 5.0)
    it.wait(9600)
    assert peak(it.server.ensemble.taped(it.instrument.frame - 4800)[1]) > SOUNDS
    assert it.keys == (1, 1)
    it.player.key_off(69.0, frame=it.player.frame_of())
    until(lambda: it.player.pitch is None, "its end", 5.0)
    assert it.keys == (0, 0)


def test_a_note_goes_on_where_the_audio_process_dies_between_two_blocks(stopped, until):
    it = stopped(in_block=False)
    it.kill()
    assert it.server.ensemble.gaps == []
    assert it.player.pitch == 67.0
    assert it.keys == (1, 1)
    assert peak(it.server.ensemble.taped(it.instrument.frame - 1000)[1]) > SOUNDS
    it.player.key_off(67.0, frame=it.player.frame_of())
    until(lambda: it.player.pitch is None, "its end", 5.0)
    assert it.keys == (0, 0)


@pytest.mark.parametrize("end", ["key_off", pytest.param("panic", marks=pytest.mark.slow)])
def test_a_key_that_was_pressed_while_the_audio_process_died_can_be_let_go(stopped, until, end):
    it = stopped(in_block=True)
    it.player.key_on(72.0, 90.0, frame=it.player.frame_of())
    it.kill()
    words = (72.0,) if end == "key_off" else ()
    getattr(it.player, end)(*words, frame=it.player.frame_of())
    until(lambda: it.keys == (0, 0), "the key to be let go", 5.0)
    until(lambda: it.player.pitch is None, "its end", 5.0)


def open_files() -> set[str]:
    return {entry.name for entry in Path("/proc/self/fd").iterdir()}


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
        Child("yehu_server.live.midi.input_process", lambda _event: None)
    monkeypatch.undo()
    assert open_files() <= before


TALKS = """
import time
from yehu_server.util.processes import Parent
parent = Parent()
for _ in range(5000):
    parent.send("midi", port="keystep", at=time.monotonic_ns(), bytes=[144, 60, 100])
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
        until(lambda: not helper.is_alive, "5,000 messages of it to be said", 20.0)
    finally:
        held.set()
        helper.stop()
