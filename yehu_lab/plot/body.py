"""One picture of a body: measured and fitted curves, what remains, and the table of modes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_lab.body.body_file import Fit
from yehu_lab.body.curve import Curve, as_db
from yehu_lab.body.report import lines_of
from yehu_server.plot import png
from yehu_server.plot.axes import ABOVE, figure_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE = (15.0, 9.5)  # inches
MEASURED, FITTED, LEFT = "0.55", "#c03a2b", "#1f5fa8"
LINES = 3000
RESIDUAL_DB = 6.0
TICKS_HZ = (100, 200, 300, 500, 700, 1000, 2000, 3000, 5000, 7000, 10000)
MAX_WARNINGS, WIDTH = 5, 150
MAX_MODES = 36  # rows of the table that the page has room for
NAMES = 90  # characters of the measurements' names
ROWS = ("admittance", "phase", "radiation", "left")


def write_picture(fit: Fit, target: Path, *, overwrite: bool = False) -> None:
    """Draw a fit, and write it to a PNG file. Raises ParameterError, OutputError."""
    png.check_picture(target, "a picture", overwrite=overwrite)
    png.write_picture(target, SIZE, lambda figure: _draw(figure, fit), overwrite=overwrite)


def draw(fit: Fit, figure: Figure | None = None) -> Figure:
    """Draw a fit into a figure, by default a new one.

    Raises ParameterError where matplotlib is missing.
    """
    figure = figure_of(figure, *SIZE)
    _draw(figure, fit)
    return figure


def _draw(figure: Any, fit: Fit) -> None:
    panels = figure.subplot_mosaic(
        [[row, "table"] for row in ROWS],
        height_ratios=(2.4, 1.2, 2.4, 1.2),
        width_ratios=(3.2, 1.0),
    )
    hz = np.geomspace(*fit.band_hz, LINES)
    admittance, radiation = fit.admittance(hz), fit.radiation(hz)
    measured = fit.measurement
    _draw_level(panels["admittance"], measured.admittance, hz, admittance)
    panels["admittance"].set(ylabel="admittance\ndB of 1 s/kg")
    for mode_hz in fit.body.frequency_hz:
        if fit.band_hz[0] <= mode_hz <= fit.band_hz[1]:
            panels["admittance"].axvline(mode_hz, color="0.85", lw=0.8, zorder=0)
    _draw_phase(panels["phase"], measured.admittance, hz, admittance)
    _draw_level(panels["radiation"], measured.radiation, hz, radiation)
    panels["radiation"].set(ylabel="radiation\ndB of 1 Pa/N")
    _draw_left(panels["left"], fit)
    for name in ROWS:
        _scale(panels[name], fit.band_hz, is_last=name == ROWS[-1])
    panels["admittance"].legend(**ABOVE)
    panels["admittance"].set_title(_title(fit), loc="left", fontsize=10.5)
    _write_table(panels["table"], fit)
    if fit.warnings:
        lines = [png.plain(line, WIDTH) for line in fit.warnings[:MAX_WARNINGS]]
        if len(fit.warnings) > MAX_WARNINGS:
            lines.append(f"and {len(fit.warnings) - MAX_WARNINGS} more")
        figure.supxlabel("\n".join(lines), fontsize=9.0, color=FITTED, ha="left", x=0.01)


def _draw_level(axes: Any, curve: Curve | None, hz: Any, fitted: Any) -> None:
    if curve is not None:
        axes.plot(curve.frequency_hz, as_db(curve.values), color=MEASURED, lw=2.2, label="measured")
    axes.plot(hz, as_db(fitted), color=FITTED, lw=1.0, label="fitted")
    level = as_db(fitted)
    axes.set_ylim(float(level.min()) - 6.0, float(level.max()) + 6.0)


def _draw_phase(axes: Any, curve: Curve | None, hz: Any, fitted: Any) -> None:
    if curve is not None:
        degrees = np.degrees(np.angle(curve.values))
        axes.plot(curve.frequency_hz, degrees, color=MEASURED, lw=2.2)
    axes.plot(hz, np.degrees(np.angle(fitted)), color=FITTED, lw=1.0)
    axes.set(ylim=(-120.0, 120.0), yticks=(-90, 0, 90), ylabel="its phase\ndegrees")


def _draw_left(axes: Any, fit: Fit) -> None:
    """What remains between fit and measurement."""
    rows = (
        (fit.measurement.admittance, fit.admittance, LEFT, "admittance"),
        (fit.measurement.radiation, fit.radiation, "#e08a00", "radiation"),
    )
    for curve, fitted, colour, label in rows:
        if curve is not None:
            off = as_db(fitted(curve.frequency_hz)) - as_db(curve.values)
            axes.plot(curve.frequency_hz, off, color=colour, lw=0.8, label=label)
    axes.set(ylim=(-RESIDUAL_DB, RESIDUAL_DB), ylabel="fitted less\nmeasured, dB")
    if axes.lines:
        axes.legend(loc="upper left", ncols=2, frameon=False, fontsize=8.5)


def _scale(axes: Any, band_hz: tuple[float, float], *, is_last: bool) -> None:
    from matplotlib.ticker import FixedLocator, NullLocator

    axes.set(xscale="log", xlim=band_hz)
    ticks = [hz for hz in TICKS_HZ if band_hz[0] <= hz <= band_hz[1]]
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticklabels([f"{hz:g}" for hz in ticks] if is_last else [])
    axes.grid(axis="y", color="0.92", lw=0.6)
    if is_last:
        axes.set_xlabel("Hz")


def _write_table(axes: Any, fit: Fit) -> None:
    axes.axis("off")
    modes = lines_of(fit)[: 1 + min(len(fit.body.mass), MAX_MODES)]
    if len(fit.body.mass) > MAX_MODES:
        modes.append(f"and {len(fit.body.mass) - MAX_MODES} more")
    lines = [
        f"{len(fit.body.mass)} bridge modes",
        f"{len(fit.body.sections)} sections of radiation",
    ]
    for what, off in (("admittance", fit.admittance_db), ("radiation", fit.radiation_db)):
        if off is not None:
            lines += [
                f"\n{what}, fitted less measured:",
                f"  {off.rms:.2f} dB rms, {off.most:.1f} dB at most",
                f"  the measurement scatters by {off.scatter:.2f} dB",
            ]
    text = "\n".join([*modes, "", *lines])
    table = axes.text(0.0, 1.0, text, family="monospace", fontsize=9.0, va="top")
    table.set(transform=axes.transAxes, in_layout=False)


def _title(fit: Fit) -> str:
    names = ", ".join(fit.measurement.sources) or "a body"
    taps = max(
        (curve.taps for curve in (fit.measurement.admittance, fit.measurement.radiation) if curve),
        default=0,
    )
    return png.plain(names, NAMES) + (f": {taps} taps" if taps > 1 else "")
