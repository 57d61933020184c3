"""Recording from a tape while it runs."""

import threading

import numpy as np
import pytest
import soundfile
from sound_files import KEPT_FRAMES, NoiseTape

from yehu_server.errors import OutputError
from yehu_server.live.audio import recordings
from yehu_server.live.audio.recordings import Recorder

RATE = 48000


@pytest.fixture
def tape() -> NoiseTape:
    return NoiseTape(float(RATE))


@pytest.mark.parametrize("begins", [0, 1000])
def test_a_recording_is_every_sample_from_its_beginning(tape, tmp_path, begins):
    before = tape.play(2000)[begins:]
    recording = Recorder(tape, tmp_path / "r.wav", begins, pytest.fail)
    played = np.concatenate([before, *(tape.play(777) for _ in range(20))])
    assert recording.is_running
    recording.stop()
    assert not recording.is_running
    samples, rate = soundfile.read(tmp_path / "r.wav", dtype="float32")
    assert rate == RATE
    np.testing.assert_array_equal(samples, played)
    assert recording.seconds == pytest.approx(len(played) / RATE)


def test_what_was_missed_is_said_and_is_silence_so_that_the_rest_keeps_its_place(
    tape, tmp_path, monkeypatch
):
    monkeypatch.setattr(recordings, "EVERY_S", 10.0)  # held up until it is stopped
    said: list[str] = []
    recording = Recorder(tape, tmp_path / "r.wav", 0, said.append)
    played = tape.play(KEPT_FRAMES + 60_000)
    recording.stop()
    samples, _ = soundfile.read(tmp_path / "r.wav", dtype="float32")
    missed = recording.missed_frames
    assert missed == 60_000
    assert not samples[:missed].any()
    np.testing.assert_array_equal(samples[missed:], played[missed:])
    assert not recording.is_whole
    (line,) = said
    assert f"{missed / RATE:.1f} s are missing from 0.0 s on" in line


def until(recording: Recorder, condition) -> None:
    for _ in range(10_000):
        if condition():
            return
        recording._thread.join(0.001)
    pytest.fail("never")


@pytest.mark.parametrize("name", ["r.wav", "r.flac"])
def test_a_recording_can_be_opened_at_any_moment_as_after_a_kill(tape, tmp_path, monkeypatch, name):
    monkeypatch.setattr(recordings, "EVERY_S", 0.001)
    target = tmp_path / name
    recording = Recorder(tape, target, 0, pytest.fail)
    played = np.zeros((0, 2), np.float32)
    for _ in range(4):
        played = np.concatenate([played, tape.play(5000)])
        until(recording, lambda: recording._position == len(played))  # noqa: B023
        killed = tmp_path / f"copy of {name}"
        killed.write_bytes(target.read_bytes())
        samples, _ = soundfile.read(killed, dtype="float32")
        held_back = 0 if name.endswith("wav") else 2 * 4096
        assert len(played) - held_back <= len(samples) <= len(played)
        np.testing.assert_allclose(samples, played[: len(samples)], rtol=0, atol=2.0**-22)
    recording.stop()
    assert soundfile.info(target).frames == len(played)


@pytest.mark.parametrize("name", ["r.wav", "r.flac"])
def test_a_full_disk_ends_the_recording_and_keeps_it_as_far_as_it_got(
    tape, tmp_path, monkeypatch, limited, name
):
    monkeypatch.setattr(recordings, "EVERY_S", 0.001)
    said: list[str] = []
    recording = Recorder(tape, tmp_path / name, 0, said.append)
    played = tape.play(10_000)
    until(recording, lambda: recording._position == 10_000)
    limited(100_001)
    played = np.concatenate([played, *(tape.play(1000) for _ in range(40))])
    until(recording, lambda: not recording.is_running)
    recording.stop()
    samples, rate = soundfile.read(tmp_path / name, dtype="float32")
    assert len(samples) == ((100_001 - 58) // 8 if name.endswith("wav") else 4 * 4096)
    np.testing.assert_allclose(samples, played[: len(samples)], rtol=0, atol=2.0**-22)
    assert recording.seconds == len(samples) / rate
    (line,) = said
    assert f"{name}: cannot write" in line
    assert f"{recording.seconds:.1f} s are kept" in line
    assert not recording.is_whole


@pytest.mark.parametrize("name", ["r.wav", "r.flac"])
def test_a_disk_without_room_for_a_second_refuses_and_leaves_no_file(tape, tmp_path, limited, name):
    limited(250_000)  # room for a second of one channel
    threads = threading.active_count()
    with pytest.raises(OutputError, match="cannot write"):
        Recorder(tape, tmp_path / name, 0, pytest.fail)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / name).write_text("older")
    with pytest.raises(OutputError, match="cannot write"):
        Recorder(tape, tmp_path / name, 0, pytest.fail, overwrite=True)
    assert (tmp_path / name).read_text() == "older"
    assert threading.active_count() == threads


@pytest.mark.parametrize("change", ["removed", "replaced", "moved"])
def test_a_recording_whose_file_is_removed_says_so_at_once(tape, tmp_path, monkeypatch, change):
    monkeypatch.setattr(recordings, "EVERY_S", 0.001)
    said: list[str] = []
    target = tmp_path / "r.wav"
    recording = Recorder(tape, target, 0, said.append)
    tape.play(10_000)
    until(recording, lambda: recording._position == 10_000)
    if change == "moved":
        target.rename(tmp_path / "other.wav")
    else:
        target.unlink()
    if change == "replaced":
        target.write_text("mine")
    until(recording, lambda: not recording.is_running)
    recording.stop()
    (line,) = said
    assert line.startswith(f"recording ended: {target}: was removed meanwhile")
    assert not recording.is_whole
    if change == "replaced":
        assert target.read_text() == "mine"
