"""The hair's texture: where it is felt, and that it only changes friction."""

from dataclasses import replace

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.rosin_texture import texture

YEHU = Quantities()
BOWED = {"F_N": 0.5, "v_b": 0.2, "x_f": [0.1], "press": [1.5]}
DEPTH = 0.05


class Memory:
    """What `texture` keeps, in plain Python."""

    grain = 0

    def __init__(self):
        self.rough = np.zeros(2)


def the_texture(places, hair=0):
    memory = Memory()
    return np.array([texture.py_func(memory, place, hair) for place in places])


def bowed(v_b=0.2, depth=DEPTH, start=0.0, seconds=0.5, rate=44100.0, quantities=YEHU):
    def curves(time):
        rise = np.minimum(1.0, time / 0.04)
        v = v_b * rise
        y = start + np.cumsum(v) / rate
        return {**BOWED, "F_N": 0.5 * rise, "v_b": v, "y_b": y, "texture": depth}

    return play(curves, seconds, rate, quantities=quantities)


def test_the_texture_is_a_smooth_function_of_the_place():
    places = np.linspace(-40.0, 40.0, 80001)
    values = the_texture(places)
    assert np.abs(values).max() <= 1.0
    assert np.abs(np.diff(values)).max() <= 1.5 * 2.0 * (places[1] - places[0])
    np.testing.assert_array_equal(the_texture(places[::-1])[::-1], values)


def test_the_texture_is_no_longer_alike_one_grain_further():
    places = np.arange(0.0, 4000.0, 0.1)
    values = the_texture(places)
    assert abs(values.mean()) < 0.03
    assert np.corrcoef(values[:-20], values[20:])[0, 1] == pytest.approx(0.0, abs=0.05)
    assert np.corrcoef(values[:-2], values[2:])[0, 1] > 0.8


def test_the_string_stays_on_the_same_hair_while_it_sticks():
    # A heavy bow carries the string along for 4 ms, 0.4 mm: four grains of the bow, none of which
    # passes the string.
    fine = replace(YEHU, bow=replace(YEHU.bow, grain=1e-4))

    def grain(force):
        curves = {"F_N": force, "v_b": 0.1, "texture": 0.02}
        run = play(lambda time: {**curves, "y_b": 5e-5 + 0.1 * time}, 0.004, quantities=fine)
        return int(run.state[0]["motion"]["grain"]) - 1, run

    stuck, run = grain(4.0)
    assert abs(run["v_r"].mean()) < 0.01  # of 0.1 m/s: it sticks
    assert abs(stuck) <= 1
    assert grain(0.01)[0] == 4  # a light one slips


def test_the_noise_runs_as_fast_as_the_bow():
    # Under a bow too light to catch the string, friction is mu_C F_N times the texture's factor.
    coarse = replace(YEHU, bow=replace(YEHU.bow, grain=1e-3))

    def centroid_hz(v_b):
        curves = {"F_N": 0.01, "v_b": v_b, "texture": 0.1}
        run = play(lambda time: {**curves, "y_b": v_b * time}, 1.0, quantities=coarse)
        noise = run["f_b"][4410:]
        noise = noise - noise.mean()
        power = np.abs(np.fft.rfft(noise * np.hanning(len(noise)))) ** 2
        return (np.fft.rfftfreq(len(noise), 1.0 / run.rate) * power).sum() / power.sum()

    assert centroid_hz(1.6) == pytest.approx(2.0 * centroid_hz(0.8), rel=0.1)


def test_friction_loses_energy_and_the_ledger_closes():
    run = bowed(depth=0.3, rate=48000.0)
    assert np.abs(run["energy_error"]).max() < 2e-9 * run.power
    assert run["loss_friction"].min() > -1e-12 * run.power
