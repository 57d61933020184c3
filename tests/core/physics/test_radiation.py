"""From bridge force to sound: 25 measured sections, at any sample rate."""

import json
from importlib.resources import files

import numpy as np
import pytest

from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.radiation import radiate

RADIATION = json.loads(files("yehu_server.core.physics").joinpath("body.json").read_text())[
    "radiation"
]
MEASURED_RATE = 44100.0
COEFFICIENTS = ("b_0", "b_1", "a_1", "a_2")
RATES = [22050, 23400, 25550, 32000, 34200, 37600, 48000, 64000, 88200, 96000, 176400, 192000]


def measured_response(frequency_hz):
    """The published filter, Pa/N: its sections one by one, as `section_form` says."""
    delay = np.exp(-2j * np.pi * frequency_hz / MEASURED_RATE)
    total = np.full(len(frequency_hz), RADIATION["direct_gain"], complex)
    for b_0, b_1, a_1, a_2 in RADIATION["sections"]:
        total += (b_0 + b_1 * delay) / (1.0 + a_1 * delay + a_2 * delay**2)
    return total


def response(model, rate, frequency_hz):
    """That of the coefficients which were prepared for another rate."""
    delay = np.exp(-2j * np.pi * frequency_hz / rate)
    total = np.polyval(model["taps"][::-1], delay)
    for b_0, b_1, a_1, a_2 in zip(*(model[name] for name in COEFFICIENTS), strict=True):
        total += (b_0 + b_1 * delay) / (1.0 + a_1 * delay + a_2 * delay**2)
    return total


def impulse_response(model, frames):
    """Pressure after a bridge force of 1 N for one sample, by the run-time filter."""
    state = kernel.at_rest(model)
    model, motion = model[0], state[0]["motion"]
    return np.array([radiate(model, motion, 1.0 if n == 0 else 0.0) for n in range(frames)])


def test_at_the_measured_rate_the_filter_is_the_measured_one():
    model = kernel.prepare(Quantities(), MEASURED_RATE)[0]
    sections = np.array(RADIATION["sections"])
    n = len(sections)
    for column, name in enumerate(COEFFICIENTS):
        assert np.array_equal(model[name][:n], sections[:, column])
        assert not model[name][n:].any()
    assert model["taps"][0] == RADIATION["direct_gain"]
    assert not model["taps"][1:].any()


@pytest.mark.parametrize("rate", [MEASURED_RATE, 192000.0])
def test_the_running_filter_rings_as_its_formula(rate):
    """Impulse response of each section by its own recursion, summed, plus the direct taps."""
    frames = 1000
    model = kernel.prepare(Quantities(), rate)
    expected = np.zeros(frames)
    expected[: layout.MAX_TAPS] = model["taps"][0]
    for b_0, b_1, a_1, a_2 in zip(*(model[name][0] for name in COEFFICIENTS), strict=True):
        y = np.zeros(frames + 2)  # two samples of silence first
        for n in range(frames):
            x, x_before = float(n == 0), float(n == 1)
            y[n + 2] = b_0 * x + b_1 * x_before - a_1 * y[n + 1] - a_2 * y[n]
        expected += y[2:]
    impulse = impulse_response(model, frames)
    assert np.abs(impulse - expected).max() < 3e-13 * np.abs(expected).max()


def test_every_rate_sounds_like_the_measured_body_and_none_shouts_where_nobody_measured(everything):
    """Beyond 22.05 kHz: against the measured response there."""
    for rate in RATES if everything else RATES[::3]:
        frequency_hz = np.linspace(0.0, rate / 2.0, 2_000)
        known = np.minimum(frequency_hz, MEASURED_RATE / 2.0)
        model = kernel.prepare(Quantities(), rate)[0]
        gain = np.abs(response(model, rate, frequency_hz) / measured_response(known))
        gain_db = 20.0 * np.log10(gain)
        heard = (frequency_hz >= 100.0) & (frequency_hz <= min(16e3, 0.45 * rate))
        assert np.abs(gain_db[heard]).max() < 0.5, rate
        assert gain_db[frequency_hz > min(16e3, 0.45 * rate)].max() < 6.0, rate
        for a_1, a_2 in zip(model["a_1"], model["a_2"], strict=True):
            assert np.abs(np.roots([1.0, a_1, a_2])).max() < 1.0, rate
