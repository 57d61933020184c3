"""Modal strings: closed forms, symmetry, and equations as residuals by operators of this file."""

import numpy as np
import pytest
from core.physics.runs import play
from pitch import cents

from yehu_server.api.simulated import simulate
from yehu_server.core.physics import kernel, layout, planes, refined, time_loop
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.errors import ParameterError
from yehu_server.scores.gesture import Pluck
from yehu_server.simulation.run import pull

YEHU = Quantities()
MODAL = override(YEHU, {"scheme": "modal"})
BARE = {"felt_loss": 0.0, "tension_modulation": 0.0}
RATE, PARTIALS = 44100.0, 12
both_strings = pytest.mark.parametrize("i", [0, 1], ids=["F4", "C5"])


def stiff_string(quantities, i):
    """c^2 and kappa^2 of string `i`."""
    string = quantities.strings[i]
    return string.T / string.rho_A, string.EI / string.rho_A


def on_three_supports(quantities, i, guess):
    """The frequency (Hz) next to a guess at which a stiff string on three supports vibrates.

    Between supports u = sin(b x)/sin(b l) - sinh(d x)/sinh(d l), whose curvature at the middle
    support is that of the other side for any l; and so is the slope where `turn` vanishes.
    """
    c2, kappa2 = stiff_string(quantities, i)
    spans = quantities.bridge_x, quantities.strings[i].L - quantities.bridge_x

    def turn(f):
        w = 2.0 * np.pi * f
        b = np.sqrt((np.sqrt(c2 * c2 + 4.0 * kappa2 * w * w) - c2) / (2.0 * kappa2))
        d = np.sqrt(b * b + c2 / kappa2)
        return sum(b / np.tan(b * l) - d / np.tanh(d * l) for l in spans)

    f = guess * np.linspace(0.97, 1.03, 20001)
    y = turn(f)
    falls = np.flatnonzero((y[:-1] > 0.0) & (y[1:] <= 0.0))
    return f[falls[np.abs(f[falls] - guess).argmin()]]


def peak(signal, rate, f):
    """Frequency (Hz) of the highest peak within 50 cents, by a parabola through its logarithm."""
    spectrum = np.abs(np.fft.rfft(signal * np.hanning(len(signal)), 8 * len(signal)))
    hertz = np.fft.rfftfreq(8 * len(signal), 1.0 / rate)
    at = np.where(np.abs(hertz / f - 1.0) < 0.03, spectrum, 0.0).argmax()
    left, top, right = np.log(spectrum[at - 1 : at + 2])
    return (at + 0.5 * (left - right) / (left - 2.0 * top + right)) * hertz[1]


@both_strings
def test_partials_of_a_string_over_a_rigid_bridge_are_those_of_three_supports(i):
    """Up to the twelfth within a cent at 44.1 kHz, where the grid's is 20 and 38 off."""
    body = YEHU.body
    rigid = type(body)((100.0,), (1e9,), (0.0,), body.radiation_rate, body.sections, 0.0)
    quiet = {f"string_{i + 1}": {"sigma_0": 0.02, "sigma_1": 1e-6}}
    quantities = override(MODAL, BARE | quiet)
    quantities = type(quantities)(**{**vars(quantities), "body": rigid})
    model, more = kernel.prepare(quantities, RATE), planes.prepare(quantities, RATE)
    state = kernel.at_rest(model)
    pull(model, state, more, Pluck(i + 1, 0.013, 1e-4))
    frames = round(RATE)
    controls = np.zeros((frames, layout.control_columns(1)))
    controls[:, layout.X_B], controls[:, layout.FINGER_CONTROLS] = 0.255, quantities.bridge_x
    probes = np.zeros((frames, layout.probe_columns(1)))
    time_loop.run(model, state, more, controls, probes)
    c2, kappa2 = stiff_string(quantities, i)
    b = np.pi * np.arange(1, PARTIALS + 1) / quantities.bridge_x
    guesses = np.sqrt(c2 * b**2 + kappa2 * b**4) / (2.0 * np.pi)
    expected = np.array([on_three_supports(quantities, i, f) for f in guesses])
    found = np.array([peak(probes[:, layout.BRIDGE_FORCE_1 + i], RATE, f) for f in expected])
    assert np.abs(cents(found, expected)).max() < 1.0


def test_every_partial_is_driven_by_the_forces_at_their_places():
    """Newton's law of each amplitude, at sample after sample, with bow and finger on."""
    quantities = override(MODAL, BARE)

    def curves(t):
        return {"F_N": -0.8 * np.minimum(t / 0.02, 1.0), "v_b": 0.3, "press": [2.0], "x_f": [0.08]}

    run = play(curves, 0.12, quantities=quantities)
    more, k, seen = run.refined, 1.0 / RATE, []
    one = run.controls[-1:].copy()
    for _ in range(100):
        probes, book = np.zeros((1, run.probes.shape[1])), np.zeros((1, len(layout.LEDGER)))
        time_loop.run(run.model, run.state, more, one, probes, book)
        level = int(run.state["motion"]["level"][0])
        for i, string in enumerate(quantities.strings):
            count = int((more["C_s"][0, i] > 0.0).sum())
            b = np.pi * np.arange(1, count + 1) / string.L
            K = 0.5 * string.L * (string.T * b**2 + string.EI * b**4)
            sigma = string.sigma_0 + string.sigma_1 * b**2
            w = np.sqrt(K / (0.5 * string.rho_A * string.L) - sigma**2)
            M = K * k**2 / (2.0 - 2.0 * np.cos(w * k) / np.cosh(sigma * k))
            R = 2.0 * M * np.tanh(sigma * k) / k
            a_next, a, a_prev = (more["a"][0, (level - n) % 3, i, :count] for n in range(3))
            force = M * (a_next - 2.0 * a + a_prev) / k**2 + R * (a_next - a_prev) / (2 * k) + K * a
            places = (0.08, 0.255, quantities.bridge_x)
            friction = float(probes[0, layout.FRICTION_FORCE]) if i == 1 else 0.0
            forces = np.array(
                [
                    -probes[0, layout.FINGER_PROBES + 1 + i],
                    -friction,
                    probes[0, layout.BRIDGE_FORCE_1 + i],
                ]
            )
            expected = np.sin(np.outer(b, places)) @ forces
            np.testing.assert_allclose(force, expected, atol=1e-8)
            seen.append(np.abs(forces))
    assert np.max(seen, axis=0).min() > 0.05


def test_the_bow_drawn_the_other_way_makes_the_mirrored_motion_to_the_last_bit():
    def bowed(sign):
        return play(
            lambda t: {"F_N": 0.7, "v_b": sign * 0.2 * np.minimum(t / 0.03, 1.0), "x_f": [0.3]},
            0.15,
            quantities=MODAL,
        )

    there, back = bowed(1.0), bowed(-1.0)
    assert np.abs(there["f_b"]).max() > 0.3
    np.testing.assert_array_equal(there["f_b"], -back["f_b"])
    np.testing.assert_array_equal(there.refined["a"], -back.refined["a"])


def test_a_plucked_note_is_that_of_a_fine_grid():
    """Under a finger and on the whole body, below 3 kHz: nearer than the grid at 44.1 kHz."""

    def sounded(scheme, rate):
        controls = {"finger_position": 0.1, "press_force": 2.0, "pluck_position": 0.22}
        controls["pluck_force"] = [[0.1, 0.0], [0.15, 1.0], [0.1501, 0.0]]
        gesture = {"sample_rate": rate, "duration": 0.2, "instrument": {"scheme": scheme}}
        force = simulate({**gesture, "controls": controls}).arrays["bridge_force_1"]
        return np.fft.rfft(force[round(0.15 * rate) :])[: round(3000 * 0.05)] / rate

    fine = sounded("explicit", 16 * RATE)
    off = {scheme: np.abs(sounded(scheme, RATE) - fine) for scheme in ("explicit", "modal")}
    size = {scheme: np.linalg.norm(each) / np.linalg.norm(fine) for scheme, each in off.items()}
    assert size["modal"] < 0.03
    assert size["modal"] < 0.5 * size["explicit"]


def test_a_string_is_let_go_from_a_triangle_with_the_bridge_at_rest():
    gesture = {
        "duration": 0.01,
        "instrument": {"scheme": "modal"},
        "pluck": {"string": 2, "position": 0.1, "amplitude": 1e-3},
    }
    run = simulate(gesture, energy=True, strings_every=100)
    shape, x = run.arrays["string_2"][0], run.arrays["x_2"]
    expected = 1e-3 * np.interp(x, [0.0, 0.1, 0.3, 0.38], [0.0, 1.0, 0.0, 0.0])
    np.testing.assert_allclose(shape, expected, atol=2e-5)
    assert not run.arrays["string_1"][0].any()
    assert run.arrays["constraint_residual"].max() < 1e-15
    assert run.meta["friction_bound"] > 0.0


def test_only_studies_have_modal_strings():
    with pytest.raises(ParameterError, match="scheme: strings are modal only for simulate and sw"):
        refined.prepare(MODAL, RATE)
    with pytest.raises(ParameterError, match='modal strings move in one direction, not "two"'):
        planes.prepare(override(MODAL, {"directions": "two"}), RATE)
    with pytest.raises(ParameterError, match="string_1: its losses leave modal strings no freq"):
        planes.prepare(override(MODAL, {"string_1": {"sigma_1": 1.0}}), RATE)
