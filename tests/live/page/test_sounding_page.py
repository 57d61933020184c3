"""The page sounds in a browser, from a plain file server; what it records and keeps is right."""

from pathlib import Path

import numpy as np
import pytest
import soundfile
from live.page.browser import drive

from yehu_server.cli import main
from yehu_server.core.player.note_tables import frequency_hz
from yehu_server.playing.pitch_and_level import cents, pitch_hz

B4, E5 = 71.0, 76.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Where downloads go."""
    return tmp_path_factory.mktemp("downloads")


@pytest.fixture(scope="module")
def found(sounding, folder):
    return drive("page_sounding.mjs", sounding, str(folder))


def off_by(sound: np.ndarray, rate: int, note: float = B4) -> float:
    """How far (cents) a sound, of left and right, is from a note: the median where it is loud."""
    size = rate // 4
    windows = np.lib.stride_tricks.sliding_window_view(sound.mean(axis=1), size)[:: size // 4]
    power = np.square(windows).mean(axis=1)
    pitches = [pitch_hz(window, rate) for window in windows[power > 0.25 * power.max()]]
    return float(np.nanmedian([cents(pitch, frequency_hz(note, 440.0)) for pitch in pitches]))


def test_it_sounds_with_or_without_a_worklet_and_asks_once_for_the_module(found):
    assert found["status"] == "on"
    assert found["asked"] == 1  # to play by and to sound by
    assert found["secure"] is False  # and then the script processor sounds


@pytest.mark.usefixtures("found")
@pytest.mark.parametrize("name", ["recorded.wav", "script.wav"])
def test_what_is_recorded_is_the_note_that_was_played_on_both_sides_of_a_room(folder, name):
    sound, rate = soundfile.read(folder / name, dtype="float32")
    assert np.isfinite(sound).all()
    assert np.abs(sound).max() > 0.03
    assert abs(off_by(sound, rate)) < 26.0  # as wide as the vibrato, of which it hears a turn or so
    # They differ, by any correlation as the body sways, and are about as loud.
    left, right = sound.T.astype(float)
    assert abs(np.corrcoef(left, right)[0, 1]) < 0.999
    assert 0.4 < np.mean(left**2) / np.mean(right**2) < 2.5  # one note, in a room that answers


@pytest.mark.usefixtures("found")
def test_the_server_replays_what_was_kept(folder, tmp_path):
    assert main(["replay", str(folder / "kept.jsonl"), "-o", str(tmp_path / "kept.wav")]) == 0
    sound, rate = soundfile.read(tmp_path / "kept.wav", dtype="float32")
    assert len(sound) / rate == pytest.approx(1.9, abs=1.0)
    assert abs(off_by(sound, rate)) < 26.0


def test_behind_another_tab_keys_and_pictures_end_and_what_sounds_goes_on(sounding, folder):
    behind = drive("page_behind.mjs", sounding, str(folder))
    assert behind["hasFocus"] is False
    assert behind["keyEnded"]
    assert behind["drawnAway"] < 3  # in a second, once what was on its way is drawn
    assert behind["away"] >= 2.0
    assert behind["noteEnded"]
    sound, rate = soundfile.read(folder / "behind.wav", dtype="float32")
    assert len(sound) / rate > behind["away"]
    mixed = sound.mean(axis=1)
    moments = mixed[: len(mixed) // (rate // 20) * (rate // 20)].reshape(-1, rate // 20)
    assert np.abs(moments).max(axis=1).min() > 0.01
    assert abs(off_by(sound, rate, E5)) < 15.0  # it has two places, 13 cents apart


@pytest.mark.slow
def test_a_tune_plays_to_its_end(sounding, folder):
    found = drive("page_sounding.mjs", sounding, str(folder), "mpe phrase")
    assert found["pressed"] == "true"
