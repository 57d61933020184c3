"""One picture of a body: measured and fitted curves, what remains, and the table of modes."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.errors import OutputError, ParameterError
from yehu_server.files import anything, check_free, check_target, replacing
from yehu_server.lines import one_line
from yehu_server.workshop.curve import Curve, as_db
from yehu_server.workshop.fitting import Differences, Fit

SOFTWARE = "yehu-server body show"  # named in a picture, which may therefore be replaced
BEGINNING = 4096  # bytes of a file in which it is named
INCHES, DPI = (15.0, 9.5), 100
MEASURED, FITTED, LEFT = "0.55", "#c03a2b", "#1f5fa8"
LINES = 3000
RESIDUAL_DB = 6.0
TICKS_HZ = (100, 200, 300, 500, 700, 1000, 2000, 3000, 5000, 7000, 10000)
MOST_WARNINGS, WIDTH = 5, 150


def check_picture(target: Path, *, overwrite: bool = False) -> None:
    """Check that a picture can be drawn, and may be written.

    Raises
    ------
    ParameterError
        Where matplotlib is missing.
    OutputError
        Where the name does not end in .png, or another file is in its place.
    """
    try:
        import matplotlib as mpl  # noqa: F401
    except ImportError:
        raise ParameterError(
            "a picture needs matplotlib: install yehu-server[plots], the extra for pictures"
        ) from None
    if target.suffix.lower() != ".png":
        raise OutputError(f"{target}: a picture is a .png file")
    check_target(target)
    check_free(target, anything if overwrite else is_ours)


def is_ours(target: Path) -> bool:
    """Whether a file is a picture that `write_picture` made."""
    try:
        with target.open("rb") as file:
            data = file.read(BEGINNING)
    except OSError:
        return False
    return data.startswith(b"\x89PNG") and SOFTWARE.encode() in data


def write_picture(fit: Fit, target: Path, *, overwrite: bool = False) -> None:
    """Draw a fit, and write it to a PNG file.

    Raises
    ------
    ParameterError, OutputError
        As `check_picture`, or where it cannot be written.
    """
    check_picture(target, overwrite=overwrite)
    data = drawn(fit)
    with replacing(target, anything if overwrite else is_ours) as partial:
        partial.write_bytes(data)


def drawn(fit: Fit) -> bytes:
    """Draw a fit; return the bytes of its PNG file."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    settings: Any = {"font.size": 9.5, "text.parse_math": False}
    with mpl.rc_context(mpl.rcParamsDefault), mpl.rc_context(settings):
        figure = Figure(figsize=INCHES, dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        panels = figure.subplot_mosaic(
            [
                ["admittance", "table"],
                ["phase", "table"],
                ["radiation", "table"],
                ["left", "table"],
            ],
            height_ratios=(2.4, 1.2, 2.4, 1.2),
            width_ratios=(3.2, 1.0),
        )
        hz = np.geomspace(*fit.band_hz, LINES)
        admittance, radiation = fit.admittance(hz), fit.radiation(hz)
        measured = fit.measurement
        _draw_level(panels["admittance"], measured.admittance, hz, admittance)
        panels["admittance"].set(ylabel="admittance\ndB of 1 s/kg")
        _mark_modes(panels["admittance"], fit)
        _draw_phase(panels["phase"], measured.admittance, hz, admittance)
        _draw_level(panels["radiation"], measured.radiation, hz, radiation)
        panels["radiation"].set(ylabel="radiation\ndB of 1 Pa/N")
        _draw_left(panels["left"], fit)
        for name in ("admittance", "phase", "radiation", "left"):
            _scale(panels[name], fit.band_hz, is_last=name == "left")
        panels["admittance"].legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False
        )
        panels["admittance"].set_title(_title(fit), loc="left", fontsize=10.5)
        _write_table(panels["table"], fit)
        if fit.warnings:
            figure.supxlabel(_warnings(fit), fontsize=9.0, color=FITTED, ha="left", x=0.01)
        file = io.BytesIO()
        figure.savefig(file, format="png", metadata={"Software": SOFTWARE})
    return file.getvalue()


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
    drawn_any = False
    for curve, fitted, colour, label in rows:
        if curve is not None:
            off = as_db(fitted(curve.frequency_hz)) - as_db(curve.values)
            axes.plot(curve.frequency_hz, off, color=colour, lw=0.8, label=label)
            drawn_any = True
    axes.set(ylim=(-RESIDUAL_DB, RESIDUAL_DB), ylabel="fitted less\nmeasured, dB")
    if drawn_any:
        axes.legend(loc="upper left", ncols=2, frameon=False, fontsize=8.5)


def _mark_modes(axes: Any, fit: Fit) -> None:
    for hz in fit.body.frequency_hz:
        if fit.band_hz[0] <= hz <= fit.band_hz[1]:
            axes.axvline(hz, color="0.85", lw=0.8, zorder=0)


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
    from yehu_server.workshop.told import lines_of

    axes.axis("off")
    rows = lines_of(fit)
    modes = rows[: 1 + len(fit.body.mass)]
    told = [f"{len(fit.body.mass)} bridge modes", f"{len(fit.body.sections)} sections of radiation"]
    for what, off in (("admittance", fit.admittance_db), ("radiation", fit.radiation_db)):
        if off is not None:
            told += ["", *_told(what, off)]
    text = "\n".join([*modes, "", *told])
    axes.text(0.0, 1.0, text, family="monospace", fontsize=9.0, va="top", transform=axes.transAxes)


def _told(what: str, off: Differences) -> list[str]:
    return [
        f"{what}, fitted less measured:",
        f"  {off.rms:.2f} dB rms, {off.most:.1f} dB at most",
        f"  the measurement scatters by {off.scatter:.2f} dB",
    ]


def _title(fit: Fit) -> str:
    names = ", ".join(fit.measurement.sources) or "a body"
    taps = max(
        (curve.taps for curve in (fit.measurement.admittance, fit.measurement.radiation) if curve),
        default=0,
    )
    return _plain(names)[:90] + (f": {taps} taps" if taps > 1 else "")


def _warnings(fit: Fit) -> str:
    lines = [_plain(line)[:WIDTH] for line in fit.warnings[:MOST_WARNINGS]]
    more = len(fit.warnings) - MOST_WARNINGS
    return "\n".join([*lines, *([f"and {more} more"] if more > 0 else [])])


def _plain(text: str) -> str:
    """Text in characters that the font has."""
    return one_line(text).encode("latin-1", "replace").decode("latin-1")
