"""Poles of sections: stable, and where the response has them."""

import numpy as np
import pytest

from yehu_server.lab.body.sections import Lines, moved, numerators, usable

RATE = 44100.0


def test_poles_outside_the_circle_are_mirrored_into_it():
    """They keep their frequency, and ring as long as they grew."""
    outside = np.array([1.05 * np.exp(0.3j), 1.05 * np.exp(-0.3j), 0.9 * np.exp(1j),
                        0.9 * np.exp(-1j)])  # fmt: skip
    found = usable(outside, 2, RATE)
    assert np.sort(np.abs(found)) == pytest.approx([0.9, 1.0 / 1.05])
    assert np.sort(np.angle(found)) == pytest.approx([0.3, 1.0])


def test_real_poles_become_pairs_that_ring():
    """The model's sections have complex poles."""
    found = usable(np.array([0.9 + 0j, 0.5 + 0j, -0.2 + 0j, -0.4 + 0j]), 2, RATE)
    assert len(found) == 2
    assert found.imag.min() > 0.0
    assert np.abs(found).max() < 1.0


def test_the_poles_of_a_filter_are_found_from_elsewhere():
    true = np.array([0.98 * np.exp(0.15j), 0.97 * np.exp(0.4j)])
    hz = np.linspace(100.0, 8000.0, 300)
    z = np.exp(2j * np.pi * hz / RATE)
    wanted = 0.3 + sum((1.0 - 0.5 / z) / ((1 - p / z) * (1 - p.conjugate() / z)) for p in true)
    lines = Lines(hz, wanted, np.ones(len(hz)), RATE)
    poles = np.array([0.9 * np.exp(0.3j), 0.9 * np.exp(0.8j)])
    for _ in range(6):
        poles = moved(lines, poles)
    assert np.sort_complex(poles) == pytest.approx(np.sort_complex(true), abs=1e-6)
    sections, direct = numerators(lines, poles)
    assert direct == pytest.approx(0.3, abs=1e-6)
    assert sections[:, :2] == pytest.approx(np.array([[1.0, -0.5]] * 2), abs=1e-4)
