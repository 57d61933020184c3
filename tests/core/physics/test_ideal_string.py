"""An ideal string against closed forms: Helmholtz's motion, and Schelleng's least force.

The instrument and its limits are those of scripts/validation, of which docs/validation.md tells.
"""

from pathlib import Path

import pytest

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


def test_the_page_has_what_was_measured(ideal):
    from validate import results
    from validation.tables import PAGE, page

    assert ideal
    assert PAGE.read_text(encoding="utf-8") == page(results()), "run: scripts/validate.py write"
