"""The energy balance: none appears, none vanishes.

The ledger itself is checked against tests/reference.py in test_reference_step.py.
"""

import numpy as np
import pytest
from core.physics.runs import bump, play, shaped

from yehu_server.core.physics import kernel
from yehu_server.core.physics.default_quantities import Quantities, override

YEHU = Quantities()
X_C = YEHU.bridge_x


def balanced(run):
    """Check the laws that hold in every run."""
    assert run.state["lost"][0] == 0
    assert run.state["unconverged"][0] == 0
    assert np.isfinite(run.probes).all()
    assert np.isfinite(run.ledger).all()
    # The balance closes to rounding ...
    assert np.abs(run["energy_error"]).max() <= 1e-9 * run.power
    # ... but does not see what follows, so each is checked by itself.
    assert run["loss_friction"].min() >= -1e-12 * max(1.0, run["loss_friction"].max())
    assert run["loss_finger"].min() >= -1e-8
    assert run["v_r_residual"].max() <= 1e-9
    assert np.abs(run["friction_residual"]).max() <= 1e-9
    assert run["constraint_residual"].max() <= 1e-15
    for name in ("loss_strings", "loss_bridge", "loss_hair", "loss_bow_lift"):
        assert run[name].min() >= 0.0
    assert run["loss_contact_reset"].min() >= 0.0
    assert run["energy"].min() >= -1e-15


def held(t, each, values, ramp):
    """One value after another, each for so many seconds, with ramps between them."""
    count = int(t[-1] / each) + 1
    starts = each * np.arange(count)
    levels = np.resize(values, count)
    times = np.stack([starts, starts + ramp], axis=1).ravel()
    return np.interp(t, times, np.stack([np.roll(levels, 1), levels], axis=1).ravel())


def performance(t):
    """Both strings bowed in turn with many bow changes; pressing, gliding, vibrato, lifting."""
    turn = 2.0 * np.pi * t
    return {
        "F_N": held(t, 0.5, [0.7, 0.7, 0.5, -0.6, -0.6, 0.4, -0.4], ramp=0.04),
        "v_b": 0.3 * np.sin(0.9 * turn) * (1.0 + 0.3 * np.sin(4.3 * turn)),
        "x_b": 0.255 + 0.008 * np.sin(0.4 * turn),
        "x_f": [
            held(t, 0.5, [0.05, 0.10, 0.08, 0.15, 0.12, 0.19], ramp=0.1)
            + 0.002 * np.sin(6.0 * turn)
        ],
        "press": [held(t, 0.7, [0.0, 0.5, 1.0, 3.0, 0.0, 0.5], ramp=0.02)],
    }


@pytest.mark.parametrize(
    ("changes", "seconds", "rate"),
    [
        ({}, 4.0, 44100.0),
        pytest.param({}, 4.0, 96000.0, marks=pytest.mark.slow),
        ({"directions": "two"}, 2.0, 44100.0),
        ({"scheme": "modal"}, 1.5, 44100.0),
    ],
)
def test_seconds_of_playing_create_and_lose_no_energy(changes, seconds, rate):
    run = play(performance, seconds, rate, quantities=override(YEHU, changes))
    balanced(run)
    # It did play: power came in, and each kind of loss took some.
    assert run["power_in"].max() > 0.1
    for name in ("strings", "bridge", "finger", "hair", "friction"):
        assert run[f"loss_{name}"].max() > 1e-3, name


@pytest.mark.parametrize("rate", [22050.0, 96000.0])
def test_steps_in_every_control_create_no_energy(rate):
    """Bow and finger lifted and put down, the finger moved, a string plucked within a sample."""

    def jumps(t):
        return {
            "F_N": np.resize([0.7, 0.0, -0.5, 0.7, -0.7, 0.0], 1000)[(5.0 * t).astype(int)],
            "v_b": np.where((1.3 * t) % 1.0 < 0.5, 0.3, -0.3),
            "x_f": [np.resize([0.05, 0.10, 0.08, 0.15, 0.19], 1000)[(7.0 * t).astype(int)]],
            "press": [np.where((2.9 * t) % 1.0 < 0.5, 5.0, 0.0)],
            "pluck": np.where((1.7 * t) % 1.0 < 0.1, 2.0, 0.0) * np.where(t < 1.0, 1.0, -1.0),
            "x_pluck": 0.2 + 0.03 * np.sin(3.0 * t),
        }

    run = play(jumps, 2.0, rate)
    balanced(run)
    # The ledger has the energy of bristles and potentials that were reset.
    assert run["loss_bow_lift"].max() > 0.0
    assert run["loss_contact_reset"].max() > 0.0


def within_few_nodes(h):
    """Bow, bridge and two fingers within five nodes."""

    def curves(t):
        x_b = X_C - h * (1.6 + 0.6 * np.sin(13.0 * t))
        x_f = [X_C - h * (2.2 + np.sin(7.0 * t)), X_C - h * (1.7 + np.sin(11.0 * t))]
        return {"x_b": x_b, "x_f": x_f, "press": [1.0, 3.0]}

    return curves


def four_fingers(h):
    """Four that tap and glide; one crosses another, and one the bow."""
    del h

    def curves(t):
        turn = 2.0 * np.pi * t
        places = 0.1, 0.1 + 0.02 * np.sin(3.0 * turn), 0.11, 0.255 + 0.03 * np.sin(2.0 * turn)
        taps = 2.0 * (np.sin(5.0 * turn) > 0.0), 3.0 * (np.sin(3.0 * turn) > 0.0)
        x_f = [np.broadcast_to(place, len(t)) for place in places]
        return {"x_f": x_f, "press": [1.0, taps[0], 0.5, taps[1]]}

    return curves


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["F4", "C5"])
@pytest.mark.parametrize(("crowd", "fingers"), [(within_few_nodes, 2), (four_fingers, 4)])
def test_contacts_that_share_nodes_balance(sign, crowd, fingers):
    """Where the paper's formulas, one contact at a time, fail."""
    curves = crowd(float(kernel.prepare(YEHU, 44100.0)["h"][0, 0 if sign > 0.0 else 1]))
    balanced(play(lambda t: {"F_N": 0.5 * sign, "v_b": 0.3} | curves(t), 1.0, fingers=fingers))


FREE = ("pluck F4", "pluck C5", "hammer")


@pytest.mark.parametrize("rate", [22050.0, 48000.0])
@pytest.mark.parametrize("how", FREE, ids=lambda how: how.replace(" ", "-"))
def test_left_alone_the_instrument_only_ever_loses_energy(how, rate):
    """After a pluck or a strike, bow lifted, finger at rest: not a sample of growth."""
    state, strike = None, 0.0
    if how == "hammer":
        strike = 1e-3
    else:
        model = kernel.prepare(YEHU, rate)
        state = shaped(model, FREE.index(how), bump(0.02, 0.26, 3e-4))

    def hammer(t):
        return {"hammer": np.where(t < strike, 5.0 * np.sin(np.pi * t * 1e3), 0.0)}

    run = play(hammer, 1.0, rate, state=state)
    balanced(run)
    assert not run.finger(0)[:, 1:].any()  # the finger was not touched
    energy = run["energy"][round(1.1e-3 * rate) :]
    assert np.diff(energy).max() < 0.0
    assert energy[-1] < 0.1 * energy[0]


def test_at_rest_nothing_ever_happens():
    run = play({"v_b": 0.3}, 0.5, fingers=4)  # a moving bow that does not touch
    assert not run["bridge_force"].any()
    assert not run["pressure"].any()
    assert not run.ledger[:, :10].any()
    assert run["v_r"][-1] == -0.3
