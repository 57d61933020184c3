"""Maps of a sweep: which motion a bow makes, and how soon, over two of its quantities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_lab.plot.cells import (
    LABELS,
    draw_cells,
    draw_limits,
    is_log,
    limit_lines,
    regime_colours,
    regime_patches,
    share_of,
)
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.study import limits_of
from yehu_server.errors import ParameterError
from yehu_server.plot.axes import axes_of
from yehu_server.util.values import brief

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = Any
At = Mapping[str, float]

# By the names of controls, and of a note's stroke.
FORCE = ("bow_force", "force")
PLACE = ("bow_position", "position")
ACCELERATION = ("bow_acceleration", "acceleration")
ALONG = 24  # places at which limits are worked out
MAX_PERIODS = 60.0  # that the colours of a time distinguish
PERIODS = "periods from the first slip to Helmholtz motion"
PERIOD_COLOURS: Any = {"cmap": "viridis_r", "vmin": 0.0, "vmax": MAX_PERIODS}
# What is drawn along y, where a result has it: forces first.
UPRIGHT = ("force", "bow_force", "press", "press_force", "tension")
BESIDE: Any = {
    "loc": "upper left",
    "bbox_to_anchor": (1.0, 1.0),
    "frameon": False,
    "fontsize": "small",
}


def regimes(sweep: Result, x: str, y: str, *, at: At | None = None, ax: Axes | None = None) -> Axes:
    """Draw which motion each stroke of a sweep ended in, over two quantities.

    Parameters
    ----------
    sweep : Sweep
    x, y : str
        Names of two of its axes.
    at : mapping, optional
        Of its other axes, the values of which to draw; the nearest there is is drawn.
    ax : Axes, optional

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where there is no such axis, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> vary = {"bow_force": [0.2, 0.8], "bow_velocity": [0.1, 0.3]}
    >>> found = yehu.sweep({"duration": 0.2}, vary)
    >>> yehu.plot.regimes(found, "bow_velocity", "bow_force").get_ylabel()
    'bow force, N'
    """
    cells = map_of(sweep, sweep.grid("regime"), x, y, place_of(sweep, x, y, at))
    axes = axes_of(ax)
    draw_map(axes, sweep, x, y, cells, "regime")
    axes.set_title(share_of(sweep.regimes, cells), fontsize="small")
    axes.legend(handles=regime_patches(sweep.regimes, cells), **BESIDE)
    return axes


def schelleng(sweep: Result, *, at: At | None = None, ax: Axes | None = None) -> Axes:
    """Draw Schelleng's diagram: the motion over bow position and force, with his two limits.

    Parameters
    ----------
    sweep : Sweep
        With the axes ``bow_position`` and ``bow_force``.
    at, ax
        As of `regimes`.

    Returns
    -------
    Axes
        Along x is β, the distance from the bridge as a share of the sounding length.

    Raises
    ------
    ParameterError
        Where the sweep has other axes, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> gesture = {"duration": 0.2, "controls": {"bow_velocity": 0.2}}
    >>> found = yehu.sweep(gesture, {"bow_position": [0.22, 0.26, 0.28], "bow_force": [0.2, 1.0]})
    >>> yehu.plot.schelleng(found).get_xlabel()
    'bow position β'
    """
    x, y = _axis_of(sweep, PLACE), _axis_of(sweep, FORCE)
    place = place_of(sweep, x, y, at)
    cells = map_of(sweep, sweep.grid("regime"), x, y, place)
    axes = axes_of(ax)
    positions, forces = sweep.axes[x], np.abs(sweep.axes[y])
    order = np.argsort(positions)
    some = order[np.unique(np.linspace(0, len(order) - 1, ALONG).astype(int))]
    place[y] = int(forces.argmax())
    study = sweep.study()
    limits = [limits_of(study, place | {x: int(each)}) for each in some]
    betas = np.array([each.beta for each in limits])
    if betas.min() <= 0.0:
        raise ParameterError(f"{x}: a Schelleng diagram ends at the bridge")
    beta = np.interp(positions, positions[some], betas)
    log = is_log(beta), is_log(forces, spread_of(sweep, y))
    draw_cells(axes, beta, forces, cells, log=log, **regime_colours(sweep.regimes))
    ends = axes.get_ylim()
    draw_limits(axes, betas, (each.lower for each in limits), (each.upper for each in limits))
    axes.set(ylim=ends, xlabel=LABELS["position"], ylabel=LABELS["force"])
    axes.set_title(share_of(sweep.regimes, cells), fontsize="small")
    axes.legend(handles=[*regime_patches(sweep.regimes, cells), *limit_lines()], **BESIDE)
    return axes


def guettler(sweep: Result, *, at: At | None = None, ax: Axes | None = None) -> Axes:
    """Draw Guettler's diagram: how soon Helmholtz motion begins, over acceleration and force.

    Parameters
    ----------
    sweep : Sweep
        With the axes ``bow_acceleration`` and ``bow_force``.
    at, ax
        As of `regimes`.

    Returns
    -------
    Axes
        In periods after the first slip; grey where it never begins.

    Raises
    ------
    ParameterError
        Where the sweep has other axes, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> gesture = {"duration": 0.2, "controls": {"bow_velocity": 0.2}}
    >>> found = yehu.sweep(gesture, {"bow_acceleration": [0.5, 2.0], "bow_force": [0.2, 0.6]})
    >>> yehu.plot.guettler(found).get_xlabel()
    'acceleration of the bow, m/s²'
    """
    x, y = _axis_of(sweep, ACCELERATION), _axis_of(sweep, FORCE)
    cells = map_of(sweep, sweep.onset_periods(), x, y, place_of(sweep, x, y, at))
    axes = axes_of(ax)
    image = draw_map(axes, sweep, x, y, cells, "helmholtz_s")
    axes.figure.colorbar(image, ax=axes, label=PERIODS, extend="max", pad=0.02)
    return axes


def sweep(sweep: Result, *, at: At | None = None, ax: Axes | None = None) -> Axes:
    """Draw the map of a sweep: Schelleng's or Guettler's diagram where it has their axes.

    Parameters
    ----------
    sweep : Sweep
        Of two axes at least; any two make a map of the motion.
    at, ax
        As of `regimes`.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where it has one axis only, another is varied and not in `at`, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> gesture = {"duration": 0.2, "controls": {"bow_velocity": 0.2}}
    >>> found = yehu.sweep(gesture, {"bow_position": [0.22, 0.26, 0.28], "bow_force": [0.2, 1.0]})
    >>> yehu.plot.sweep(found).get_xlabel()
    'bow position β'
    """
    has_force = any(name in sweep.axes for name in FORCE)
    free = {name: len(values) for name, values in sweep.axes.items() if name not in (at or {})}
    if has_force and any(name in free for name in PLACE):
        return schelleng(sweep, at=at, ax=ax)
    if has_force and any(name in free for name in ACCELERATION):
        return guettler(sweep, at=at, ax=ax)
    x, y = plane_of(free)
    if y is None:
        raise ParameterError("the sweep has one axis only: a map needs two")
    return regimes(sweep, x, y, at=at, ax=ax)


def plane_of(axes: Mapping[str, int]) -> tuple[str, str | None]:
    """Which axis to draw along x, and which along y, if there are two.

    `axes` has the number of values by name, in order.
    """
    varied = [name for name, count in axes.items() if count > 1] or list(axes)[:1]
    # The seed repeats a map, and a note names one, where others span a plane.
    for name in ("seed", "string", "note"):
        if name in varied and len(varied) > 2:
            varied.remove(name)
    upright = [name for name in UPRIGHT if name in varied]
    y = upright[0] if upright and len(varied) > 1 else None
    if y is None:
        return varied[0], varied[1] if len(varied) > 1 else None
    # The others make maps of their own, so those with few values.
    return max((name for name in varied if name != y), key=lambda name: axes[name]), y


def spread_of(sweep: Result, name: str) -> str:
    """Return how the values of an axis lie: "linear", "log", or "" for a list."""
    return str(dict(zip(sweep.meta["axes"], sweep.meta["spreads"], strict=True))[name])


def is_log_along(sweep: Result, name: str) -> bool:
    """Return whether an axis is drawn by logarithms."""
    return is_log(sweep.axes[name], spread_of(sweep, name))


def place_of(sweep: Result, x: str, y: str, at: At | None = None) -> dict[str, int]:
    """Return the place on each axis but two, by name.

    Raises
    ------
    ParameterError
        Where there is no such axis, or another is varied and not in `at`.
    """
    names, asked = list(sweep.axes), dict(at or {})
    for name in (x, y, *asked):
        if name not in names:
            raise ParameterError(f"the sweep has no axis {name!r} (it has: {', '.join(names)})")
    if x == y:
        raise ParameterError(f"{x}: a map needs two axes")
    found = {}
    for name in names:
        values = sweep.axes[name]
        if name in (x, y):
            continue
        if len(values) > 1 and name not in asked:
            raise ParameterError(f"the sweep varies {name} too: at={{{name!r}: {values[0]!r}}}")
        is_word = values.dtype.kind == "U"
        if len(values) == 1:
            found[name] = 0
        else:
            off = values != asked[name] if is_word else np.abs(values - asked[name])
            found[name] = int(off.argmin())
    return found


def map_of(sweep: Result, grid: Array, x: str, y: str, place: Mapping[str, int]) -> Array:
    """Return values on the grid over two axes, ndarray [shape=(len(y), len(x))]."""
    names = list(sweep.axes)
    cells = np.asarray(grid, np.float64)[tuple(place.get(name, slice(None)) for name in names)]
    return cells if names.index(y) < names.index(x) else cells.T


def _axis_of(sweep: Result, names: tuple[str, ...]) -> str:
    if not isinstance(sweep, Result):
        raise ParameterError(f"expected a sweep, of `yehu.sweep`, got {brief(sweep)}")
    for name in names:
        if name in sweep.axes:
            return name
    raise ParameterError(f"the sweep has no axis {names[0]!r} (it has: {', '.join(sweep.axes)})")


def draw_map(axes: Any, sweep: Result, x: str, y: str, cells: Array, what: str) -> Any:
    """Draw a map of a column over two axes as they are; return the image."""
    options: Any = {"cmap": "viridis_r"}
    if what == "regime":
        options = regime_colours(sweep.regimes)
    elif what == "helmholtz_s":
        options = PERIOD_COLOURS
    log = is_log_along(sweep, x), is_log_along(sweep, y)
    image = draw_cells(axes, sweep.axes[x], sweep.axes[y], cells, log=log, **options)
    axes.set(xlabel=LABELS.get(x, x), ylabel=LABELS.get(y, y))
    return image
