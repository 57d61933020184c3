"""The measures of scripts/playability.py tell right from wrong on sounds that are known."""

from pathlib import Path

import numpy as np
import pytest

from yehu_server.core.physics.default_quantities import read_quantities
from yehu_server.playing.bowing_tables import bowing_table_beside, read_bowing_table

SCRIPTS = Path(__file__).parents[1] / "scripts"


@pytest.fixture(autouse=True)
def scripts(monkeypatch):
    monkeypatch.syspath_prepend(SCRIPTS)


@pytest.mark.slow
def test_an_erhu_plays_its_two_and_a_half_octaves_in_tune():
    """98 % of all, as docs/intonation.md tells; on another processor chaos may move some notes."""
    from measures.in_tune import grid
    from measures.take import Setup

    file = SCRIPTS.parent / "examples" / "erhu.toml"
    bowing = read_bowing_table(bowing_table_beside(file))
    (found,) = grid(Setup(44100.0, own=read_quantities(file), bowing=bowing))
    assert found.of == 32 * 20
    assert found.right >= 0.96 * found.of


RATE, NOTES, LENGTH_S = 22050, (69, 72, 74), 3.0


def moving(
    partials_db=0.0, level_db=0.0, cents=0.0, hertz=1.1, swell_db=0.0, slide_s=0.02, dip_db=0
):
    """Three notes in a row, of equal partials that move by sines; the odd ones against the even."""
    frames = round(RATE * LENGTH_S)
    time = np.arange(frames * len(NOTES)) / RATE
    ends = np.arange(1, len(NOTES)) * LENGTH_S
    points = np.stack((ends - slide_s / 2, ends + slide_s / 2), axis=1).ravel()
    key = np.interp(time, points, np.repeat(NOTES, 2)[1:-1])
    key += cents / 100.0 * np.sin(2.0 * np.pi * hertz * time)
    phase = 2.0 * np.pi * np.cumsum(440.0 * 2.0 ** ((key - 69.0) / 12.0)) / RATE
    inside = time % LENGTH_S
    db = level_db * np.sin(2.0 * np.pi * 2.5 * time)
    db += swell_db * np.interp(inside, (0.2, 1.5, 2.8), (0.0, 1.0, 0.0))
    near = np.abs((time + LENGTH_S / 2) % LENGTH_S - LENGTH_S / 2)
    db -= dip_db * np.interp(near, (0.02, 0.04), (1.0, 0.0))
    moves = partials_db * np.sin(2.0 * np.pi * 3.5 * time)
    each = [10.0 ** ((-1) ** k * moves / 20.0) * np.sin(k * phase) for k in range(1, 9)]
    return 0.05 * 10.0 ** (db / 20.0) * np.sum(each, axis=0)


@pytest.mark.parametrize(
    ("figure", "moved", "expected", "tolerance"),
    [
        ("partials", {}, 0.0, 0.1),
        # Even partials rise as the odd fall: the sum of both is in the middle but for what is even.
        ("partials", {"partials_db": 3.0}, 3.0 / 2**0.5, 0.15),
        ("level", {"level_db": 2.0}, 2.0 / 2**0.5, 0.15),
        ("swell", {"swell_db": 6.0}, 6.0, 0.6),
        ("pitch", {"cents": 6.0}, 6.0 / 2**0.5, 0.9),
        ("drift", {"cents": 6.0}, 0.9 * 6.0 / 2**0.5, 0.6),
        ("off", {"cents": 6.0, "hertz": 3.0}, 0.0, 1.0),
        ("steps", {}, 0.0, 0.0),
        ("steps", {"slide_s": 0.25}, 1.0, 0.0),
        ("dip", {"dip_db": 9.0}, 9.0, 1.0),
    ],
)
def test_the_motion_of_known_sounds_is_found(figure, moved, expected, tolerance):
    from measures.motion import motion

    found = motion(moving(**moved), RATE)
    assert found["notes"] == len(NOTES)
    assert found[figure] == pytest.approx(expected, abs=tolerance)


def test_a_vibrato_is_no_plain_pitch_and_no_drift():
    from measures.motion import motion

    found = motion(moving(cents=30.0, hertz=5.5), RATE)
    assert np.isnan(found["pitch"])
    assert found["drift"] < 2.0


def test_the_pitch_of_a_note_that_moves_is_that_of_its_partials():
    from measures.intonation import NONE, mean_off_by

    time = np.arange(round(0.4 * RATE)) / RATE
    phase = 2.0 * np.pi * 440.0 * 2.0 ** (7.0 / 1200.0) * time
    phase += 0.6 * np.sin(2.0 * np.pi * 2.5 * (time - 0.2))  # at most 6 cents more
    moves = [1.0 + 0.6 * np.sin(2.0 * np.pi * 1.7 * time + k) for k in range(8)]
    sound = sum(move * np.sin((k + 1) * phase) for k, move in enumerate(moves))
    assert mean_off_by(sound, RATE, 0.0, 0.4, 69) == pytest.approx(9.5, abs=1.5)
    assert mean_off_by(sound, RATE, 0.0, 0.4, 57) == pytest.approx(1207.0, abs=10.0)
    assert mean_off_by(0.0 * sound, RATE, 0.0, 0.4, 69) == NONE
