"""Search the modes of a measured admittance: how many, their frequencies, dampings and masses.

One mode after another is added where it helps most, from the starting poles and a lattice of
frequencies and dampings; all are refined each time. A criterion of information shows when a
further mode fits nothing but noise.
"""

import math
from typing import Any

import numpy as np

from yehu_lab.body.curve import Complexes, Floats, interpolated
from yehu_lab.body.modes import Modes, Numbers, Problem, Step, step_at
from yehu_server.util.hints import require_package

HIGHEST_ORDER = 40  # of the polynomials; each order gives candidates
MAX_LINES = 4000  # of the even grid that the method needs
MIN_DAMPING, MAX_DAMPING = 5e-4, 0.3  # damping ratios
BESIDE = 1.05  # how far outside the band a pole may lie
SAME_HZ, SAME_DAMPING = 0.002, 0.15  # relative: poles of two orders that are one candidate
HIGHEST_HZ = 9500.0  # the model's modes lie below 0.45 of the lowest sample rate, 22.05 kHz
BELOW, ABOVE = 0.1, 3.0  # of the band's ends: how far outside modes may stand for those beyond
OUTSIDE = (0.1, 0.3, 0.7), (1.3, 2.0, 3.0)  # of the ends: where such modes are tried first
LATTICE = (0.002, 0.007, 0.025, 0.08)  # damping ratios
TRIED, APART = 3, 0.05  # candidates that are refined before one is chosen, and their least ratio
ROUGH, FINE = (8, 1e-2), (100, 1e-7)  # most steps of a refinement, and the least gain of one
NEGLIGIBLE = 0.02  # of a weighted error of one, squared: what a further mode need not fit
NEARBY = 16  # modes that make room for another, or for the lack of one; others hardly notice
PATIENCE = 3  # modes that may be tried in vain before the search ends


def starting_poles(frequency_hz: Floats, mobility: Complexes) -> tuple[Floats, Floats]:
    """Candidates for modes: what LSCF of any order takes for a pole.

    Of a mobility (s/kg) at rising frequencies, each [shape=(lines,)] with any spacing, frequencies
    and damping ratios (1 / 2Q), each [shape=(candidates,)]. Source: P. Guillaume and others, the
    least-squares complex frequency-domain estimator (IMAC 2003), as sdypy-EMA has it. It wants an
    even grid, so an uneven one is interpolated. Poles of different orders that agree are given
    once.
    """
    require_package("sdypy.EMA", "the body workshop", "body")
    from sdypy.EMA import Model

    lo, hi = float(frequency_hz[0]), float(frequency_hz[-1])
    lines = min(MAX_LINES, max(len(frequency_hz), 4 * HIGHEST_ORDER))
    grid = np.linspace(lo, hi, lines)
    even = interpolated(grid, frequency_hz, mobility)[np.newaxis]
    form: Any = {"pol_order_high": HIGHEST_ORDER, "frf_form": "mobility"}
    model = Model(even, grid, lower=lo, upper=hi, **form)
    model.get_poles(method="lscf", show_progress=False)
    found_hz = np.concatenate([np.asarray(row).real for row in model.pole_freq])
    damping = np.concatenate([np.asarray(row).real for row in model.pole_xi])
    usable = (found_hz > lo / BESIDE) & (found_hz < hi * BESIDE)
    usable &= (damping > MIN_DAMPING) & (damping < MAX_DAMPING)
    return _once(found_hz[usable], damping[usable])


def _once(frequency_hz: Floats, damping: Floats) -> tuple[Floats, Floats]:
    """Leave out poles that are as another, found by a higher order."""
    kept: list[tuple[float, float]] = []
    for hz, ratio in zip(frequency_hz[::-1], damping[::-1], strict=True):
        if all(
            abs(hz / other - 1.0) > SAME_HZ or abs(np.log(ratio / its)) > SAME_DAMPING
            for other, its in kept
        ):
            kept.append((float(hz), float(ratio)))
    table = np.array(kept).reshape(-1, 2)
    return table[:, 0], table[:, 1]


class Search:
    """The search for one measured admittance."""

    def __init__(self, problem: Problem) -> None:
        require_package("scipy", "the body workshop", "body")
        self.problem = problem
        self.wanted = problem.wanted
        lo, hi = float(problem.frequency_hz[0]), float(problem.frequency_hz[-1])
        self.lowest = np.log([BELOW * lo, MIN_DAMPING])
        self.highest = np.log([min(ABOVE * hi, HIGHEST_HZ), MAX_DAMPING])
        self.candidates = self._candidates(lo, hi)
        self.columns = problem.columns(self.candidates)[0].astype(np.float32)

    def find(self, most: int, exactly: int | None = None) -> Modes:
        """Find the modes.

        That is `most` at most that pay, or `exactly` so many, whether they pay or not. What pays is
        decided by the Bayesian information criterion: three numbers a mode against the logarithm of
        the error, over as many values as were measured.
        """
        best = step = step_at(self.problem, np.empty((0, 2)), self.wanted)
        for count in range(1, (exactly or most) + 1):
            another = self._with_another(step)
            if another is None:
                break
            step = another
            if exactly is not None or self._score(step) < self._score(best):
                best = step
            elif count >= len(best.points) + PATIENCE:
                break
        best = self._refined(best.points, FINE)
        if exactly is None:
            best = self._pruned(best)
        return self._modes(best)

    def _candidates(self, lo: float, hi: float) -> Floats:
        """Logarithms of frequency and damping of what may be a mode [shape=(candidates, 2)]."""
        found = np.stack(starting_poles(self.problem.frequency_hz, self.problem.mobility), axis=1)
        lattice = [
            np.stack([hz, np.full(len(hz), ratio)], axis=1)
            for ratio in LATTICE
            for hz in [np.exp(np.arange(math.log(lo), math.log(hi), 2.0 * ratio))]
        ]
        below, above = lo * np.array(OUTSIDE[0]), hi * np.array(OUTSIDE[1])
        outside = np.concatenate([below, above.clip(None, 0.999 * math.exp(self.highest[0]))])
        beyond = np.stack([outside, np.full(len(outside), LATTICE[-1])], axis=1)
        points = np.log(np.vstack([found, *lattice, beyond]))
        inside = (points >= self.lowest - 1e-9) & (points <= self.highest + 1e-9)
        return np.asarray(points[inside.all(axis=1)])

    def _with_another(self, step: Step) -> Step | None:
        """The modes and one more; None where none makes the error smaller."""
        columns, _ = self.problem.columns(step.points)
        left = self.wanted - columns @ step.amounts
        gain = self.columns.T @ left.astype(np.float32)
        tried: list[Step] = []
        while len(tried) < TRIED and gain.max() > 0.0:
            new = self.candidates[int(gain.argmax())]
            points = np.vstack([step.points, new])
            tried.append(self._refined(points, ROUGH, _nearest(points, new)))
            gain = np.where(np.abs(self.candidates[:, 0] - new[0]) < APART, 0.0, gain)
        return min(tried, key=lambda found: found.error, default=None)

    def _pruned(self, step: Step) -> Step:
        """Leave out modes that do not pay."""
        while len(step.points) > 1:
            fewer = []
            for i, gone in enumerate(step.points):
                points = np.delete(step.points, i, axis=0)
                fewer.append(self._refined(points, ROUGH, _nearest(points, gone)))
            least = min(fewer, key=lambda found: found.error)
            if self._score(least) > self._score(step):
                break
            step = self._refined(least.points, FINE)
        return step

    def _refined(
        self, points: Floats, effort: tuple[int, float], moving: Numbers | None = None
    ) -> Step:
        """Move frequencies and dampings to where the error is least, by Levenberg and Marquardt.

        `moving` has the numbers of the modes that move; by default all.
        """
        moving = np.arange(len(points)) if moving is None else moving
        now = step_at(self.problem, points, self.wanted, moving)
        if not len(points):
            return now
        firmness = 1e-3
        steps, least_gain = effort
        for _ in range(steps):
            scale = np.diag(now.curvature).clip(1e-12 * now.curvature.diagonal().max() + 1e-300)
            move = np.linalg.solve(now.curvature + firmness * np.diag(scale), -now.gradient)
            moved = now.points.copy()
            moved[moving] += move.reshape(2, -1).T.clip(-0.5, 0.5)
            bounded = moved.clip(self.lowest, self.highest)
            then = step_at(self.problem, bounded, self.wanted, moving)
            if then.error >= now.error:
                firmness *= 10.0
                if firmness > 1e8:
                    break
                continue
            gained = 1.0 - then.error / now.error
            now, firmness = then, max(firmness / 10.0, 1e-12)
            if gained < least_gain:
                break
        return now

    def _score(self, step: Step) -> float:
        """Bayesian information criterion, up to a constant; less is better."""
        lines = len(self.wanted)
        error = step.error + NEGLIGIBLE * lines
        return lines * math.log(error) + 3 * len(step.points) * math.log(lines)

    def _modes(self, step: Step) -> Modes:
        _, lengths = self.problem.columns(step.points)
        inverse_mass = step.amounts / lengths
        order = np.argsort(step.points[:, 0])
        order = order[inverse_mass[order] > 0.0]
        frequency_hz, damping = np.exp(step.points.T)
        return Modes(frequency_hz[order], damping[order], inverse_mass[order])


def _nearest(points: Floats, point: Floats) -> Numbers:
    """The numbers of the modes that are nearest to a point in frequency."""
    return np.sort(np.abs(points[:, 0] - point[0]).argsort(kind="stable")[:NEARBY])
