"""Write the result of a study as a page to browse: one HTML file that needs no server."""

from __future__ import annotations

import base64
import html
import json
import math
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.lab.plot.cells import COLOURS, LABELS
from yehu_server.lab.plot.study import limits_along
from yehu_server.lab.plot.sweep_maps import MOST_PERIODS, is_log_along, plane_of
from yehu_server.lab.sweeps.result import Result
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.util.files import read_text, write_text

Array = Any

TEMPLATE = Path(__file__).with_name("study_page.html")
MOST_CELLS = 20_000_000
LEVELS = 254  # that a byte tells apart; 255 is none
NONE = 255
# Cents off the median: on the scale of all pitches, which has octaves, flattening is not seen.
FLATTENING = (-60.0, 30.0)
# Of the map of colours "viridis" (CC0), from dark to light.
SCALE = ((68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37))


def write_page(result: Result, target: Path) -> None:
    """Write a page (HTML) of a result.

    Raises ParameterError where the result has too few axes for a map, or too many points;
    OutputError where it cannot be written.
    """
    x, y = plane_of({name: len(values) for name, values in result.axes.items()})
    if y is None:
        raise ParameterError("a page needs two axes at least")
    if math.prod(result.shape) > MOST_CELLS:
        raise ParameterError(f"a page has at most {MOST_CELLS} points")
    title = str(result.meta["study"].get("about", "")) or "A sweep"
    note = f"{len(result)} strokes, by {result.meta['made_by']}."
    if result.meta["levels"]:
        note += " Where all strokes about were alike, those between were not computed."
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
    label = "note" if name == "note" else LABELS.get(name, name)
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
            "colours": [COLOURS.get(name, "#888888") for name in regimes],
            "data": _packed(result.grid("regime").transpose(order)),
        }
    ]
    kinds: tuple[tuple[str, str, Array, str, tuple[float, float] | None], ...] = (
        ("periods to Helmholtz motion", "never", result.onset_periods(), "", (0.0, MOST_PERIODS)),
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
