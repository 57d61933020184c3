"""A whole study: a picture with a panel for each map, or a page to browse, one HTML file.

Schelleng's limits are drawn over them.
"""

import base64
import html
import itertools
import json
import math
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.plot import cells
from yehu_lab.plot.sweep_maps import (
    ALONG,
    FORCE,
    MAX_PERIODS,
    PERIODS,
    draw_map,
    is_log_along,
    map_of,
    plane_of,
)
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.study import Study, limits_of
from yehu_server.errors import ParameterError
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.plot import png
from yehu_server.util.files import read_text, write_text

Array = Any

MAX_PANELS = 30
MIN_WIDTH = 8.0  # inches, for the legend
TEMPLATE = Path(__file__).with_name("study_page.html")
MAX_CELLS = 20_000_000
LEVELS = 254  # that a byte distinguishes; 255 is none
NONE = 255
# Cents off the median: on the scale of all pitches, which has octaves, flattening is not seen.
FLATTENING = (-60.0, 30.0)
# Of the map of colours "viridis" (CC0), from dark to light.
SCALE = ((68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37))


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
    left_out = max(0, len(places) - MAX_PANELS)
    maps = [dict(zip(others, place, strict=True)) for place in places[:MAX_PANELS]]
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
            title = [title_of(result, at)]
            if what == "regime" and y is not None:
                title.append(cells.share_of(result.regimes, map_of(result, grid, x, y, at)))
            axes.set_title("\n".join(filter(None, title)), fontsize="small")
            axes.set(xlabel="", ylabel="")
        for axes in panels.flat[max(0, len(maps) - across) : len(maps)]:
            axes.set_xlabel(cells.LABELS.get(x, x))
        for axes in panels[:, 0]:
            axes.set_ylabel(cells.LABELS.get(y, y) if y else what)
        handles = cells.regime_patches(result.regimes, grid) if what == "regime" else []
        handles += cells.limit_lines() if y in FORCE else []
        if handles:
            figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
        if what != "regime" and image is not None:
            label = f"{PERIODS}; grey: never" if what == "helmholtz_s" else what
            figure.colorbar(image, ax=panels, label=label, aspect=40)
        about = str(result.meta["study"].get("about", ""))
        figure.suptitle(png.plain(about) + more, fontsize="medium")

    size = (max(MIN_WIDTH, 1.5 + 3.4 * across), 1.6 + 3.0 * down)
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
        cells.draw_limits(axes, result.axes[x][places], lower, upper)
        axes.set(xlim=ends[0], ylim=ends[1])


def _draw_line(axes: Any, result: Result, x: str, values: Array, what: str) -> None:
    axes.plot(result.axes[x], values, "k.-", lw=0.6, ms=3)
    cells.set_scale(axes.xaxis, result.axes[x], log=is_log_along(result, x))
    if what == "regime":
        axes.set_yticks(range(len(result.regimes)), labels=result.regimes)


def write_page(result: Result, target: Path) -> None:
    """Write a page (HTML) of a result.

    Raises ParameterError where the result has too few axes for a map, or too many points;
    OutputError where it cannot be written.
    """
    x, y = plane_of({name: len(values) for name, values in result.axes.items()})
    if y is None:
        raise ParameterError("a page needs two axes at least")
    if math.prod(result.shape) > MAX_CELLS:
        raise ParameterError(f"a page has at most {MAX_CELLS} points")
    title = str(result.meta["study"].get("about", "")) or "A sweep"
    note = f"{len(result)} strokes, by {result.meta['made_by']}."
    if result.meta["levels"]:
        note += " Where all strokes about were alike, those between were not computed."
    off = f"may be some {cells.RATE_ERROR:g} points off with another sample rate"
    note += f" A share of Helmholtz motion {off}."
    data = json.dumps(facts_of(result, x, y)).replace("<", "\\u003c")
    page = read_text(TEMPLATE)
    for place, text in (
        ("__TITLE__", html.escape(title)),
        ("__NOTE__", html.escape(note)),
        ("__DATA__", data),
    ):
        page = page.replace(place, text)
    write_text(target, page)


def facts_of(result: Result, x: str, y: str) -> dict[str, Any]:
    """What the page is made of: axes, columns as bytes, limits."""
    others = [name for name in result.axes if name not in (x, y)]
    order = [list(result.axes).index(name) for name in (*others, y, x)]
    return {
        "x": _axis(result, x),
        "y": _axis(result, y),
        "others": [_axis(result, name) for name in others],
        "columns": _columns(result, order),
        "limits": _limits(result, x, y, others),
        "scale": SCALE,
    }


def _axis(result: Result, name: str) -> dict[str, Any]:
    values = result.axes[name]
    is_text = values.dtype.kind == "U"
    words = list(values) if is_text else None
    if name == "note":
        words = [note_name(float(value)) for value in values]
    label = "note" if name == "note" else cells.LABELS.get(name, name)
    axis = {
        "label": label,
        "values": words or values.tolist(),
        "numbers": list(range(len(values))) if is_text else values.tolist(),
        "log": is_log_along(result, name),
    }
    return axis | ({"words": words} if is_text else {})


def _columns(result: Result, order: list[int]) -> list[dict[str, Any]]:
    regimes = list(result.regimes)
    found: list[dict[str, Any]] = [
        {
            "label": "regime",
            "regimes": regimes,
            "colours": [cells.COLOURS.get(name, "#888888") for name in regimes],
            "data": _packed(result.grid("regime").transpose(order)),
        }
    ]
    kinds: tuple[tuple[str, str, Array, str, tuple[float, float] | None], ...] = (
        ("periods to Helmholtz motion", "never", result.onset_periods(), "", (0.0, MAX_PERIODS)),
        ("pitch of Helmholtz motion", "other", result.flattening(), "cents", FLATTENING),
        ("slips a period", "none", result.grid("slips"), "", (0.0, 6.0)),
        ("pitch", "none", result.grid("pitch_hz"), "Hz", None),
        ("level", "none", result.grid("level_db"), "dB re 1 Pa", None),
        ("brightness", "none", result.grid("brightness_hz"), "Hz", None),
    )
    for label, none, values, unit, ends in kinds:
        finite = values[np.isfinite(values)]
        found_ends = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
        low, high = ends or found_ends
        step = max(high - low, 1e-9) / LEVELS
        scaled = np.clip(np.rint((np.nan_to_num(values) - low) / step), 0, LEVELS)
        bytes_ = np.where(np.isfinite(values), scaled, NONE).astype(np.uint8)
        entry = {"label": label, "none": none, "unit": unit, "low": low, "step": step}
        found.append(entry | {"data": _packed(bytes_.transpose(order))})
    return found


def _packed(values: Array) -> str:
    raw = np.ascontiguousarray(values, np.uint8).tobytes()
    return base64.b64encode(zlib.compress(raw, 9)).decode()


def _limits(result: Result, x: str, y: str, others: list[str]) -> dict[str, Any] | None:
    """Schelleng's limits along x of each map, where y is the bow's force."""
    study = result.study()
    upper, lower = [], []
    places: list[int] = []
    for at in np.ndindex(*(len(result.axes[name]) for name in others)):
        found = limits_along(result, study, x, y, dict(zip(others, at, strict=True)))
        if found is None:
            return None
        places = found[0].tolist()
        lower.append(found[1].tolist())
        upper.append(found[2].tolist())
    return {"at": places, "upper": upper, "lower": lower}
