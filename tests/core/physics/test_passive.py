"""Passivity: no part of the model gives energy, whatever the instrument, the rate and the playing.

A balance that closes does not say so: friction that is solved wrongly may give, and still close.
"""

from dataclasses import replace

import numpy as np
import pytest
from core.physics.runs import play
from core.physics.test_energy import balanced
from core.physics.test_hair_width import of_modes

from yehu_server.core.physics import layout
from yehu_server.core.physics.default_quantities import Quantities, override

YEHU = Quantities()
INSTRUMENTS, SECONDS = 200, 0.15


def law(bow, xi, F_N, v_r, z_bar):
    """dz/dt of [Yehu] eqs. (16)-(20), and epsilon_1 of (25)."""
    z_ba = xi * bow.mu_C * F_N / bow.epsilon_0
    stribeck = (bow.mu_S - bow.mu_C) * np.exp(-((v_r / bow.v_s) ** 2))
    z_ss = np.sign(v_r) * F_N / bow.epsilon_0 * (bow.mu_C + stribeck)
    size = abs(z_bar)
    if np.sign(z_bar) != np.sign(v_r) or size <= z_ba:
        chi = 0.0
    elif size >= abs(z_ss):
        chi = 1.0
    else:
        middle = (size - 0.5 * (abs(z_ss) + z_ba)) / (abs(z_ss) - z_ba)
        chi = 0.5 * (1.0 + np.sin(np.pi * middle))
    epsilon_1 = bow.epsilon_1 / np.hypot(1.0, bow.epsilon_1 * v_r / (bow.mu_C * F_N))
    return v_r * (1.0 - chi * z_bar / z_ss), epsilon_1


@pytest.mark.parametrize(
    ("string", "points", "bow"),
    [
        (1, 2, {"epsilon_0": 3.186e5}),  # [Matusiak]'s, under hair of 8 mm
        (1, 4, {"epsilon_0": 3.186e5}),
        (0, 3, {"epsilon_0": 1e6, "width": 0.002}),
        (0, 2, {"epsilon_1": 0.24}),
    ],
)
def test_every_strip_of_wide_hair_obeys_the_law_where_friction_falls_steeply(string, points, bow):
    quantities = override(YEHU, {"bow": {"width": 0.008, "points": points} | bow})
    own, force = quantities.bow, -2.5 if string else 1.5

    def curves(t):
        return {
            "F_N": force * np.minimum(t / 0.02, 1.0),
            "v_b": 0.3 * np.minimum(t / 0.03, 1.0),
            "x_b": np.full(len(t), 0.25),
            "x_f": [np.full(len(t), 0.08)],
            "press": [np.full(len(t), 1.5)],
        }

    for seconds in (0.3, *np.arange(0.1, 0.11, 0.0014)):
        run = play(curves, seconds, quantities=quantities)
        balanced(run)
        for e in range(points):
            found = {name: float(run.refined[name][0, e]) for name in ("v_r", "f_b", "z_bar", "r")}
            r, epsilon_1 = law(own, own.xi[string], abs(run.controls[-1, layout.F_N]),
                               found["v_r"], found["z_bar"])  # fmt: skip
            assert found["r"] == pytest.approx(r, abs=1e-9)
            f_b = own.epsilon_0 * found["z_bar"] + epsilon_1 * found["r"]
            assert found["f_b"] == pytest.approx(f_b, abs=1e-9)


def any_instrument(chance):
    """An instrument with any options, and its number of fingers."""
    wide = {"width": chance.uniform(1e-3, 0.03), "points": int(chance.integers(2, 5))}
    friction = chance.choice(["elasto-plastic", "elasto-plastic", "thermal", "hyperbolic"])
    bow = {
        "epsilon_0": 10.0 ** chance.uniform(4.0, 5.7),
        "epsilon_1": 10.0 ** chance.uniform(-3.0, -0.5),
        "friction": str(friction),
        "epsilon_2": float(chance.choice([0.0, chance.uniform(0.0, 1.0)])),
        "xi": chance.uniform(0.2, 0.9, 2).tolist(),
        "hair": int(chance.integers(100)),
    }
    if friction != "hyperbolic" and chance.random() < 0.6:
        bow |= wide
    strings = {
        f"string_{i + 1}": {
            "T": own.T * chance.uniform(0.7, 1.3),
            "r": own.r * chance.uniform(0.8, 1.2),
            "G": own.G * chance.uniform(0.5, 1.0),
        }
        for i, own in enumerate(YEHU.strings)
    }
    changed = {
        "bow": bow,
        "torsion": str(chance.choice(["off", "on"])),
        "tension_modulation": chance.uniform(0.0, 1.0),
        "felt_loss": chance.uniform(0.0, 1e3),
        "finger": {"beta": chance.uniform(0.0, 40.0), "M_f": chance.uniform(0.005, 0.05)},
    }
    body = of_modes(int(chance.integers(1, layout.MAX_MODES + 1)), int(chance.integers(1000)))
    return replace(override(YEHU, strings | changed), body=body), int(chance.integers(1, 5))


def any_playing(chance, fingers):
    """Curves that wander, or jump, by chance."""

    def curve(t, low, high):
        count = int(chance.integers(2, 9))
        values = chance.uniform(low, high, count)
        at = t / t[-1] * (count - 1)
        return values[at.astype(int)] if chance.random() < 0.3 else np.interp(
            at, np.arange(count), values
        )  # fmt: skip

    def curves(t):
        return {
            "F_N": curve(t, -2.5, 2.5),
            "v_b": curve(t, -0.6, 0.6),
            "x_b": curve(t, 0.18, 0.295),
            "y_b": np.cumsum(np.full(len(t), 0.3 * t[1])),
            "texture": np.full(len(t), chance.choice([0.0, 0.5])),
            "pluck": np.where(t < 0.02, chance.uniform(-2.0, 2.0), 0.0),
            "x_pluck": np.full(len(t), 0.2),
            "x_f": [curve(t, 0.02, 0.29) for _ in range(fingers)],
            "press": [np.maximum(curve(t, -2.0, 5.0), 0.0) for _ in range(fingers)],
        }

    return curves


def in_two_directions(quantities, chance):
    """The instrument with strings that move in two directions, on any bridge, under any skin."""
    bow = {  # heavier on softer hair it sinks by centimetres, and their rounding shows at 175 kHz
        "M_n": 10.0 ** chance.uniform(-2.5, -1.0),
        "K_n": 10.0 ** chance.uniform(4.0, 5.0),
        "alpha_n": chance.uniform(1.1, 2.5),
        "beta_n": chance.choice([0.0, chance.uniform(0.0, 20.0)]),
    }
    finger = {
        "K_s": 10.0 ** chance.uniform(1.0, 4.0),
        "R_s": chance.choice([0.0, 10.0 ** chance.uniform(-1.0, 2.0)]),
        "mu_s": 10.0 ** chance.uniform(-1.5, 0.7),
    }
    changes = {"rocking": chance.uniform(-2.0, 2.0), "bounce": chance.uniform(0.0, 2.0)}
    return override(quantities, {"directions": "two", "bow": bow, "finger": finger} | changes)


@pytest.mark.parametrize("strings", ["in one direction", "in two", "modal"])
@pytest.mark.parametrize(
    "seeds", [range(3, 5), pytest.param(range(5, INSTRUMENTS + 3), marks=pytest.mark.slow)]
)
def test_no_part_of_any_instrument_gives_energy(seeds, strings):
    failed = {}
    for seed in seeds:
        chance = np.random.default_rng(seed)
        rate = float(np.exp(chance.uniform(np.log(22050.0), np.log(192000.0))))
        quantities, fingers = any_instrument(chance)
        if strings == "in two":
            quantities = in_two_directions(quantities, chance)
        elif strings == "modal":
            quantities = override(quantities, {"scheme": "modal"})
        playing = any_playing(chance, fingers)
        run = play(playing, SECONDS, rate, fingers=fingers, quantities=quantities)
        try:
            balanced(run)
            if strings == "in one direction":
                assert run["power_in"].max() > 1e-3
        except AssertionError as error:
            failed[seed] = str(error)
    assert failed == {}
