"""The bridge: eleven measured modes, struck, and tied to both strings."""

import json
import math
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics.bridge import advance_bridge
from yehu_server.core.physics.default_quantities import Quantities

YEHU = Quantities()
MODES = json.loads(files("yehu_server.core.physics").joinpath("body.json").read_text())[
    "bridge_modes"
]
M = np.array([mode["mass_kg"] for mode in MODES])
R = np.array([mode["damping_kg_per_s"] for mode in MODES])
OMEGA = 2.0 * np.pi * np.array([mode["frequency_hz"] for mode in MODES])

STRIKE = 1.2e-3  # s
PEAK = 10.0  # N


def hammer(time):
    """A half sine, as long as a hard hammer's tip touches."""
    return np.where(time < STRIKE, PEAK * np.sin(np.pi * time / STRIKE), 0.0)


def struck(model, frames):
    """The modes alone, struck by the hammer: q [shape=(frames + 1, modes)]; rest first."""
    q = np.zeros((frames + 2, layout.MAX_MODES))
    for n in range(frames):
        advance_bridge(model[0], q[n + 2], q[n + 1], q[n], hammer(n * model[0]["k"]))
    return q[1:, : len(M)]


def ode_responses(time):
    """Closed form of M q'' + R q' + M omega^2 q = hammer(t) from rest [shape=(times, modes)].

    Convolution of the force with exp(lambda t) by hand: both are exponentials.
    """
    pole = -R / (2.0 * M) + 1j * np.sqrt(OMEGA**2 - (R / (2.0 * M)) ** 2)
    turn = 1j * np.pi / STRIKE
    t = time[:, np.newaxis]
    upper = np.minimum(t, STRIKE)

    def convolved(sign):
        """Integral over tau from 0 to upper of exp(sign turn tau) exp(pole (t - tau))."""
        rate = sign * turn - pole
        return np.exp(pole * t) * (np.exp(rate * upper) - 1.0) / rate

    forced = PEAK * (convolved(1) - convolved(-1)) / 2j
    return (forced / (M * pole.imag)).imag


def test_each_mode_rings_at_its_measured_frequency():
    """Without damping and force, exactly: the stiffness is pre-warped."""
    for rate in (22050.0, 44100.0, 96000.0):
        body = replace(YEHU.body, damping=(0.0,) * len(M))
        model = kernel.prepare(replace(YEHU, body=body), rate)
        q = np.zeros((702, layout.MAX_MODES))
        q[:2] = 1e-6
        for n in range(700):
            advance_bridge(model[0], q[n + 2], q[n + 1], q[n], 0.0)
        for m, y in enumerate(q[:, : len(M)].T):
            twice_cos = (y[1:-1] @ (y[2:] + y[:-2])) / (y[1:-1] @ y[1:-1])
            frequency_hz = math.acos(twice_cos / 2.0) * rate / (2.0 * math.pi)
            assert frequency_hz == pytest.approx(MODES[m]["frequency_hz"], rel=1e-9)


@pytest.mark.parametrize("rate", [44100.0, 176400.0])
def test_a_hammer_moves_the_bridge_as_eleven_oscillators_do(rate):
    """Against the closed form, to second order in the step.

    Pre-warping holds a mode's frequency and stiffens it by (omega k)^2/6, 3 % of the
    highest mode at 44.1 kHz; the slow modes, which carry the sum, leave 0.1 %.
    """
    frames = round(0.05 * rate)
    expected = ode_responses(np.arange(frames + 1) / rate)
    simulated = struck(kernel.prepare(YEHU, rate), frames)
    error = np.abs(simulated - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert np.all(error < (OMEGA / rate) ** 2 / 5.0)
    expected, simulated = expected.sum(axis=1), simulated.sum(axis=1)
    tolerance = 1e-3 * (44100.0 / rate) ** 2
    assert np.abs(simulated - expected).max() < tolerance * np.abs(expected).max()


def test_felt_quiets_the_strings_behind_the_bridge():
    """There each is a string of its own; how long it rings, and what is left with felt."""
    levels = {}
    for felt in (0.0, YEHU.felt_loss):
        run = play(
            lambda t: {"hammer": hammer(t)},
            0.3,
            quantities=replace(YEHU, felt_loss=felt),
            ledger=False,
        )
        late = run["bridge_force"][-4410:] * np.hanning(4410)
        spectrum = np.abs(np.fft.rfft(late, 1 << 16))
        for i, string in enumerate(YEHU.strings):
            hz = math.sqrt(string.T / string.rho_A) / (2.0 * (string.L - YEHU.bridge_x))
            near = slice(*(round(hz * part * (1 << 16) / 44100.0) for part in (0.98, 1.05)))
            levels[felt, i] = 20.0 * math.log10(spectrum[near].max())
    for i in range(layout.STRINGS):
        assert levels[0.0, i] - levels[YEHU.felt_loss, i] > 40.0
