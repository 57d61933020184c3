"""Schelleng's limits of the bow force."""

import math

import pytest

from yehu_server.core.physics import kernel
from yehu_server.core.physics.layout import MAX_FINGERS
from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.physics.schelleng import bridge_resistance, lower_limit, upper_limit


@pytest.mark.parametrize("f", [349.2, 440.0, 850.0, 1396.9])
def test_the_bridges_resistance_is_the_real_part_of_its_impedance_but_for_the_scheme(f):
    quantities = Quantities()
    body, w = quantities.body, 2.0 * math.pi * f
    admittance = sum(
        1j * w / (mass * (w_m**2 - w**2) + 1j * w * damping)
        for mass, damping, w_m in zip(body.mass, body.damping, body.omega, strict=True)
    )
    model = kernel.prepare(quantities, 48000.0, MAX_FINGERS)[0]
    assert bridge_resistance(model, f) == pytest.approx((1.0 / admittance).real, rel=0.01)


def test_both_limits_grow_with_speed_and_meet_near_the_bridge():
    Z, grip, R, v_b = 0.2, 0.4, 5.0, 0.2
    assert upper_limit(Z, grip, 2 * v_b, 0.1) == pytest.approx(2 * upper_limit(Z, grip, v_b, 0.1))
    assert lower_limit(Z, grip, R, 2 * v_b, 0.1) == pytest.approx(
        2 * lower_limit(Z, grip, R, v_b, 0.1)
    )
    meeting = Z / (4.0 * R)  # [Schelleng]: 2 Z v / (beta d) = Z^2 v / (2 R beta^2 d)
    assert lower_limit(Z, grip, R, v_b, meeting) == pytest.approx(
        upper_limit(Z, grip, v_b, meeting)
    )
    assert lower_limit(Z, grip, R, v_b, 2 * meeting) < upper_limit(Z, grip, v_b, 2 * meeting)
