"""Draw the result of a study: a panel for each map, with Schelleng's limits over it."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.analysis.pitch import note_name
from yehu_server.errors import ParameterError
from yehu_server.files import replacing
from yehu_server.regimes.names import HELMHOLTZ
from yehu_server.sweeps.colours import COLOURS, LABELS, plane_of
from yehu_server.sweeps.limits import limits_of
from yehu_server.sweeps.result import Result
from yehu_server.sweeps.study import Study

Array = Any

MOST_PANELS = 30
LEAST_WIDTH = 8.0  # inches, for the legend
ONSET_PERIODS = 60.0  # the most that the colours of a time tell apart
ALONG = 24  # points of a line
RATIO = 5.0  # from which an axis without a spread is drawn by logarithms


def draw(result: Result, target: Path, what: str = "regime") -> None:
    """Write a picture (PNG) of a result.

    Parameters
    ----------
    what : str
        A column; ``helmholtz_s`` is drawn in periods of the note after the first slip.

    Raises
    ------
    ParameterError
        Where matplotlib is missing, or there is no such column.
    OutputError
        Where it cannot be written.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise ParameterError("a picture needs matplotlib: install yehu-server[plots]") from None
    x, y = plane_of({name: len(values) for name, values in result.axes.items()})
    others = [name for name in result.axes if name not in (x, y)]
    places = list(itertools.product(*(range(len(result.axes[name])) for name in others)))
    left_out = max(0, len(places) - MOST_PANELS)
    places = places[:MOST_PANELS]
    across = min(len(places), max(3, math.ceil(math.sqrt(len(places)))))
    down = math.ceil(len(places) / across)
    size = (max(LEAST_WIDTH, 1.5 + 3.4 * across), 1.6 + 3.0 * down)
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(down, across, squeeze=False)
    study, grid = result.study(), values_of(result, what)
    image: Any = None
    for axes, place in itertools.zip_longest(panels.flat, places):
        if place is None:
            axes.set_visible(False)
            continue
        at = dict(zip(others, place, strict=True))
        cells = grid[tuple(at.get(name, slice(None)) for name in result.axes)]
        if y is None:
            _draw_line(axes, result, x, cells, what)
        else:
            flat = cells if list(result.axes).index(y) < list(result.axes).index(x) else cells.T
            image = _draw_map(axes, result, x, y, flat, what)
            _draw_limits(axes, result, study, x, y, at)
        axes.set_title(title_of(result, at), fontsize="small")
    for axes in panels.flat[max(0, len(places) - across) : len(places)]:
        axes.set_xlabel(LABELS.get(x, x))
    for axes in panels[:, 0]:
        axes.set_ylabel(LABELS.get(y, y) if y else what)
    if what == "regime":
        _add_legend(figure, result, grid)
    elif image is not None:
        figure.colorbar(image, ax=panels, label=label_of(what), aspect=40)
    about = str(result.meta["study"].get("about", ""))
    more = f" ({left_out} more maps are not drawn)" if left_out else ""
    figure.suptitle(f"{about}{more}", fontsize="medium")
    with replacing(target) as partial:
        figure.savefig(partial, format="png", dpi=110)


def values_of(result: Result, what: str) -> Array:
    """A column on the grid; the time to Helmholtz motion in periods, after the first slip."""
    if what != "helmholtz_s":
        return result.grid(what)
    return periods_of(result)


def periods_of(result: Result) -> Array:
    """Periods from the first slip to lasting Helmholtz motion, on the grid; NaN for never.

    Also NaN where the stroke then left it again. A period is that of the pitch at the end.
    """
    periods = (result.grid("helmholtz_s") - result.grid("first_slip_s")) * result.grid("pitch_hz")
    return np.where(result.grid("regime") == HELMHOLTZ, periods, np.nan)


def label_of(what: str) -> str:
    """What a column is, for a colour bar."""
    if what == "helmholtz_s":
        return "periods from the first slip to Helmholtz motion; grey: never"
    return what


def title_of(result: Result, at: dict[str, int]) -> str:
    """The title of a map: where it lies on the other axes."""
    fixed = result.meta["study"].get("stroke", {})
    parts = []
    for name, place in at.items():
        value = result.axes[name][place]
        if name == "note":
            parts.append(note_name(float(value)))
        elif name == "string":
            parts.append(f"on string {int(value)}")
        else:
            shown = value if isinstance(value, str) else f"{value:g}"
            parts.append(f"{name.rpartition('.')[2]} {shown}")
    if not at and "note" in fixed:
        parts.append(note_name(float(fixed["note"])))
    return ", ".join(parts)


def is_log(result: Result, name: str) -> bool:
    """Whether an axis is drawn by logarithms."""
    values = result.axes[name]
    spread = dict(zip(result.meta["axes"], result.meta["spreads"], strict=True))[name]
    if spread:
        return bool(spread == "log")
    return bool(np.issubdtype(values.dtype, np.number) and values[0] > 0.0
                and values[-1] > RATIO * values[0])  # fmt: skip


def edges(values: Array, *, log: bool) -> Array:
    """The edges of cells about values."""
    places = (
        np.arange(len(values)) if values.dtype.kind == "U" else np.log(values) if log else values
    )
    if len(places) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middle = 0.5 * (places[1:] + places[:-1])
    found = np.concatenate([[2 * places[0] - middle[0]], middle, [2 * places[-1] - middle[-1]]])
    return np.exp(found) if log else found


def _draw_map(axes: Any, result: Result, x: str, y: str, cells: Array, what: str) -> Any:
    from matplotlib.colors import BoundaryNorm, ListedColormap

    options: dict[str, Any] = {"cmap": "viridis_r"}
    if what == "regime":
        colours = [COLOURS.get(name, "0.7") for name in result.regimes]
        norm = BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours))
        options = {"cmap": ListedColormap(colours), "norm": norm}
    elif what == "helmholtz_s":
        options |= {"vmin": 0.0, "vmax": ONSET_PERIODS}
    axes.set_facecolor("0.85")
    log_x, log_y = is_log(result, x), is_log(result, y)
    x_edges, y_edges = (edges(result.axes[name], log=log) for name, log in ((x, log_x), (y, log_y)))
    shown = np.ma.masked_invalid(np.asarray(cells, np.float64))
    image = axes.pcolormesh(x_edges, y_edges, shown, rasterized=True, **options)
    for axis, log, values in (
        (axes.xaxis, log_x, result.axes[x]),
        (axes.yaxis, log_y, result.axes[y]),
    ):
        _scale(axis, log=log, values=values)
    axes.set(xlim=x_edges[[0, -1]], ylim=y_edges[[0, -1]])
    return image


def _scale(axis: Any, *, log: bool, values: Array) -> None:
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

    if values.dtype.kind == "U":
        axis.set_ticks(range(len(values)), labels=list(values))
    elif log:
        axis._set_axes_scale("log")  # noqa: SLF001 - one call for both axes
        few = values[-1] < RATIO * values[0]
        axis.set_major_locator(LogLocator(subs=range(1, 10) if few else (1.0, 2.0, 5.0)))
        axis.set_major_formatter(FormatStrFormatter("%g"))
        axis.set_minor_formatter(NullFormatter())


def _draw_limits(
    axes: Any, result: Result, study: Study, x: str, y: str, at: dict[str, int]
) -> None:
    """Draw Schelleng's limits where y is the bow's force."""
    if y not in {"force", "bow_force"} or result.axes[x].dtype.kind == "U":
        return
    from matplotlib.patheffects import withStroke

    places = np.unique(np.linspace(0, len(result.axes[x]) - 1, ALONG).astype(int))
    found = [limits_of(study, at | {x: int(place)}) for place in places]
    halo = [withStroke(linewidth=3.0, foreground="w")]
    sign = -1.0 if float(result.axes[y][-1]) < 0.0 else 1.0
    along = result.axes[x][places]
    for limit, style in (("upper", "k-"), ("lower", "k--")):
        forces = [sign * getattr(each, limit) for each in found]
        axes.plot(along, forces, style, lw=1.3, path_effects=halo)


def _draw_line(axes: Any, result: Result, x: str, values: Array, what: str) -> None:
    axes.plot(result.axes[x], values, "k.-", lw=0.6, ms=3)
    _scale(axes.xaxis, log=is_log(result, x), values=result.axes[x])
    if what == "regime":
        axes.set_yticks(range(len(result.regimes)), labels=result.regimes)


def _add_legend(figure: Any, result: Result, grid: Array) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    seen = [int(number) for number in np.unique(grid)]
    handles: list[Any] = [
        Patch(fc=COLOURS.get(result.regimes[k], "0.7"), ec="0.6", label=result.regimes[k])
        for k in seen
    ]
    if {"force", "bow_force"} & result.axes.keys():
        handles.append(Line2D([], [], color="k", ls="-", label="Schelleng's upper limit"))
        handles.append(Line2D([], [], color="k", ls="--", label="Schelleng's lower limit"))
    figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
