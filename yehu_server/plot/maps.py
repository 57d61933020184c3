"""Maps of a sweep: which motion a bow makes, and how soon, over two of its quantities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.plot.axes import axes_of
from yehu_server.plot.stroke import Stroke

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = Any
At = Mapping[str, float]

COLOURS = {
    "unbowed": "#ffffff",
    "silent": "#ececec",
    "helmholtz": "#3f9b57",
    "multiple slip": "#b5dba0",
    "octave": "#4a86c5",
    "anomalous low": "#d9762b",
    "raucous": "#f2d35b",
    "aperiodic": "#8b3a3a",
}
FORCE, PLACE, ACCELERATION = "bow_force", "bow_position", "bow_acceleration"
LABELS = {
    "bow_force": "bow force, N",
    "bow_velocity": "bow speed, m/s",
    "bow_position": "bow position, m from the loop",
    "bow_acceleration": "bow acceleration, m/s²",
    "press_force": "finger force, N",
    "finger_position": "finger position, m from the loop",
}
BESIDE: Any = {
    "loc": "upper left",
    "bbox_to_anchor": (1.0, 1.0),
    "frameon": False,
    "fontsize": "small",
}
EQUAL = 1.2  # steps or ratios that differ by less are equal
MS = 1e3


def regimes(sweep: Any, x: str, y: str, *, at: At | None = None, ax: Axes | None = None) -> Axes:
    """Draw which motion each stroke of a sweep ended in, over two quantities.

    Parameters
    ----------
    sweep : Sweep
    x, y : str
        Names of two of its axes.
    at : mapping, optional
        Of its other axes, the values at which to look; the nearest there is is drawn.
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
    cells = slice_of(sweep, "regime", x, y, at)
    axes = axes_of(ax)
    _draw_regimes(axes, sweep, sweep.axes[x], sweep.axes[y], cells)
    axes.set(xlabel=LABELS.get(x, x), ylabel=LABELS.get(y, y))
    return axes


def schelleng(sweep: Any, *, at: At | None = None, ax: Axes | None = None) -> Axes:
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
    cells = slice_of(sweep, "regime", PLACE, FORCE, at)
    axes = axes_of(ax)
    forces = np.asarray(sweep.axes[FORCE])
    values = dict(at or {}) | {FORCE: float(forces[np.abs(forces).argmax()])}
    stroke = Stroke(gesture_of(sweep), values)
    beta = stroke.beta(sweep.axes[PLACE])
    if beta.min() <= 0.0:
        raise ParameterError(f"{PLACE}: a Schelleng diagram ends at the bridge")
    _draw_regimes(axes, sweep, beta, np.abs(forces), cells)
    ends = axes.get_xlim(), axes.get_ylim()
    along = np.geomspace(*ends[0], 60)
    lower, upper = stroke.limits(along)
    axes.plot(along, upper, "k-", lw=1.6, label="Schelleng's upper limit")
    axes.plot(along, lower, "k--", lw=1.6, label="Schelleng's lower limit")
    axes.set(xlim=ends[0], ylim=ends[1], xlabel="bow position β", ylabel=LABELS[FORCE])
    _add_to_legend(axes)
    return axes


def guettler(sweep: Any, *, at: At | None = None, ax: Axes | None = None) -> Axes:
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
        White where it never begins.

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
    'bow acceleration, m/s²'
    """
    cells = MS * slice_of(sweep, "helmholtz_s", ACCELERATION, FORCE, at)
    axes = axes_of(ax)
    forces = np.abs(np.asarray(sweep.axes[FORCE]))
    image = _draw_cells(axes, sweep.axes[ACCELERATION], forces, cells, cmap="viridis_r")
    axes.figure.colorbar(image, ax=axes, label="time to Helmholtz motion, ms", pad=0.02)
    axes.set(xlabel=LABELS[ACCELERATION], ylabel=LABELS[FORCE])
    return axes


def gesture_of(sweep: Any) -> Mapping[str, Any]:
    """Return the data of the gesture that a sweep varied.

    Raises
    ------
    ParameterError
        Where it has none.
    """
    meta = getattr(sweep, "meta", {})
    found = meta.get("gesture") or meta.get("study", {}).get("gesture")
    if not isinstance(found, Mapping):
        raise ParameterError("the sweep has no gesture, of which Schelleng's limits could be told")
    return found


def slice_of(sweep: Any, quantity: str, x: str, y: str, at: At | None = None) -> Array:
    """Return a quantity of a sweep over two of its axes, ndarray [shape=(len(y), len(x))].

    Raises
    ------
    ParameterError
        Where it has no such axis, or needs to be told where on another.
    """
    names = list(getattr(sweep, "axes", {}))
    for name in (x, y, *(at or {})):
        if name not in names:
            raise ParameterError(f"the sweep has no axis {name!r} (it has: {', '.join(names)})")
    if x == y:
        raise ParameterError(f"{x}: a map needs two axes")
    grid = np.asarray(sweep.grid(quantity), np.float64)
    where: list[Any] = []
    for name in names:
        values = np.asarray(sweep.axes[name])
        if name in (x, y):
            where.append(slice(None))
        elif len(values) == 1:
            where.append(0)
        elif at is None or name not in at:
            raise ParameterError(f"the sweep varies {name} too: at={{{name!r}: {values[0]:g}}}")
        else:
            where.append(int(np.abs(values - at[name]).argmin()))
    cells = grid[tuple(where)]
    return cells if names.index(y) < names.index(x) else cells.T


def _draw_regimes(axes: Any, sweep: Any, x: Array, y: Array, cells: Array) -> None:
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    names = list(sweep.regimes)
    colours = [COLOURS.get(name, "0.7") for name in names]
    norm = BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names))
    _draw_cells(axes, x, y, cells, cmap=ListedColormap(colours), norm=norm)
    seen = [int(number) for number in np.unique(cells)]
    patches = [Patch(fc=colours[each], ec="0.6", label=names[each]) for each in seen]
    axes.legend(handles=patches, **BESIDE)


def _add_to_legend(axes: Any) -> None:
    """Add the lines to the legend of regimes."""
    old = axes.get_legend()
    lines, labels = axes.get_legend_handles_labels()
    handles = [*old.legend_handles, *lines]
    texts = [text.get_text() for text in old.get_texts()] + labels
    axes.legend(handles, texts, **BESIDE)


def _draw_cells(axes: Any, x: Array, y: Array, cells: Array, **options: Any) -> Any:
    """Draw values as cells around the places where they are; scales are as places are spaced."""
    x, y = np.asarray(x, np.float64), np.asarray(y, np.float64)
    across, up = np.argsort(x), np.argsort(y)
    edges = _edges(x[across]), _edges(y[up])
    shown = np.ma.masked_invalid(cells[up][:, across])
    image = axes.pcolormesh(*edges, shown, edgecolors="w", lw=0.3, **options)
    axes.set(xscale=_scale(x), yscale=_scale(y))
    axes.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])
    for each in (axes.xaxis, axes.yaxis):
        if each.get_scale() == "log":
            _tick_plainly(each)
    return image


def _tick_plainly(axis: Any) -> None:
    """Label a logarithmic axis at 1, 2 and 5 of each decade, without powers."""
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FormatStrFormatter("%g"))
    axis.set_minor_formatter(NullFormatter())


def _is_even(steps: Array) -> bool:
    return bool(steps.max() < EQUAL * steps.min())


def _scale(values: Array) -> str:
    """Return "log" where values have equal ratios, or span a decade; else "linear"."""
    values = np.sort(values)
    if len(values) < 3 or values[0] <= 0.0 or _is_even(np.diff(values)):
        return "linear"
    is_log = _is_even(np.diff(np.log(values))) or values[-1] > 8.0 * values[0]
    return "log" if is_log else "linear"


def _edges(values: Array) -> Array:
    """Return the edges of cells about rising values."""
    if len(values) == 1:
        return np.array([0.5, 1.5]) * values[0] if values[0] else np.array([-0.5, 0.5])
    is_log = _scale(values) == "log"
    places = np.log(values) if is_log else values
    middles = 0.5 * (places[1:] + places[:-1])
    first, last = 2.0 * places[0] - middles[0], 2.0 * places[-1] - middles[-1]
    edges = np.concatenate([[first], middles, [last]])
    return np.exp(edges) if is_log else edges
