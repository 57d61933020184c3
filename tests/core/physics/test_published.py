"""scripts/validation/published.py and monochord.py, on sounds and maps that are made here."""

from pathlib import Path

import numpy as np
import pytest

SCRIPTS = Path(__file__).parents[3] / "scripts"


@pytest.fixture
def published(monkeypatch):
    monkeypatch.syspath_prepend(SCRIPTS)
    from validation import published

    return published


def test_levels_are_those_of_the_harmonics_though_the_pitch_is_a_little_off(published):
    time = np.arange(22050) / published.RATE
    wanted = -3.0 * np.arange(published.HARMONICS) - 20.0
    turns = 2.0 * np.pi * 441.0 * np.outer(np.arange(1, published.HARMONICS + 1), time)
    sound = 10.0 ** (wanted / 20.0) @ np.sin(turns)
    noise = 1e-6 * np.random.default_rng(1).normal(size=len(time))
    assert published.levels(sound + noise, 438.0) == pytest.approx(wanted, abs=0.1)


def test_a_common_filter_explains_a_filter_and_nothing_else(published):
    """What goes with frequency is taken away; what goes with the harmonic's number stays."""
    numbers = np.arange(1, published.HARMONICS + 1)
    hertz = np.outer([hertz for _, hertz, _ in published.NOTES], numbers)
    smooth = 15.0 * np.sin(2.0 * np.log2(hertz / 440.0))
    left = published.size(published.beside_common_filter(smooth))
    assert left["rms"] < 1.5
    weak = np.where(numbers % 2 == 0, -20.0, 0.0) * np.ones((len(published.NOTES), 1))
    assert published.size(published.beside_common_filter(weak))["rms"] > 9.0


def test_a_note_alone_that_is_off_is_not_explained_by_the_others(published):
    difference = np.zeros((len(published.NOTES), published.HARMONICS))
    difference[3] = 12.0
    left = published.beside_common_filter(difference)[3]
    assert left[np.isfinite(left)] == pytest.approx(12.0)


def test_one_gain_is_no_difference(published):
    theirs = np.random.default_rng(2).normal(-40.0, 10.0, (8, published.HARMONICS))
    found = published.compared(theirs, theirs - 7.0, theirs - 7.0)
    assert found["r"] == pytest.approx(1.0)
    assert [found[name] for name in ("own", "common", "common_median")] == pytest.approx([0.0] * 3)


def test_a_wedge_is_the_line_of_the_fastest_strokes(monkeypatch):
    monkeypatch.syspath_prepend(SCRIPTS)
    from validation import monochord

    needed = 1.2 * monochord.ACCELERATIONS + 0.5
    found = monochord.wedge_of(needed[:, np.newaxis] <= monochord.FORCES)
    assert (found.slope, found.at_zero) == pytest.approx((1.2, 0.5), abs=0.25)
