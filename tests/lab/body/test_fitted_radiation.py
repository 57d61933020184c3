"""The radiation that taps measured, as stable sections that the model plays."""

import numpy as np
import pytest
from lab.body.bodies import off_db, radiation, rms

from yehu_server.core.physics import kernel
from yehu_server.core.physics.quantities import Quantities, measured_body
from yehu_server.core.physics.radiation import response
from yehu_server.errors import MeasurementError
from yehu_server.lab.body import Curve
from yehu_server.lab.body.sections import fit_sections

GRID = np.geomspace(200.0, 5000.0, 4000)


def test_the_radiation_comes_out_again(whole_fit):
    off = off_db(whole_fit.radiation(GRID), radiation(GRID))
    assert rms(off) < 0.15
    assert np.abs(off).max() < 0.5


def test_without_noise_the_whole_audible_band_is_met():
    hz = np.arange(60.0, 16_000.0, 4.0)
    found = fit_sections(Curve(hz, radiation(hz)))
    assert np.abs(off_db(found.response(hz), radiation(hz))).max() < 0.5


@pytest.mark.parametrize("delay_s", [0.0007, pytest.param(0.003, marks=pytest.mark.slow)])
def test_the_way_to_the_microphone_is_taken_off(delay_s):
    """It is the same fit as from near, but for the phase."""
    hz = np.arange(100.0, 7000.0, 3.0)
    late = radiation(hz) * np.exp(-2j * np.pi * hz * delay_s)
    found = fit_sections(Curve(hz, late))
    assert np.abs(off_db(found.response(GRID), radiation(GRID))).max() < 0.5
    assert found.delay_s == pytest.approx(delay_s, abs=4e-4)


def test_every_section_is_stable_and_rings(whole_fit):
    for _, _, a1, a2 in whole_fit.body.sections:
        poles = np.roots([1.0, a1, a2])
        assert np.abs(poles).max() < 1.0
        assert np.abs(poles.imag).min() > 0.0


def test_nothing_is_radiated_where_nobody_measured(whole_fit):
    """Outside the band the sections stay below the loudest place in it, by far."""
    loudest = np.abs(whole_fit.radiation(GRID)).max()
    outside = np.concatenate([np.linspace(20.0, 80.0, 50), np.linspace(9e3, 22e3, 300)])
    assert np.abs(whole_fit.radiation(outside)).max() < 0.05 * loudest


@pytest.mark.parametrize("rate", [22050.0, 48000.0, 96000.0])
def test_at_other_rates_the_model_keeps_to_what_was_measured(whole_fit, rate):
    model = kernel.prepare(Quantities(body=whole_fit.body), rate)[0]
    sections = np.stack([model[name] for name in ("b_0", "b_1", "a_1", "a_2")], axis=1)
    taps = model["taps"][: model["last_tap"] + 1]
    off = off_db(response(sections, taps, rate, GRID), whole_fit.radiation(GRID))
    assert np.abs(off).max() < 0.5


def test_too_few_lines_are_told():
    hz = np.linspace(100.0, 5000.0, 40)
    with pytest.raises(MeasurementError, match="too few"):
        fit_sections(Curve(hz, radiation(hz)))


def test_without_a_radiation_the_shipped_one_sounds(fitted):
    noise_db, found = fitted
    if noise_db != 40.0:
        assert found.body.sections == measured_body().sections
        assert any("no radiation" in line for line in found.warnings)
