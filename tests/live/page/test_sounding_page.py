"""The page sounds in a browser, from a plain file server; what it records and keeps is right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile
from live.page.browser import drive, missing, running

from yehu_server.cli import main
from yehu_server.core.player.calibration import frequency_hz
from yehu_server.live.page.site import server_of, url_of, write_page
from yehu_server.playing.pitch_and_level import cents, pitch_hz

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
B4, E5 = 71.0, 76.0


@pytest.fixture(scope="module")
def url(tmp_path_factory):
    """The page, written as static files and served."""
    folder = tmp_path_factory.mktemp("page")
    write_page(folder)
    with running(server := server_of(folder, 0)):
        yield url_of(server)


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Where downloads go."""
    return tmp_path_factory.mktemp("downloads")


@pytest.fixture(scope="module")
def found(url, folder):
    return drive("page_sounding.mjs", url, str(folder))


def off_by(sound: np.ndarray, rate: int, note: float = B4) -> float:
    """How far (cents) the loudest part of a sound, of left and right, is from a note."""
    sound = sound.mean(axis=1)
    loudest = int(np.argmax(np.convolve(sound**2, np.ones(rate // 4), "valid")))
    return cents(pitch_hz(sound[loudest : loudest + rate // 4], rate), frequency_hz(note, 440.0))


def test_it_sounds_soon_and_without_an_error(found):
    assert found["errors"] == []
    assert found["seconds"] < 10.0  # 0.3 s on a free machine
    assert found["status"] == "on"


def test_the_module_is_asked_for_once_to_play_by_and_to_sound_by(found):
    assert found["asked"] == 1


@pytest.mark.parametrize("name", ["recorded.wav", "script.wav"])
def test_what_is_recorded_is_the_note_that_was_played(found, folder, name):
    assert found
    sound, rate = soundfile.read(folder / name, dtype="float32")
    assert np.isfinite(sound).all()
    assert np.abs(sound).max() > 0.03
    assert abs(off_by(sound, rate)) < 26.0  # as wide as the vibrato, of which it hears a turn or so


@pytest.mark.parametrize("name", ["recorded.wav", "script.wav"])
def test_left_and_right_are_those_of_a_room(found, folder, name):
    """They differ by the room and the body's sides, and are about as loud."""
    assert found
    left, right = soundfile.read(folder / name, dtype="float64", always_2d=True)[0].T
    assert 0.3 < np.corrcoef(left, right)[0, 1] < 0.999
    assert np.mean(left**2) == pytest.approx(np.mean(right**2), rel=0.5)


def test_without_a_worklet_the_script_processor_sounds(found):
    assert found["secure"] is False


def test_the_server_replays_what_was_kept(found, folder, tmp_path):
    assert found
    assert main(["replay", str(folder / "kept.jsonl"), "-o", str(tmp_path / "kept.wav")]) == 0
    sound, rate = soundfile.read(tmp_path / "kept.wav", dtype="float32")
    assert len(sound) / rate == pytest.approx(1.9, abs=1.0)
    assert abs(off_by(sound, rate)) < 26.0  # as wide as the vibrato, of which it hears a turn or so


@pytest.fixture(scope="module")
def behind(url, folder):
    return drive("page_behind.mjs", url, str(folder))


def test_a_key_that_is_held_ends_when_another_tab_comes_to_the_front(behind):
    assert behind["hasFocus"] is False
    assert behind["keyEnded"]


def test_what_sounds_goes_on_behind_another_tab(behind, folder):
    assert behind["away"] > 2.0
    assert behind["lag"] < 0.1
    assert behind["noteEnded"]
    sound, rate = soundfile.read(folder / "behind.wav", dtype="float32")
    assert len(sound) / rate > behind["away"] + 1.0
    mixed = sound.mean(axis=1)
    moments = mixed[: len(mixed) // (rate // 20) * (rate // 20)].reshape(-1, rate // 20)
    assert np.abs(moments).max(axis=1).min() > 0.01
    assert abs(off_by(sound, rate, E5)) < 10.0


def test_pictures_stop_behind_another_tab_and_come_back(behind):
    drawn = behind["drawn"]
    assert min(drawn["before"], drawn["after"]) > 2 * drawn["away"]  # in twice the time


def test_nothing_goes_wrong_behind_another_tab(behind):
    assert behind["errors"] == []


@pytest.mark.slow
def test_a_tune_plays_to_its_end(url, folder):
    found = drive("page_sounding.mjs", url, str(folder), "mpe phrase")
    assert found["errors"] == []
    assert found["pressed"] == "true"
