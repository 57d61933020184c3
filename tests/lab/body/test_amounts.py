"""The inverse masses at given frequencies: the best that are not below zero."""

import numpy as np
import pytest
from lab.body.bodies import DAMPING, HZ, MASS, admittance

from yehu_server.lab.body.modes import Problem, amounts_of, look

GRID = np.linspace(300.0, 4000.0, 400)
DAMPING_RATIO = DAMPING / (2.0 * MASS * 2.0 * np.pi * HZ)


@pytest.mark.parametrize("seed", range(8))
def test_no_other_amounts_above_zero_are_better(seed):
    """Karush, Kuhn and Tucker: the slope is zero along amounts in use, and upwards along others."""
    random = np.random.default_rng(seed)
    columns, wanted = random.standard_normal((40, 7)), random.standard_normal(40)
    amounts = amounts_of(columns.T @ columns, columns.T @ wanted)
    slope = columns.T @ (columns @ amounts - wanted)
    assert amounts.min() >= 0.0
    assert (amounts == 0.0).any()
    assert np.abs(slope[amounts > 0.0]).max() < 1e-9
    assert slope[amounts == 0.0].min() > 0.0


def test_at_the_true_frequencies_the_true_masses_are_found():
    problem = Problem(GRID, admittance(GRID), np.ones(len(GRID)))
    points = np.log(np.stack([HZ, DAMPING_RATIO], axis=1))
    step = look(problem, points, problem.wanted)
    _, lengths = problem.columns(points)
    assert step.amounts / lengths == pytest.approx(1.0 / MASS, rel=1e-4)


def test_the_error_falls_as_its_gradient_tells():
    """Against the difference of two errors, a little to each side."""
    problem = Problem(GRID, admittance(GRID), 1.0 / np.abs(admittance(GRID)))
    points = np.log(np.stack([HZ[:4] * 1.02, DAMPING_RATIO[:4] * 1.3], axis=1))
    step = look(problem, points, problem.wanted)
    for i in range(4):
        for column in range(2):
            by = np.zeros((4, 2))
            by[i, column] = 1e-5
            ahead = look(problem, points + by, problem.wanted).error
            back = look(problem, points - by, problem.wanted).error
            slope = 0.5 * (ahead - back) / 2e-5
            assert step.gradient[i + 4 * column] == pytest.approx(slope, rel=1e-3, abs=1e-4)
