"""Tension modulation: the tension that a stretched string gains.

The energy balance and the single step are held with it in test_energy.py and
test_reference_step.py.
"""

from dataclasses import replace

import numpy as np
import pytest
from core.physics.runs import bump, play, shaped

from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics.quantities import Quantities

YEHU = Quantities()
RATE = 44100.0


@pytest.mark.parametrize("press", [0.5, 1.0, 3.0])
def test_a_pressed_string_is_tighter_by_its_stretch(press):
    """T' = EA/(2 L) int u_x^2 dx once all is at rest."""
    run = play({"press": [press], "x_f": [0.1]}, 1.5, ledger=False)
    state, model = run.state[0], run.model[0]
    for i, string in enumerate(YEHU.strings):
        N = int(model["N"][i])
        u = state["motion"]["u"][
            int(state["motion"]["level"]), i, layout.GHOST : layout.GHOST + N + 1
        ]
        stretch = np.sum(np.diff(u) ** 2) / model["h"][i]
        expected = string.EA / (2.0 * string.L) * stretch
        assert expected > 0.0
        T_more = state["work"]["tau"][i] * model["h"][i] / model["spread"][i]
        assert T_more == pytest.approx(expected, rel=1e-3)


def test_without_it_nothing_of_it_is_left():
    plain = replace(YEHU, tension_modulation=0.0)
    run = play({"press": [3.0], "x_f": [0.1]}, 0.2, ledger=False, quantities=plain)
    for name in ("tau", "K_tt"):
        assert not run.state["work"][name].any(), name


def test_a_wide_vibration_is_sharper_than_a_narrow_one():
    """By half of T'/T: the mean of T' over a vibration of the first mode, in pitch."""
    model = kernel.prepare(YEHU, RATE)

    def first_period_s(amplitude):
        run = play({}, 0.02, state=shaped(model, 1, bump(0.15, 0.3, amplitude)), ledger=False)
        force = run.probes[:, layout.BRIDGE_FORCE_2]
        spectrum = np.fft.rfft(force * np.hanning(len(force)), 1 << 17)
        low, high = (round(f * (1 << 17) / RATE) for f in (400.0, 650.0))
        return 1.0 / (low + np.argmax(np.abs(spectrum[low:high])))

    assert first_period_s(2e-3) < first_period_s(2e-5)
