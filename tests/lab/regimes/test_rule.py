"""The rule at its borders, and the parts it is made of."""

import math

import numpy as np
import pytest
from lab.regimes.test_judge import LENGTH, PERIOD, RATE, SPEED, WIDTH, every, found, slips

from yehu_lab.regimes.columns import (
    ANOMALOUS_LOW,
    APERIODIC,
    HELMHOLTZ,
    MULTIPLE_SLIP,
    OCTAVE,
    RAUCOUS,
    SILENT,
)
from yehu_lab.regimes.judge import name_regime
from yehu_lab.regimes.periods import NOWHERE, times_of_slips

COUNT = 430  # lags


def correlation(peaks):
    """A correlation that is flat but for peaks of some heights at some lags."""
    alike = np.zeros(COUNT)
    for lag, height in peaks.items():
        alike[lag - 1 : lag + 2] = height - 0.1, height, height - 0.1
    return alike


def test_slips_and_correlation_name_the_regime(subtests):
    for regime, lag, how_many, peaks in [
        (HELMHOLTZ, 100, 1.0, {100: 0.79}),
        (HELMHOLTZ, 100, 1.3, {100: 0.95, 200: 0.96}),
        (MULTIPLE_SLIP, 100, 1.5, {100: 0.79}),
        (OCTAVE, 50, 2.3, {50: 0.91, 100: 0.99}),
        (OCTAVE, 50, 1.7, {50: 0.91, 100: 0.99}),
        (OCTAVE, 50, 2.0, {30: 0.92, 50: 0.91, 100: 0.99}),
        (MULTIPLE_SLIP, 100, 3.0, {50: 0.91, 100: 0.99}),
        (MULTIPLE_SLIP, 100, 2.0, {50: 0.88, 100: 0.99}),
        (MULTIPLE_SLIP, 250, 1.5, {250: 0.92, 150: 0.5}),
        (APERIODIC, NOWHERE, 1.5, {250: 0.88}),
        (ANOMALOUS_LOW, 200, 0.5, {200: 0.81}),
        (ANOMALOUS_LOW, 200, 0.5, {200: 0.90, 400: 0.92}),
        (ANOMALOUS_LOW, 400, 0.5, {200: 0.82, 400: 0.92}),
        (RAUCOUS, NOWHERE, 0.9, {200: 0.78}),
        (RAUCOUS, NOWHERE, 0.9, {100: 0.7}),
        (APERIODIC, NOWHERE, 1.2, {200: 0.78}),
    ]:
        with subtests.test(regime=regime, lag=lag, how_many=how_many, peaks=peaks):
            alike = correlation(peaks)
            assert name_regime(how_many, 0.9, alike, COUNT, 100.0, 1.0, SPEED) == (regime, lag)


def test_a_string_that_hardly_moves_or_never_sticks_is_silent():
    for regime, motion, speed, sticking in (
        (HELMHOLTZ, 0.032, 0.2, 0.9),
        (SILENT, 0.028, 0.2, 0.9),
        (SILENT, 0.00009, 0.0, 0.9),
        (HELMHOLTZ, 0.00011, 0.0, 0.9),
        (HELMHOLTZ, 1.0, 0.2, 0.04),
        (SILENT, 1.0, 0.2, 0.02),
    ):
        alike = correlation({100: 0.95})
        found_regime, _ = name_regime(1.0, sticking, alike, COUNT, 100.0, motion, speed)
        assert found_regime == regime, (motion, speed, sticking)


def test_the_pitch_is_exact_between_samples():
    for period in (99.63, 100.21, 103.5):
        phase = (np.arange(LENGTH) / period) % 1.0
        velocity = -1.6 * np.where(phase < 0.12, np.sin(np.pi * phase / 0.12) ** 2, 0.0)
        assert abs(1200 * math.log2(found(velocity).pitch_hz * period / RATE)) < 0.05, period


def begun(velocity, speed=SPEED):
    """When slips begin, and Helmholtz motion (samples), or None."""
    bow = np.broadcast_to(float(speed), velocity.shape).copy()
    times = times_of_slips(np.maximum(0.0, -velocity), bow, len(velocity), float(PERIOD))
    return tuple(None if time < 0 else time for time in times)


def test_ten_slips_of_about_a_period_each_make_helmholtz_motion():
    assert begun(slips(every(PERIOD, 500, 1550)))[1] == pytest.approx(500, abs=WIDTH)
    assert begun(slips(every(PERIOD, 500, 1450)))[1] is None
    at = 500 + PERIOD * np.arange(20)
    apart = np.where(np.arange(20) % 2, 3, -3)  # distances may be a little uneven
    assert begun(slips(at + apart))[1] is not None
    assert begun(slips(at + 2 * apart))[1] is None


def test_bristles_that_bend_are_no_slip():
    small, large = (slips([200], depth=-0.3 * SPEED * part) for part in (0.9, 1.2))
    assert begun(small)[0] is None
    assert begun(large)[0] == pytest.approx(200, abs=WIDTH)
    assert begun(slips([200], depth=-0.018), speed=0.01)[0] is None
    assert begun(slips([200], depth=-0.022), speed=0.01)[0] is not None
    assert begun(large, speed=0.0)[0] is None
    assert found(np.full(LENGTH, -1.0)).first_slip_s == 0.0  # the first sample may slip


def test_a_ripple_beside_the_slips_is_none_of_them_and_one_that_trembles_is_one():
    usual = slips(every(PERIOD, 500))
    ripple = slips(every(PERIOD, 560), depth=-1.6 * 0.1)
    trembling = 0.6 * slips(every(PERIOD, 504), depth=1.0)
    for more in (ripple, trembling):
        assert begun(usual + more)[1] == pytest.approx(500, abs=WIDTH)


def test_the_end_is_judged_and_not_the_beginning():
    pressure = np.where(np.arange(LENGTH) < LENGTH - 11 * PERIOD, 1.0, 0.0)
    pressure += 0.01 * np.sin(2 * np.pi * np.arange(LENGTH) / PERIOD)
    rest = slips(every(130, end=LENGTH // 2)) + slips(every(PERIOD, LENGTH // 2))
    finding = found(rest, pressure=pressure)
    assert finding.regime == "helmholtz"
    assert finding.slips == pytest.approx(1.0, abs=0.01)
    assert finding.level_db == pytest.approx(-40.0 - 3.01, abs=0.05)
