"""The picture of a whole study: a panel for each map, with Schelleng's limits over it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.lab.plot import png
from yehu_server.lab.plot.cells import LABELS, draw_limits, limit_lines, regime_patches, set_scale
from yehu_server.lab.plot.sweep_maps import (
    ALONG,
    FORCE,
    PERIODS,
    draw_map,
    is_log_along,
    map_of,
    plane_of,
)
from yehu_server.lab.sweeps.result import Result
from yehu_server.lab.sweeps.study import Study, limits_of
from yehu_server.playing.pitch_and_level import note_name

Array = Any

MOST_PANELS = 30
LEAST_WIDTH = 8.0  # inches, for the legend


def write_picture(
    result: Result, target: Path, what: str = "regime", *, overwrite: bool = False
) -> None:
    """Write a picture (PNG) of a result.

    `what` is a column; ``helmholtz_s`` is drawn in periods of the note after the first slip. Raises
    ParameterError where matplotlib is missing, or there is no such column; OutputError where it
    cannot be written.
    """
    png.check_picture(target, "a picture", overwrite=overwrite)
    grid = result.onset_periods() if what == "helmholtz_s" else result.grid(what)
    x, y = plane_of({name: len(values) for name, values in result.axes.items()})
    others = [name for name in result.axes if name not in (x, y)]
    places = list(itertools.product(*(range(len(result.axes[name])) for name in others)))
    left_out = max(0, len(places) - MOST_PANELS)
    maps = [dict(zip(others, place, strict=True)) for place in places[:MOST_PANELS]]
    across = min(len(maps), max(3, math.ceil(math.sqrt(len(maps)))))
    down = math.ceil(len(maps) / across)
    more = f" ({left_out} more maps are not drawn)" if left_out else ""
    study = result.study()

    def fill(figure: Any) -> None:
        panels = figure.subplots(down, across, squeeze=False)
        image = None
        for axes, at in itertools.zip_longest(panels.flat, maps):
            if at is None:
                axes.set_visible(False)
                continue
            if y is None:
                _draw_line(axes, result, x, grid.reshape(-1), what)
            else:
                image = draw_map(axes, result, x, y, map_of(result, grid, x, y, at), what)
                draw_limits_over(axes, result, study, x, y, at)
            axes.set_title(title_of(result, at), fontsize="small")
            axes.set(xlabel="", ylabel="")
        for axes in panels.flat[max(0, len(maps) - across) : len(maps)]:
            axes.set_xlabel(LABELS.get(x, x))
        for axes in panels[:, 0]:
            axes.set_ylabel(LABELS.get(y, y) if y else what)
        handles = regime_patches(result.regimes, grid) if what == "regime" else []
        handles += limit_lines() if y in FORCE else []
        if handles:
            figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
        if what != "regime" and image is not None:
            label = f"{PERIODS}; grey: never" if what == "helmholtz_s" else what
            figure.colorbar(image, ax=panels, label=label, aspect=40)
        about = str(result.meta["study"].get("about", ""))
        figure.suptitle(png.plain(about) + more, fontsize="medium")

    size = (max(LEAST_WIDTH, 1.5 + 3.4 * across), 1.6 + 3.0 * down)
    png.write_picture(target, size, fill, overwrite=overwrite)


def title_of(result: Result, at: Mapping[str, int]) -> str:
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


def limits_along(
    result: Result, study: Study, x: str, y: str, at: Mapping[str, int]
) -> tuple[Array, Array, Array] | None:
    """Schelleng's limits at some places along x of a map, where y is the bow's force.

    Return places on the axis, and the lower and upper limits (N) there; negative as the forces of
    the axis are, which are those of the other string.
    """
    if y not in FORCE or result.axes[x].dtype.kind == "U":
        return None
    forces = result.axes[y]
    largest = int(np.abs(forces).argmax())
    places = np.unique(np.linspace(0, len(result.axes[x]) - 1, ALONG).astype(int))
    found = [limits_of(study, {**at, x: int(place), y: largest}) for place in places]
    sign = -1.0 if forces[largest] < 0.0 else 1.0
    lower = sign * np.array([each.lower for each in found])
    upper = sign * np.array([each.upper for each in found])
    return places, lower, upper


def draw_limits_over(
    axes: Any, result: Result, study: Study, x: str, y: str, at: Mapping[str, int]
) -> None:
    """Draw Schelleng's limits over a map, where y is the bow's force."""
    found = limits_along(result, study, x, y, at)
    if found is not None:
        ends = axes.get_xlim(), axes.get_ylim()
        places, lower, upper = found
        draw_limits(axes, result.axes[x][places], lower, upper)
        axes.set(xlim=ends[0], ylim=ends[1])


def _draw_line(axes: Any, result: Result, x: str, values: Array, what: str) -> None:
    axes.plot(result.axes[x], values, "k.-", lw=0.6, ms=3)
    set_scale(axes.xaxis, result.axes[x], log=is_log_along(result, x))
    if what == "regime":
        axes.set_yticks(range(len(result.regimes)), labels=result.regimes)
