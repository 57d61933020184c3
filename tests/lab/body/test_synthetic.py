"""Taps that are made of a body: what a hammer and its sensors would give."""

import numpy as np
import pytest
import scipy
from lab.body.bodies import DAMPING, HZ, MASS, radiation, rms

from yehu_server.core.physics.quantities import measured_body
from yehu_server.lab.body import made_taps
from yehu_server.lab.body.synthetic import velocity

RATE = 352_800.0
NEWTONS, CONTACT_S = 15.0, 106.0 / RATE


def test_the_closed_form_is_the_motion_of_masses_on_springs():
    """Stepped by the matrix exponential, with the force as two more states: exact, too."""
    rate, steps = RATE, 3000
    turn = np.pi / CONTACT_S
    size = 2 * len(HZ)
    A = np.zeros((size + 2, size + 2))
    for i, (hz, mass, damping) in enumerate(zip(HZ, MASS, DAMPING, strict=True)):
        A[2 * i, 2 * i + 1] = 1.0
        A[2 * i + 1, 2 * i] = -((2.0 * np.pi * hz) ** 2)
        A[2 * i + 1, 2 * i + 1] = -damping / mass
        A[2 * i + 1, size] = NEWTONS / mass  # times sin
    A[size, size + 1], A[size + 1, size] = turn, -turn  # sin and cos
    step = scipy.linalg.expm(A / rate)
    state = np.zeros(size + 2)
    state[size + 1] = 1.0
    free = scipy.linalg.expm(A[:size, :size] / rate)
    ends = round(CONTACT_S * rate)
    expected = []
    for n in range(steps):
        expected.append(state[1:size:2].sum())
        if n < ends:
            state = step @ state
        else:
            state[:size] = free @ state[:size]
    time = np.arange(steps) / rate
    found = velocity(measured_body(), time, NEWTONS, CONTACT_S)
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


def test_pressure_is_the_force_radiated():
    (tap,) = made_taps(count=1, noise_db=200.0)
    hz = np.fft.rfftfreq(len(tap.force), 1.0 / tap.rate)
    band = (hz > 200.0) & (hz < 5000.0)
    ratio = np.fft.rfft(tap.pressure)[band] / np.fft.rfft(tap.force)[band]
    assert np.abs(ratio / radiation(hz[band]) - 1.0).max() < 0.01


def test_noise_is_as_far_below_as_asked():
    (clean,) = made_taps(count=1, noise_db=300.0)
    for noise_db in (20.0, 60.0):
        (noisy,) = made_taps(count=1, noise_db=noise_db)
        noise = noisy.velocity - clean.velocity
        assert 20.0 * np.log10(rms(clean.velocity) / rms(noise)) == pytest.approx(noise_db, abs=0.2)


def test_the_same_seed_gives_the_same_taps():
    one, other, another = (made_taps(count=2, seed=seed)[1] for seed in (4, 4, 5))
    assert np.array_equal(one.velocity, other.velocity)
    assert not np.array_equal(one.velocity, another.velocity)
