"""The bow forces between which strokes of a result speak, beside Schelleng's limits."""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from yehu_lab.regimes.columns import HELMHOLTZ
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.study import limits_of
from yehu_server.errors import ParameterError

FORCES = ("force", "bow_force")


@dataclass(frozen=True)
class Thresholds:
    """Of the strokes that differ by the force alone (N); NaN where none is Helmholtz motion.

    `at`: the values of the other axes, by name.
    `keep`, `bear`: Schelleng's limits of a motion that is there.
    `start`, `greatest`: the least and the greatest force of a motion from rest, of the most forces
    in a row that have it: islands are chance.
    """

    at: dict[str, float | str]
    keep: float
    start: float
    greatest: float
    bear: float

    def __str__(self) -> str:
        place = ", ".join(
            f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
            for name, value in self.at.items()
        )
        found = f"to start {self.start:.3g} N, greatest {self.greatest:.3g} N"
        if math.isnan(self.start):
            found = "no force starts it"
        return f"{place or 'all'}: to keep {self.keep:.3g} N, {found}, limit {self.bear:.3g} N"


def ends_of(speaks: NDArray[np.bool_], forces: NDArray[np.float64]) -> tuple[float, float]:
    """The least and the greatest force of the most that speak in a row; NaN where none does."""
    order = np.argsort(forces)
    edges = np.flatnonzero(np.diff(speaks[order], prepend=False, append=False)).reshape(-1, 2)
    if len(edges) == 0:
        return math.nan, math.nan
    first, last = edges[(edges[:, 1] - edges[:, 0]).argmax()]
    return float(forces[order[first]]), float(forces[order[last - 1]])


def thresholds_of(result: Result) -> list[Thresholds]:
    """The thresholds of each combination of the other axes.

    Raises
    ------
    ParameterError
        Where no force is varied, or the study names a file that is not in this folder.
    """
    name = next((each for each in FORCES if each in result.axes), None)
    if name is None:
        raise ParameterError("the study varies no force of the bow")
    study, regimes, forces = result.study(), result.grid("regime"), np.abs(result.axes[name])
    along = list(result.axes).index(name)
    found: list[Thresholds] = []
    others = [each for each in result.axes if each != name]
    ranges = [range(len(result.axes[each])) for each in others]
    for at in itertools.product(*ranges):
        place = dict(zip(others, at, strict=True))
        limits = limits_of(study, place)
        least, most = ends_of(np.moveaxis(regimes, along, -1)[at] == HELMHOLTZ, forces)
        values = {each: result.axes[each][i].item() for each, i in place.items()}
        found.append(Thresholds(values, limits.lower, least, most, limits.upper))
    return found
