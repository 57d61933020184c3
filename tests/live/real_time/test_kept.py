"""Takes of ``yehu-server serve`` that is killed, interrupted, or out of disk space."""

import resource
import signal
import time
from pathlib import Path

import numpy as np
import pytest
import soundfile

from yehu_server.scores.capture import read_capture


@pytest.mark.parametrize("name", ["take.wav", pytest.param("take.flac", marks=pytest.mark.slow)])
def test_a_kill_leaves_takes_that_can_be_opened_and_a_capture_that_can_be_read(
    silent, tmp_path, until, name
):
    take, other, capture = (tmp_path / one for one in (name, "other.wav", "take.jsonl"))
    server = silent("--record", take, "--capture", capture, "--recordings", tmp_path)
    osc = server.osc()
    osc.send("/record/start", "other")
    osc.send("/note", 67, 90)
    until(lambda: np.any(sound_of(other)) and np.any(sound_of(take)), "a sound", 10.0)
    server.process.send_signal(signal.SIGKILL)
    server.process.wait()
    assert {path.name for path in tmp_path.iterdir()} == {name, "other.wav", "take.jsonl"}
    for file in (take, other):
        assert len(sound_of(file)) == soundfile.info(file).frames
        assert np.any(sound_of(file))
    assert len(read_capture(capture).commands) > 0


def sound_of(path: Path) -> np.ndarray:
    try:
        return soundfile.read(path, dtype="float32")[0]
    except (soundfile.LibsndfileError, ValueError):  # not begun, or of no length yet
        return np.zeros(0, np.float32)


@pytest.mark.slow
def test_ctrl_c_again_and_again_keeps_the_take(silent, tmp_path):
    take, capture = tmp_path / "take.wav", tmp_path / "take.jsonl"
    server = silent("--record", take, "--capture", capture, "--set", "/playing/release=2000")
    osc = server.osc()
    osc.send("/note", 67, 90)
    osc.status()
    for _ in range(3):
        server.process.send_signal(signal.SIGINT)
        time.sleep(0.02)
    assert server.wait() in (0, 130, -signal.SIGINT)  # the last: as Python was ending already
    assert np.any(sound_of(take))
    assert read_capture(capture).end is not None
    assert not any("Traceback" in line or "nothing written" in line for line in server.lines)


@pytest.mark.slow
def test_a_full_disk_is_reported_by_the_exit_code(silent, tmp_path):
    take = tmp_path / "take.wav"
    server = silent("--record", take)
    server.osc()
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (250_000, 250_000))
    ended = server.said(r"recording ended: .*take\.wav: cannot write: .*; (\d+\.\d) s are kept")
    assert server.end() == 2
    assert len(sound_of(take)) / 48_000 == pytest.approx(float(ended[1]), abs=0.05)
