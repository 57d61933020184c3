"""The radiation that taps measured, as stable sections that the model plays."""

import numpy as np
import pytest
from lab.body.bodies import off_db, radiation, rms

from yehu_lab.body import Curve
from yehu_lab.body.sections import fit_sections, usable
from yehu_server.core.physics import kernel
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.radiation import response

GRID = np.geomspace(200.0, 5000.0, 4000)


def test_the_radiation_comes_out_again(whole_fit):
    off = off_db(whole_fit.radiation(GRID), radiation(GRID))
    assert rms(off) < 0.15
    assert np.abs(off).max() < 0.5


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


def test_at_other_rates_the_model_keeps_to_what_was_measured(whole_fit):
    for rate in (22050.0, 48000.0, 96000.0):
        model = kernel.prepare(Quantities(body=whole_fit.body), rate)[0]
        sections = np.stack([model[name] for name in ("b_0", "b_1", "a_1", "a_2")], axis=1)
        taps = model["taps"][: model["last_tap"] + 1]
        off = off_db(response(sections, taps, rate, GRID), whole_fit.radiation(GRID))
        assert np.abs(off).max() < 0.5, rate


# ---------------------------------------------------------------- the poles of sections

RATE = 44100.0


def test_poles_outside_the_circle_are_mirrored_into_it_and_real_ones_become_a_pair_that_rings():
    """They keep their frequency, and ring as long as they grew."""
    pairs = np.array([1.05 * np.exp(0.3j), 0.9 * np.exp(1j)])
    found = usable(np.concatenate([pairs, pairs.conj()]), 2, RATE)
    assert np.sort(np.abs(found)) == pytest.approx([0.9, 1.0 / 1.05])
    assert np.sort(np.angle(found)) == pytest.approx([0.3, 1.0])
    found = usable(np.array([0.9 + 0j, 0.5 + 0j, -0.2 + 0j, -0.4 + 0j]), 2, RATE)
    assert len(found) == 2
    assert found.imag.min() > 0.0
    assert np.abs(found).max() < 1.0
