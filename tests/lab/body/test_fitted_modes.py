"""The paper's measured body comes out again from taps that were made of it."""

import numpy as np
import pytest
from core.physics.runs import play
from hypothesis import given, settings
from hypothesis import strategies as st
from lab.body.bodies import DAMPING, HZ, MASS, admittance, off_db, rms

from yehu_lab.body import Curve, Measurement, fit
from yehu_server.core.physics.default_quantities import Quantities, measured_body
from yehu_server.errors import MeasurementError

GRID = np.geomspace(200.0, 5000.0, 5000)


def test_the_admittance_and_its_modes_come_out_again(fitted):
    noise_db, found = fitted
    off = off_db(found.admittance(GRID), admittance(GRID))
    assert rms(off) < 0.1
    assert np.abs(off).max() < 0.5
    assert found.admittance(np.linspace(1.0, 22_000.0, 50_000)).real.min() > 0.0
    assert len(found.body.mass) in (len(HZ) - 1, len(HZ))  # two lie within 6 Hz
    hz, modes = np.array(found.body.frequency_hz), found.modes
    for i in (i for i in range(len(HZ)) if np.sort(np.abs(HZ - HZ[i]))[1] > 20.0):
        at = int(np.abs(hz - HZ[i]).argmin())
        share = {40.0: 0.05, 30.0: 0.15}[noise_db]
        assert hz[at] == pytest.approx(HZ[i], rel=0.001)
        assert modes.mass[at] == pytest.approx(MASS[i], rel=share)
        assert modes.resistance[at] == pytest.approx(DAMPING[i], rel=share)
    if noise_db == 40.0:
        assert found.warnings == ()
    else:  # without a radiation the shipped one sounds
        assert found.body.sections == measured_body().sections
        assert any("no radiation" in line for line in found.warnings)


@settings(max_examples=4)
@given(
    seed=st.integers(0, 2**32 - 1), count=st.integers(1, 16), noise=st.sampled_from([0.0, 0.1, 3.0])
)
def test_whatever_was_measured_its_body_is_passive_and_its_energy_balances(seed, count, noise):
    random = np.random.default_rng(seed)
    hz = np.linspace(100.0, 4000.0, 150)
    modes_hz = random.uniform(100.0, 4000.0, count)
    mass = np.exp(random.uniform(np.log(1e-3), np.log(10.0), count))
    damping = mass * 2.0 * np.pi * modes_hz * np.exp(random.uniform(-6.0, -1.5, count))
    values = admittance(hz, modes_hz, mass, damping)
    scatter = random.standard_normal(len(hz)) + 1j * random.standard_normal(len(hz))
    values = values + noise * np.abs(values).mean() * scatter
    try:
        found = fit(Measurement(Curve(hz, values), None), band_hz=(100.0, 4000.0))
    except MeasurementError as error:
        if noise > 1.0 and "no mode stands out" in str(error):
            return
        raise
    assert found.admittance(np.linspace(1.0, 20_000.0, 5000)).real.min() >= 0.0
    run = play(
        lambda t: {"F_N": np.minimum(t / 0.01, 1.0) * 0.6, "v_b": np.minimum(t / 0.02, 1.0) * 0.2},
        0.05,
        quantities=Quantities(body=found.body),
    )
    assert run.state["lost"][0] == 0
    assert np.abs(run["energy_error"]).max() <= 1e-9 * run.power
    assert run["loss_bridge"].min() >= 0.0


def test_what_cannot_be_fitted_is_reported():
    hz = np.linspace(100.0, 5000.0, 500)
    measured = Measurement(Curve(hz, admittance(hz)), None)
    for measurement, options, told in (
        (measured, {"modes": 65}, "65 modes"),
        (measured, {"modes": 0}, "0 modes"),
        (measured, {"sections": 65}, "65 sections"),
        (measured, {"band_hz": (1000.0, 500.0)}, "1000 to 500 Hz"),
        (measured, {"band_hz": (9000.0, 9500.0)}, "too few"),
        (Measurement(None, None), {}, "nothing was measured"),
    ):
        with pytest.raises(MeasurementError, match=told):
            fit(measurement, **options)
