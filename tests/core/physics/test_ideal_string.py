"""An ideal string against closed forms: Helmholtz's motion, and Schelleng's least force.

The instrument and its limits are those of scripts/validation; docs/validation.md describes them.
"""

import math
from pathlib import Path

import pytest

from yehu_lab.plot.cells import RATE_ERROR
from yehu_server import simulate
from yehu_server.core.physics.default_quantities import read_quantities
from yehu_server.util.files import shipped_folder

EXAMPLE = shipped_folder("examples") / "ideal_string.toml"
SCRIPTS = Path(__file__).parents[3] / "scripts"


@pytest.fixture
def ideal(monkeypatch):
    monkeypatch.syspath_prepend(SCRIPTS)
    from validation import ideal

    return ideal


@pytest.mark.parametrize("beta", [0.117, 0.156])
def test_a_steady_note_on_rigid_ends_is_helmholtz_motion(ideal, beta):
    """One slip a period, for beta of it, at v/beta; at the end a sawtooth of 2 Z v/beta."""
    found = ideal.helmholtz(beta, 0.4 * ideal.greatest_force(ideal.instrument(), beta))
    assert found["slips"] == pytest.approx(1.0, abs=0.05)
    assert found["slip_share"] == pytest.approx(1.0, abs=0.04)
    assert found["slip_velocity"] == pytest.approx(1.0, abs=0.06)
    assert found["sawtooth"] == pytest.approx(1.0, abs=0.03)


@pytest.mark.slow
def test_the_least_force_on_a_dashpot_goes_as_beta_to_the_power_of_minus_2(ideal):
    """Helmholtz motion lasts down to some three quarters of it; then slips are double."""
    betas = (0.101, 0.156)
    found = [ideal.measured_limit("resistive", beta, upper=False) for beta in betas]
    shares = [row["limit"] / row["schelleng"] for row in found]
    assert shares == pytest.approx([0.75, 0.75], abs=0.2)
    power = ideal.exponent(betas, [row["limit"] for row in found])
    assert power == pytest.approx(-2.0, abs=0.45)
    assert [row["reached"] for row in found] == pytest.approx([1.02, 1.02], abs=0.03)  # mu_S


def test_a_pluck_of_the_shipped_ideal_string_decays_by_what_its_bridge_takes():
    """A reflection from a dashpot R leaves (R - Z) / (R + Z) of a wave, once a period."""
    string = read_quantities(EXAMPLE).string_1
    run = simulate(
        {
            "duration": 0.22,
            "instrument": {"base": str(EXAMPLE)},
            "controls": {"press_force": 0.0},
            "pluck": {"string": 1, "position": 0.1, "amplitude": 1e-3},
        },
        energy=True,
    )
    energy = run.arrays["energy"]
    periods = 0.2 * math.sqrt(string.T / string.rho_A) / (2.0 * 0.3)
    wave = math.sqrt(string.T * string.rho_A)
    left = ((25.0 - wave) / (25.0 + wave)) ** (2.0 * periods)
    found = energy[round(0.22 * 44100) - 1] / energy[round(0.02 * 44100)]
    assert 10.0 * math.log10(found) == pytest.approx(10.0 * math.log10(left), rel=0.06)


def test_the_error_bar_of_maps_is_what_was_measured(ideal):
    """The mean difference of shares of Helmholtz motion between 44.1 and 352.8 kHz."""
    from validate import results

    assert ideal
    maps = [
        {row["map"]: row["helmholtz"] for row in rows} for rows in results()["convergence"].values()
    ]
    shares = [100.0 * abs(each["rate 44100"] - each["rate 352800"]) for each in maps]
    assert pytest.approx(sum(shares) / len(shares), abs=0.05) == RATE_ERROR


def test_the_pages_have_what_was_measured(ideal):
    from validate import results
    from validation.tables import PAGES, page

    assert ideal
    for each in PAGES:
        text = each.read_text(encoding="utf-8")
        assert text == page(text, results()), f"{each.name}: run scripts/validate.py write"
