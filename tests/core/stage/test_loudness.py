"""The default room pleases, and leaves a performance as loud as it was."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from acoustics import clarity_db
from stages import Stage, response, stage_inputs

from yehu_server.playing.preset_folders import Presets
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.scores.smf.reader import read_score
from yehu_server.util.loudness import a_weighting

ROOT = Path(__file__).resolve().parents[3]
RATE = 44100


def loudness_db(sound: np.ndarray) -> np.ndarray:
    """A-weighted mean power of each channel."""
    frames = len(sound) // 4096 * 4096
    rows = sound[:frames].astype(np.float64).reshape(-1, 4096, sound.shape[1])
    spectra = np.fft.rfft(rows * np.hanning(4096)[None, :, None], axis=1)
    weights = a_weighting(np.fft.rfftfreq(4096, 1.0 / RATE))[None, :, None]
    return 10.0 * np.log10(np.square(np.abs(spectra * weights)).sum(axis=(0, 1)))


@pytest.fixture(scope="module")
def air() -> np.ndarray:
    """The first seconds of the slow air, dry."""
    score = read_score(ROOT / "examples" / "slow_air.mid")
    events = score.events.where(score.events.time_s < 12.0)
    score = dataclasses.replace(score, events=events, duration_s=12.0)
    blocks = Performance([Part(score)], Options(rate=RATE, is_dry=True)).blocks()
    return np.concatenate(list(blocks))[:, 0]


def test_the_default_room_changes_the_loudness_of_a_tune_by_less_than_a_decibel(air):
    heard = Stage(RATE).play(air, stage_inputs(len(air)))[0]
    power = np.mean(10.0 ** (loudness_db(heard) / 10.0))
    change = 10.0 * np.log10(power) - loudness_db(air[:, None])[0]
    assert 0.0 < change < 1.0


@pytest.mark.parametrize(
    ("moved", "least", "most"), [({}, 1.0, 3.0), ({"distance": 2.0}, 10.0, 13.0)]
)
def test_the_hall_is_as_clear_as_halls_are_and_clearer_near_the_player(moved, least, most):
    """Concert halls have a C80 of -2 to 4 dB at most seats."""
    values = Presets().load("hall").values
    asked = {address.rpartition("/")[2]: value for address, value in values.items()}
    direct, room = response(48000.0, 2.3, **asked | moved)
    assert least < clarity_db(direct + room, 48000.0) < most
