"""The temperature of the contact, where an instrument has one."""

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics import kernel
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.rosin_heat import static_coefficient

THERMAL = override(Quantities(), {"bow": {"friction": "thermal"}})


def bowed(seconds=0.5, rate=44100.0):
    def curves(time):
        rise = np.minimum(1.0, time / 0.04)
        return {"F_N": 0.5 * rise, "v_b": 0.2 * rise, "x_f": [0.1], "press": [1.5]}

    return play(curves, seconds, rate, quantities=THERMAL)


def test_steady_slipping_has_the_friction_of_the_stribeck_curve_and_rest_that_of_static_friction():
    bow, law = THERMAL.bow, Named(kernel.prepare(THERMAL, 44100.0)[0])
    for v_r in (0.01, 0.1, 0.228, 0.5):
        mu = bow.mu_C + (bow.mu_S - bow.mu_C) * np.exp(-((v_r / bow.v_s) ** 2))
        assert static_coefficient.py_func(law, mu * v_r) == pytest.approx(mu, abs=2e-3), v_r
    assert static_coefficient.py_func(law, 0.0) == pytest.approx(bow.mu_S)


class Named:
    """A record whose fields are attributes."""

    def __init__(self, record):
        self.record = record

    def __getattr__(self, name):
        return self.record[name]


def test_slipping_heats_the_contact_and_rest_cools_it():
    run = bowed()
    hot = run.state[0]["motion"]["w"][0]
    assert 0.0 < hot < 3.0
    after = play({"F_N": 0.0}, 0.01, quantities=THERMAL, state=run.state)
    assert after.state[0]["motion"]["w"][0] < 1e-9


@pytest.mark.parametrize("v_b", [0.5, 1.0])
def test_a_bow_that_always_slips_is_as_hot_as_the_power_per_newton_that_it_loses(v_b):
    # Too light to catch the string: the friction is that of the Stribeck curve.
    bow = THERMAL.bow
    mu = bow.mu_C + (bow.mu_S - bow.mu_C) * np.exp(-((v_b / bow.v_s) ** 2))
    run = play({"F_N": 0.01, "v_b": v_b}, 0.05, quantities=THERMAL)
    assert run.state[0]["motion"]["w"][0] == pytest.approx(mu * v_b, rel=0.02)
    assert np.abs(run["f_b"][-100:]).mean() == pytest.approx(0.01 * mu, rel=0.02)


def test_it_converges_with_the_rate():
    # The start of a note, before chaos: the bridge force over 12 ms.
    def start(rate):
        run = bowed(0.012, rate)
        time = np.arange(len(run["bridge_force"])) / rate
        return np.interp(np.arange(0.0, 0.0115, 1e-4), time, run["bridge_force"])

    fine = start(192000.0)
    errors = [np.abs(start(rate) - fine).max() for rate in (24000.0, 48000.0, 96000.0)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.5 * errors[0]
