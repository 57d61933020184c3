"""Towards the continuous instrument: strings tied to the bridge, and no grid at all.

The expectation is the model of [Yehu] section 2 itself, solved without finite differences:
each string as its sine modes, the bridge as its measured ones, the two constraints (12)
removed exactly, and time by the eigenvalues of what is left.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy
from core.physics.runs import bump, rows, shaped

from yehu_server.core.physics import kernel, layout, time_loop
from yehu_server.core.physics.default_quantities import Quantities

# The finger out of reach: only strings and bridge move, and nothing is radiated.
YEHU = replace(
    Quantities(),
    body=replace(Quantities().body, sections=()),
    finger=replace(Quantities().finger, rest_height=0.05),
    tension_modulation=0.0,
    felt_loss=0.0,
)
L = YEHU.string_1.L
PLUCK = bump(0.02, 0.26, 1e-3)
TIMES = np.arange(1, 11) * 1e-3  # s
PLACES = np.linspace(0.0, L, 381)  # m


def sine_coefficients(shape, modes):
    x = np.linspace(0.0, L, 20001)
    sines = np.sin(np.pi * np.outer(np.arange(1, modes + 1), x) / L)
    return 2.0 / L * (sines @ shape(x)) * (x[1] - x[0])


def continuous_shapes(shape, modes):
    """Both strings at TIMES and PLACES after a pluck of string 1 [shape=(times, 2 places)]."""
    p = np.arange(1, modes + 1)
    beta = p * np.pi / L
    mass, stiffness, loss, at_bridge = [], [], [], []
    for string in YEHU.strings:
        rho_A = string.rho * math.pi * string.r**2
        EI = string.E * math.pi * string.r**4 / 4.0
        mass.append(np.full(modes, rho_A * L / 2.0))
        stiffness.append((string.T * beta**2 + EI * beta**4) * L / 2.0)
        loss.append(rho_A * (string.sigma_0 + string.sigma_1 * beta**2) * L)
        at_bridge.append(np.sin(beta * YEHU.bridge_x))
    body = YEHU.body
    omega = 2.0 * np.pi * np.array(body.frequency_hz)
    mass.append(np.array(body.mass))
    stiffness.append(np.array(body.mass) * omega**2)
    loss.append(np.array(body.damping))
    mass, stiffness, loss = (np.concatenate(part) for part in (mass, stiffness, loss))
    constraint = np.zeros((2, len(mass)))
    constraint[0, :modes], constraint[1, modes : 2 * modes] = at_bridge
    constraint[:, 2 * modes :] = -1.0
    # In coordinates of unit mass; `free` spans the motions that keep both constraints.
    unit = 1.0 / np.sqrt(mass)
    free = scipy.linalg.null_space(constraint * unit)
    size = free.shape[1]
    rigidity = free.T @ ((stiffness * unit**2)[:, np.newaxis] * free)
    damping = free.T @ ((loss * unit**2)[:, np.newaxis] * free)
    motion = np.block([[np.zeros((size, size)), np.eye(size)], [-rigidity, -damping]])
    start = np.zeros(len(mass))
    start[:modes] = sine_coefficients(shape, modes)
    values, vectors = np.linalg.eig(motion)
    weights = np.linalg.solve(vectors, np.concatenate([free.T @ (start / unit), np.zeros(size)]))
    sines = np.sin(np.outer(PLACES, beta))
    shapes = []
    for time in TIMES:
        reduced = ((vectors * np.exp(values * time)) @ weights).real[:size]
        amplitude = unit * (free @ reduced)
        parts = sines @ amplitude[:modes], sines @ amplitude[modes : 2 * modes]
        shapes.append(np.concatenate(parts))
    return np.array(shapes)


def simulated_shapes(rate):
    """The same from the kernel, between its nodes by a spline."""
    model = kernel.prepare(YEHU, rate)
    state = shaped(model, 0, PLUCK)
    shapes, done = [], 0
    for time in TIMES:
        frames = round(time * rate) - done
        done += frames
        probes = np.zeros((frames, layout.probe_columns(1)))
        time_loop.run(model, state, None, rows(frames, 1, {}), probes)
        both = []
        for i in range(layout.STRINGS):
            N = int(model["N"][0, i])
            u = state["motion"]["u"][
                0, int(state["motion"]["level"][0]), i, layout.GHOST : layout.GHOST + N + 1
            ]
            # The last sample rarely falls on the millisecond: go on by its velocity.
            before = state["motion"]["u"][0, (int(state["motion"]["level"][0]) + 2) % 3, i][
                1 : N + 2
            ]
            u = u + (u - before) * (time * rate - done)
            both.append(scipy.interpolate.CubicSpline(np.linspace(0.0, L, N + 1), u)(PLACES))
        shapes.append(np.concatenate(both))
    return np.array(shapes)


@pytest.fixture(scope="module")
def exact():
    fine = continuous_shapes(PLUCK, modes=110)
    coarse = continuous_shapes(PLUCK, modes=85)
    # The expectation has converged, far within what is asked below.
    assert np.linalg.norm(fine - coarse) < 2e-3 * np.linalg.norm(fine)
    return fine


def test_the_error_after_a_pluck_falls_with_the_step(exact):
    """Over three halvings, at a mean order of at least 0.7 (the sigma_1 term is of order 1).

    Error: of both strings' shapes over the first 10 ms, in the L2 norm. A grid has a whole
    number of intervals and the bridge falls anywhere between two nodes, so errors scatter
    from rate to rate: the geometric mean over five starts within an octave does not.
    """
    starts = 22050.0 * 2.0 ** (np.arange(5) / 5.0)
    errors = np.array(
        [
            [np.linalg.norm(simulated_shapes(rate * 2.0**j) - exact) for j in range(4)]
            for rate in starts
        ]
    ) / np.linalg.norm(exact)
    order = np.log2(errors[:, 0] / errors[:, -1]) / 3.0
    assert order.mean() >= 0.7, errors
    assert order.min() >= 0.5, errors
    assert np.all(np.diff(np.log(errors).mean(axis=0)) < -0.4), errors
    # ... and towards the right place: 1 % of the pluck is left at 176.4 kHz.
    assert errors[0, -1] < 0.015
