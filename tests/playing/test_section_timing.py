"""Onsets of a section follow the law by which players correct their asynchronies."""

import numpy as np
import pytest
from together import Together

from yehu_server.core.midi.section_players import ERROR_MS, GAIN_HI, GAIN_LO

RATE = 48000.0
HALF_A_SECOND = 24000
USUAL = 0.25  # of /playing/variation


def fit(onsets):
    """Fit the law of ``midi.section_players``, each counted from a moment that a note's share.

    `onsets` [shape=(notes, players)]. Return the gains, and the standard deviation of the errors.
    """
    apart = onsets - onsets.mean(axis=1, keepdims=True)
    now, change = apart[:-1], np.diff(apart, axis=0)
    notes, players = now.shape
    corrected = -players * now[:, :, np.newaxis] * np.eye(players)  # [note, player, gain]
    corrected -= corrected.mean(axis=1, keepdims=True)
    terms = corrected.reshape(-1, players)
    gains, *_ = np.linalg.lstsq(terms, change.ravel(), rcond=None)
    left = change.ravel() - terms @ gains
    return gains, float(np.sqrt(np.sum(left**2) / (notes * (players - 1))))


def onsets(timing: Together, notes: int, step: int = HALF_A_SECOND):
    """How late each player is (ms) for each note."""
    return np.array([timing.onset(step * note) for note in range(notes)]) * 1e3 / RATE


@pytest.mark.parametrize("people", [2, 4, 8])
def test_gains_and_errors_are_found_again_by_regression(people):
    timing = Together(people, RATE, seed=3)
    gains, error = fit(onsets(timing, 3000))
    assert np.mean(gains) == pytest.approx(np.mean(timing.gains), abs=0.02)
    if people > 2:  # of two, only the sum of the gains shows
        assert gains == pytest.approx(timing.gains, abs=0.03)
    assert error == pytest.approx(ERROR_MS * USUAL, rel=0.05)


@pytest.mark.parametrize("people", [4, 8])
def test_four_who_play_correct_a_quarter_of_each_asynchrony(people):
    gains = []
    for seed in range(120):
        timing = Together(people, RATE, seed)
        timing.playing = 4
        gains += timing.gains
    assert len(gains) == 4 * 120
    assert np.mean(gains) == pytest.approx(0.25, abs=0.01)
    assert GAIN_LO / 4 <= min(gains) < max(gains) <= GAIN_HI / 4


def test_players_err_by_fourteen_milliseconds_at_most():
    varied, most = (Together(4, RATE, seed=3) for _ in range(2))
    varied.variation, most.variation = 0.4, 1.0
    # 0.4 of 36 ms is more than 14 already.
    assert np.array_equal(onsets(varied, 50), onsets(most, 50))
    duo, apart = Together(2, RATE, seed=0), []
    duo.variation = 1.0
    for seed in range(1500):  # first onsets, where nobody has anything to correct
        duo.begin(seed)
        apart.append(onsets(duo, 1).max())
    # The median of how far two normal numbers are apart, which the bound of 40 ms leaves alone.
    assert np.median(apart) == pytest.approx(0.6745 * np.sqrt(2.0) * 14.0, rel=0.05)


@pytest.mark.parametrize("people", [1, 2, 8, 16])
def test_nobody_is_early_or_too_late_and_somebody_is_on_time(people):
    late = onsets(Together(people, RATE, seed=5), 1000)
    assert late.min(axis=1) == pytest.approx(0.0)
    assert late.max() <= 40.0


def test_players_do_not_drift_apart_in_ten_minutes():
    late = onsets(Together(8, RATE, seed=1), 1200)
    by_minute = late.reshape(10, 120, 8).std(axis=2).mean(axis=1)
    assert by_minute.max() / by_minute.min() < 1.25
    means = late.reshape(10, 120, 8).mean(axis=1)
    assert means.max() < 25.0


def test_who_rests_is_not_waited_for():
    timing = Together(8, RATE, seed=4)
    onsets(timing, 10)
    timing.playing = 4
    late = onsets(timing, 3000)
    assert not late[:, 4:].any()
    gains, _ = fit(late[1:, :4])
    assert gains.mean() == pytest.approx(np.mean(timing.gains), abs=0.03)
    assert len(timing.gains) == 4
