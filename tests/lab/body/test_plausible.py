"""An admittance is what it is said to be: kind, sign and units."""

from itertools import product

import numpy as np
import pytest
from lab.body.bodies import admittance, radiation

from yehu_lab.body import Curve
from yehu_lab.body.curve import to_mobility
from yehu_lab.body.plausible import check_admittance, check_radiation
from yehu_server.errors import MeasurementError

HZ = np.linspace(100.0, 6000.0, 400)
TURN = 2j * np.pi * HZ
MEASURED = {"receptance": admittance(HZ) / TURN, "mobility": admittance(HZ),
            "accelerance": admittance(HZ) * TURN}  # fmt: skip


def checked(values, kind):
    return check_admittance(Curve(HZ, to_mobility(HZ, values, kind)), kind)


def test_the_right_kind_is_taken_and_the_wrong_way_round_is_named():
    for kind, values in MEASURED.items():
        assert checked(values, kind) == []
        with pytest.raises(MeasurementError, match="wrong way round"):
            checked(-values, kind)


def test_the_wrong_kind_is_named_also_from_500_hz_up_and_with_noise(everything):
    """Above its first resonance a body is mostly a mass, whose accelerance is a number."""
    hz = HZ[HZ > 500.0]
    noise = 1e-3 * np.random.default_rng(3).standard_normal((2, len(hz))).T @ [1.0, 1j]
    cases = list(product(MEASURED, MEASURED))
    for kind, told in cases if everything else cases[::4] + cases[1::4]:  # with their neighbours
        measured = to_mobility(hz, admittance(hz) + noise, kind, back=True)
        curve = Curve(hz, to_mobility(hz, measured, told))
        if kind == told:
            check_admittance(curve, told)
        else:
            with pytest.raises(MeasurementError, match=f"this is an? {kind}, and not an? {told}"):
                check_admittance(curve, told)


def test_wrong_units_are_named():
    for factors, told in (
        ((1e3, 1e-4), "not a fiddle's"),
        ((1e60, 1e-60), "too large or too small"),
    ):
        for factor in factors:
            with pytest.raises(MeasurementError, match=told):
                checked(factor * MEASURED["mobility"], "mobility")
            with pytest.raises(MeasurementError, match=told):
                check_radiation(Curve(HZ, factor * factor * radiation(HZ)))


def test_a_delay_is_warned_of_and_a_long_one_not_taken_for_another_kind():
    """50 us are a quarter of a circle at 5 kHz."""
    late = MEASURED["mobility"] * np.exp(-TURN * 1e-5)
    assert any("late" in line for line in checked(late, "mobility"))
    for lines in (300, 1000):
        hz = np.linspace(100.0, 6000.0, lines)
        late = admittance(hz) * np.exp(-2j * np.pi * hz * 5e-5)
        with pytest.raises(MeasurementError, match="without a delay"):
            check_admittance(Curve(hz, late), "mobility")
