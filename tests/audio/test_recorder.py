"""Recording off the tape, while the instrument plays."""

from __future__ import annotations

import numpy as np
import pytest
import soundfile

from yehu_server.audio import recorder
from yehu_server.audio.recorder import Recorder
from yehu_server.engine.instrument import TAPE_FRAMES, Instrument
from yehu_server.errors import OutputError

RATE = 48000


@pytest.fixture
def instrument() -> Instrument:
    instrument = Instrument(float(RATE))
    instrument.write("/bow/side", 1.0)
    instrument.write("/bow/speed", 0.2)
    return instrument


def play(instrument: Instrument, frames: int) -> np.ndarray:
    out = np.zeros(frames, np.float32)
    instrument.process(out)
    return out


def test_a_recording_is_every_sample_from_its_beginning(instrument, tmp_path):
    before = play(instrument, 1000)
    recording = Recorder(instrument, tmp_path / "r.wav", 0, pytest.fail)
    played = np.concatenate([before, *(play(instrument, 777) for _ in range(20))])
    assert recording.is_running
    recording.stop()
    assert not recording.is_running
    samples, rate = soundfile.read(tmp_path / "r.wav", dtype="float32")
    assert rate == RATE
    assert (samples == played).all()
    assert recording.seconds == pytest.approx(len(played) / RATE)


def test_a_recording_may_begin_later(instrument, tmp_path):
    play(instrument, 1000)
    recording = Recorder(instrument, tmp_path / "r.flac", 1000, pytest.fail)
    played = play(instrument, 4800)
    recording.stop()
    samples, _ = soundfile.read(tmp_path / "r.flac")
    assert samples == pytest.approx(played, abs=2.0**-22)


def test_what_was_missed_is_silence_so_that_the_rest_keeps_its_place(
    instrument, tmp_path, monkeypatch
):
    monkeypatch.setattr(recorder, "EVERY_S", 10.0)  # held up until it is stopped
    recording = Recorder(instrument, tmp_path / "r.wav", 0, pytest.fail)
    played = play(instrument, TAPE_FRAMES + 1000)
    recording.stop()
    samples, _ = soundfile.read(tmp_path / "r.wav", dtype="float32")
    missed = recording.missed_frames
    assert 1000 <= missed < TAPE_FRAMES // 2
    assert len(samples) == len(played)
    assert not samples[:missed].any()
    assert (samples[missed:] == played[missed:]).all()


def test_a_file_as_long_as_can_be_ends_the_recording_and_is_kept(instrument, tmp_path, monkeypatch):
    monkeypatch.setattr(recorder, "FRAMES_LIMIT", 2000)
    monkeypatch.setattr(recorder, "EVERY_S", 0.001)
    said: list[str] = []
    recording = Recorder(instrument, tmp_path / "r.wav", 0, said.append)
    play(instrument, 4000)
    recording._thread.join(10.0)
    assert "as long as a file can be" in said[0]
    assert soundfile.info(tmp_path / "r.wav").frames >= 2000


def test_a_place_that_cannot_be_written_is_refused_at_once(instrument, tmp_path):
    for target in (tmp_path / "none" / "r.wav", tmp_path, tmp_path / "r.mp3"):
        with pytest.raises(OutputError):
            Recorder(instrument, target, 0, pytest.fail)
