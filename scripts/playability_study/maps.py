"""The kept maps of the playability study, and what is measured on them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.regimes.columns import HELMHOLTZ

Array = Any

KINDS = ("schelleng", "guettler", "repeats", "speeds")
FILE = Path(__file__).with_name("maps.npz")
NEVER = 255  # periods to Helmholtz motion
USUAL = (0.08, 0.3)  # bow positions over which limits are compared
LEAST_RUN = 3  # cells of Helmholtz motion that count as a band


@dataclass(frozen=True)
class Maps:
    """The maps of one study: notes (or bows), force, and place or acceleration.

    `regime`, `periods` (ndarray [shape=(maps, forces, places)]): what is found.
    `lower`, `upper` (ndarray [shape=(maps, places)]): Schelleng's limits (N).
    """

    facts: dict[str, Any]
    notes: Array
    forces: Array
    places: Array
    regime: Array
    periods: Array
    lower: Array
    upper: Array

    @property
    def helmholtz(self) -> Array:
        """Where the string moves as Helmholtz saw."""
        return self.regime == HELMHOLTZ

    @property
    def inside(self) -> Array:
        """Where the force lies between Schelleng's limits."""
        force = self.forces[None, :, None]
        return (force > self.lower[:, None, :]) & (force < self.upper[:, None, :])


def read(name: str, file: Path = FILE) -> Maps | None:
    """Read a study; None where it was not kept."""
    with np.load(file, allow_pickle=False) as arrays:
        if f"{name}/facts" not in arrays.files:
            return None
        own = {
            key.partition("/")[2]: arrays[key] for key in arrays.files if key.startswith(f"{name}/")
        }
    facts = json.loads(str(own["facts"]))
    axes = [own[f"axis_{axis}"] for axis in facts["axes"]]
    at = np.log(axes[2])

    def everywhere(rows: Array) -> Array:
        return np.exp([np.interp(at, at[own["places"]], np.log(row)) for row in rows])

    lower, upper = everywhere(own["lower"]), everywhere(own["upper"])
    notes, forces, places = axes
    return Maps(facts, notes, forces, places, own["regime"], own["periods"], lower, upper)


def bands(maps: Maps) -> tuple[Array, Array]:
    """The least and the greatest force (N) of the widest band of Helmholtz motion.

    Returns: two ndarrays [shape=(maps, places)]; NaN where there is none, and where the band runs
    off the map.
    """
    shape = (len(maps.notes), len(maps.places))
    least, greatest = np.full(shape, np.nan), np.full(shape, np.nan)
    for i, j in np.ndindex(*shape):
        least[i, j], greatest[i, j] = band(maps.forces, maps.helmholtz[i, :, j])
    return least, greatest


def band(forces: Array, helmholtz: Array) -> tuple[float, float]:
    """As `bands`, of one row of forces."""
    change = np.flatnonzero(np.diff(np.concatenate([[0], helmholtz.astype(int), [0]])))
    begins, ends = change[::2], change[1::2]
    if len(begins) == 0 or (ends - begins).max() < LEAST_RUN:
        return np.nan, np.nan
    widest = int((ends - begins).argmax())
    begin, end = begins[widest], ends[widest]
    ratio = float(np.sqrt(forces[1] / forces[0]))
    least = forces[begin] / ratio if begin > 0 else np.nan
    greatest = forces[end - 1] * ratio if end < len(forces) else np.nan
    return least, greatest


def median(values: Array) -> Array:
    """The median of each row, without NaN; NaN where there is nothing else."""
    rows = [row[np.isfinite(row)] for row in values]
    return np.array([np.median(row) if len(row) else np.nan for row in rows])


def usual(maps: Maps) -> Array:
    """Which bow positions limits are compared over."""
    return (maps.places >= USUAL[0]) & (maps.places <= USUAL[1])


def slope(x: Array, y: Array) -> float:
    """The exponent of a power law through points, by least squares of logarithms; NaN for few."""
    known = np.isfinite(y)
    if known.sum() < 5:
        return float("nan")
    return float(np.polyfit(np.log(x[known]), np.log(y[known]), 1)[0])
