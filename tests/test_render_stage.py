"""``yehu-server render`` on its stage: two channels, a room, and neither."""

import json
from pathlib import Path

import numpy as np
import pytest
import soundfile
from midi_files import midi_file, notes
from sound import rms

from yehu_server.playing.pitch_and_level import a_weighted_db

RATE = 44100
MAX_CHANGE_DB = 1.0  # of the loudness, by the usual room


@pytest.fixture
def tune(tmp_path) -> Path:
    score = notes((0.0, 0.4, 67, 80), (0.4, 0.4, 72, 90), (0.8, 0.6, 76, 70))
    return midi_file(tmp_path / "tune.mid", score)


@pytest.fixture
def play(command, tmp_path):
    """Render to float samples; return what the file has [shape=(frames,) or (frames, 2)]."""

    def run(*words: object) -> np.ndarray:
        target = tmp_path / "out.wav"
        code, _, err = command("render", *words, "-o", target, "--subtype", "float")
        assert code == 0, err
        return soundfile.read(target)[0]

    return run


def test_a_rendering_is_stereo_and_in_a_room_that_rings_on(play, tune):
    sound, dry = play(tune, "--tail", 1), play(tune, "--tail", 1, "--dry")
    assert sound.shape[1] == dry.shape[1] == 2
    left, right = sound.T
    assert rms(left - right) > 0.05 * rms(left)
    difference = (sound - dry).mean(axis=1)[int(1.45 * RATE) : int(1.6 * RATE)]
    assert rms(difference) > 0.001  # after the last note


def test_dry_has_the_same_on_both_sides_which_is_the_sound_of_one_channel(play, tune):
    left, right = play(tune, "--dry").T
    np.testing.assert_array_equal(left, right)
    np.testing.assert_array_equal(left, play(tune, "--dry", "--mono"))


def test_the_usual_room_leaves_the_loudness_as_it_is(play, tune):
    loudness = [
        np.mean([a_weighted_db(side[: int(1.4 * RATE)], RATE) for side in sound.T])
        for sound in (play(tune), play(tune, "--dry"))
    ]
    assert abs(loudness[0] - loudness[1]) < MAX_CHANGE_DB


def test_one_player_has_stems_too(command, tune, tmp_path):
    words = ("-o", tmp_path / "out.wav", "--stems", tmp_path / "stems", "--json")
    code, out, _ = command("render", tune, *words)
    assert code == 0
    stems = [Path(stem) for stem in json.loads(out)["stems"]]
    assert [stem.name for stem in stems] == ["01-tune.wav", "room.wav"]
    mix, *parts = (soundfile.read(path)[0] for path in (tmp_path / "out.wav", *stems))
    np.testing.assert_allclose(sum(parts), mix, atol=3 * 2.0**-23)
