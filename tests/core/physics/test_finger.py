"""Fingers: how they land, hold, stop the string and leave."""

import math

import numpy as np
import pytest
from core.physics.runs import play, rows
from pitch import cents, pitch_of

from yehu_server.core.physics import kernel, layout, time_loop
from yehu_server.core.physics.default_quantities import Quantities

YEHU = Quantities()
FINGER = YEHU.finger
RATE = 44100.0


def wave_speed(string):
    return math.sqrt(string.T / (string.rho * math.pi * string.r**2))


def bowed(t, x_b=0.27, sign=1.0):
    """A bow that starts as a player's does: force and speed together, over 40 ms."""
    start = np.minimum(1.0, t / 0.04)
    return {"F_N": 0.6 * sign * start, "v_b": 0.25 * start, "x_b": x_b}


def sounding(run):
    """Pitch of the last 0.3 s (Hz)."""
    return pitch_of(run["bridge_force"][-round(0.3 * RATE) :], RATE)


def penetration(run):
    """eta of the first finger on both strings, read from the grid at the end of a run (m)."""
    s, now = run.state[0], int(run.state["motion"]["level"][0])
    eta = []
    for i in range(layout.STRINGS):
        at = layout.GHOST + int(s["contacts"]["first"][i])
        u = s["motion"]["u"][now, i, at : at + layout.STENCIL]
        eta.append(float(s["contacts"]["weights"][i] @ u))
    return np.array(eta) - float(s["motion"]["U"][now, 0])


# --- pressing -----------------------------------------------------------------------------


def test_two_strings_at_rest_carry_the_whole_press():
    for press in (0.3, 1.0, 3.0):
        run = play(lambda t, press=press: {"press": [press * np.minimum(1.0, t / 0.05)]}, 2.0)
        forces = run.finger(0)[-1, 1:]
        assert forces.sum() == pytest.approx(press, rel=1e-6)
        # ... each as the contact law has it, eqs. (4) and (5) without motion.
        law = FINGER.K_f * penetration(run) ** FINGER.alpha
        assert forces == pytest.approx(law, rel=1e-4)


@pytest.mark.parametrize("x_f", [0.05, 0.10, 0.15])
@pytest.mark.parametrize("string", [0, 1], ids=["F4", "C5"])
def test_a_pressed_finger_stops_the_string(string, x_f):
    """Near c/2(x_c - x_f), a little sharp: 5 to 100 cents, to be calibrated."""
    sign = 1.0 if string == 0 else -1.0
    x_c = YEHU.bridge_x

    x_b = x_c - 0.13 * (x_c - x_f)
    run = play(lambda t: {**bowed(t, x_b, sign), "x_f": [x_f], "press": [3.0]}, 0.8, ledger=False)
    ideal = wave_speed(YEHU.strings[string]) / (2.0 * (x_c - x_f))
    assert 5.0 < cents(sounding(run), ideal) < 100.0


# --- leaving ------------------------------------------------------------------------------


def released(press, rate):
    """Height above rest (m) after a press of 0.2 s, and the contact forces."""
    run = play(lambda t: {"press": [np.where(t < 0.2, press, 0.0)]}, 0.4, rate, ledger=False)
    after = run.finger(0)[round(0.2 * rate) :]
    return after[:, 0] - FINGER.rest_height, after[:, 1:]


@pytest.mark.parametrize("rate", [22050.0, 44100.0, 96000.0])
def test_a_lifted_finger_is_back_at_rest_within_40_ms_and_stays(rate):
    for press, within_s in ((0.3, 0.04), (0.5, 0.04), (1.0, 0.04), (5.0, 0.06)):
        # After ten times what is played the contact pulls it for 30 ms.
        height, forces = released(press, rate)
        later = round(within_s * rate)
        assert np.abs(height[later:]).max() < 0.02 * FINGER.rest_height
        assert not forces[later:].any()
        assert np.diff(height[:later]).min() > 0.0 or press == 5.0
        assert height.max() < 1e-9


def test_a_finger_that_has_come_to_rest_is_as_if_it_were_worked_out_each_time():
    """Bit for bit: pressed, lifted, at rest, hit there by a plucked string, and pressed again."""
    rate = 22050.0
    model = kernel.prepare(YEHU, rate, 2)
    t = np.arange(round(0.45 * rate)) / rate
    table = rows(
        len(t), 2, {"press": [np.where((t < 0.03) | (t > 0.4), 1.0, 0.0), 0.0], "x_f": [0.1, 0.012]}
    )
    table[:, layout.F_PLUCK] = np.where((t > 0.3) & (t < 0.33), 25.0, 0.0)
    table[:, layout.X_PLUCK] = 0.1
    found = []
    for is_reminded in (False, True):
        state = kernel.at_rest(model)
        probes = np.zeros((len(t), layout.probe_columns(2)))
        was_still = np.zeros((len(t), 2), bool)
        for n in range(len(t)):
            if is_reminded:
                state["motion"]["resting"] = 0
            part = slice(n, n + 1)
            time_loop.run(model, state, None, table[part], probes[part])
            was_still[n] = state["motion"]["resting"][0, :2]
        found.append((probes, was_still))
    (probes, was_still), (again, _) = found
    hit = np.abs(probes[:, layout.FINGER_PROBES + 1]) > 0.0
    assert was_still[(t > 0.27) & (t < 0.3), 0].all()
    assert (hit & (t > 0.3) & (t < 0.4)).any()
    assert not was_still[hit, 0].any()
    assert was_still[:, 1].any()
    assert np.array_equal(probes, again)


# --- the contact law ----------------------------------------------------------------------
