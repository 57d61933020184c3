"""Which points are computed, on regions that are known."""

import numpy as np

from yehu_lab.regimes.columns import FINDING, HELMHOLTZ
from yehu_lab.sweeps import running
from yehu_lab.sweeps.axes import coarse_points, fill, finer_points
from yehu_lab.sweeps.journal import Done
from yehu_lab.sweeps.study import study_of

LEVELS = 3


def disc(shape):
    """1 within a circle, 0 outside."""
    x, y = np.meshgrid(*(np.linspace(-1, 1, length) for length in shape), indexing="ij")
    return (x**2 + y**2 < 0.55).astype(np.uint8)


def refined(truth, refine=(0, 1), levels=LEVELS):
    """The points that are computed of a field whose values are known."""
    flat = truth.reshape(-1)
    known = coarse_points(truth.shape, refine, levels)
    for halved in range(levels):
        more = finer_points(truth.shape, refine, levels, halved, known, flat[known])
        assert not set(more) & set(known)
        known = np.union1d(known, more)
    return known


def test_a_border_is_found_to_the_finest_step():
    truth = disc((65, 65))
    known = refined(truth)
    found = fill(truth.shape, (0, 1), LEVELS, known, truth.reshape(-1)[known])
    assert (found == truth).all()
    assert len(known) < 0.4 * truth.size


def test_a_study_gets_finer_at_the_borders_that_it_asks_for(data, monkeypatch):
    inside = disc((17, 9)) == 1
    regimes = np.where(inside, HELMHOLTZ, np.where(np.arange(9) > 3, HELMHOLTZ + 1, 0))

    def find(_study, numbers):
        found = np.zeros(len(numbers), FINDING)
        found["regime"] = regimes.flat[numbers]
        return found

    monkeypatch.setattr(running, "findings_of", find)
    for border, truth in {"regimes": regimes, "helmholtz": inside}.items():
        asked = {"axes": ["force", "position"], "levels": 2, "border": border}
        known = Done()
        running.run_levels(study_of(data(refine=asked)), known, workers=1)
        assert known.done()[0].tolist() == refined(truth, levels=2).tolist(), border


def test_an_axis_that_is_not_refined_has_maps_of_its_own():
    truth = np.stack([disc((33, 33)), np.zeros((33, 33), np.uint8)])
    known = refined(truth, refine=(1, 2))
    own = known[known >= 33 * 33]
    assert len(own) == 5 * 5
    values = truth.reshape(-1)[known]
    assert (fill(truth.shape, (1, 2), LEVELS, known, values) == truth).mean() > 0.995
