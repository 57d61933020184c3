"""What maps of sweeps are made of: cells, colours of regimes, Schelleng's limits."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

# Distinct also to eyes that confuse red and green.
COLOURS = {
    "unbowed": "#ffffff",
    "silent": "#e6e6e6",
    "helmholtz": "#2f8f5b",
    "multiple slip": "#a9d18e",
    "octave": "#3b7dd8",
    "anomalous low": "#f0a830",
    "raucous": "#b5402a",
    "aperiodic": "#5a4a6f",
}
LABELS = {
    "force": "bow force, N",
    "position": "bow position β",
    "speed": "bow speed, m/s",
    "acceleration": "acceleration of the bow, m/s²",
    "note": "MIDI note",
    "press": "finger force, N",
    "place": "place of the finger, cents above the note",
    "tension": "tension of the string, factor",
    "noise": "noise of the hair",
    "bow_force": "bow force, N",
    "bow_velocity": "bow speed, m/s",
    "bow_position": "bow position, m from the loop",
    "bow_acceleration": "acceleration of the bow, m/s²",
    "press_force": "finger force, N",
    "finger_position": "finger position, m from the loop",
}
# Points by which a map's share of Helmholtz motion is off with another sample rate than 44.1 kHz,
# the mean of four notes: docs/validation.md.
RATE_ERROR = 3.3
Array = Any
EQUAL = 1.2  # steps or ratios that differ by less are equal
WIDE = 5.0  # from which ratio uneven values are drawn by logarithms
NEVER = "0.85"  # the colour of what has no value
OTHER = "0.7"  # of a regime without a colour
LIMITS = {"upper": ("k-", "Schelleng's upper limit"), "lower": ("k--", "Schelleng's lower limit")}


def is_log(values: Array, spread: str = "") -> bool:
    """Whether values are drawn by logarithms; `spread`, where that is known, is how they lie."""
    if spread or values.dtype.kind == "U":
        return spread == "log"
    values = np.sort(values)
    if len(values) < 2 or values[0] <= 0.0:
        return False
    if len(values) > 2 and _is_even(np.diff(values)):
        return False
    is_even = len(values) > 2 and _is_even(np.diff(np.log(values)))
    return bool(values[-1] > WIDE * values[0] or is_even)


def _is_even(steps: Array) -> bool:
    return bool(steps.max() < EQUAL * steps.min())


def edges(values: Array, *, log: bool) -> Array:
    """Return the edges of cells about values that rise or fall; words have one place each."""
    places = np.arange(len(values)) if values.dtype.kind == "U" else values.astype(np.float64)
    if len(places) == 1:
        return places[0] + np.array([-0.5, 0.5]) * (abs(places[0]) or 1.0)
    if log:
        places = np.log(places)
    middles = 0.5 * (places[1:] + places[:-1])
    ends = 2.0 * places[0] - middles[0], 2.0 * places[-1] - middles[-1]
    found = np.concatenate([ends[:1], middles, ends[1:]])
    return np.exp(found) if log else found


def draw_cells(
    axes: Any, x: Array, y: Array, cells: Array, *, log: tuple[bool, bool], **options: Any
) -> Any:
    """Draw values as cells around the places where they are; return the image.

    They are [shape=(len(y), len(x))], the places in any order, and those that are NaN have no
    colour. `log` says which of both are drawn by logarithms; options are those of ``pcolormesh``.
    """
    across, up = (_order(values) for values in (x, y))
    x, y = x[across], y[up]
    x_edges, y_edges = edges(x, log=log[0]), edges(y, log=log[1])
    shown = np.ma.masked_invalid(np.asarray(cells, np.float64)[up][:, across])
    axes.set_facecolor(NEVER)
    image = axes.pcolormesh(x_edges, y_edges, shown, rasterized=True, **options)
    set_scale(axes.xaxis, x, log=log[0])
    set_scale(axes.yaxis, y, log=log[1])
    axes.set(xlim=x_edges[[0, -1]], ylim=y_edges[[0, -1]])
    return image


def _order(values: Array) -> Array:
    return np.arange(len(values)) if values.dtype.kind == "U" else np.argsort(values)


def set_scale(axis: Any, values: Array, *, log: bool) -> None:
    """Set scale and ticks of a matplotlib axis; logarithms are labelled without powers."""
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

    if values.dtype.kind == "U":
        axis.set_ticks(range(len(values)), labels=list(values))
    elif log:
        axis._set_axes_scale("log")  # noqa: SLF001 - one call for both axes
        few = values.max() < WIDE * values.min()
        axis.set_major_locator(LogLocator(subs=range(1, 10) if few else (1.0, 2.0, 5.0)))
        axis.set_major_formatter(FormatStrFormatter("%g"))
        axis.set_minor_formatter(NullFormatter())


def regime_colours(regimes: Sequence[str]) -> dict[str, Any]:
    """Return the options of `draw_cells` with which numbers of regimes have their colours."""
    from matplotlib.colors import BoundaryNorm, ListedColormap

    colours = [COLOURS.get(name, OTHER) for name in regimes]
    norm = BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours))
    return {"cmap": ListedColormap(colours), "norm": norm}


def regime_patches(regimes: Sequence[str], cells: Array) -> list[Any]:
    """Return what a legend has of the regimes that occur in cells."""
    from matplotlib.patches import Patch

    names = [regimes[int(number)] for number in np.unique(cells)]
    return [Patch(fc=COLOURS.get(name, OTHER), ec="0.6", label=name) for name in names]


def share_of(regimes: Sequence[str], cells: Array) -> str:
    """Return a map's share of Helmholtz motion with its error bar (points), for its title."""
    share = 100.0 * np.mean(np.asarray(cells) == list(regimes).index("helmholtz"))
    return f"Helmholtz: {share:.1f} % ± {RATE_ERROR:g} by the sample rate"


def draw_limits(axes: Any, along: Array, lower: Iterable[float], upper: Iterable[float]) -> None:
    """Draw Schelleng's limits of the force."""
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=3.0, foreground="w")]
    for name, forces in (("upper", upper), ("lower", lower)):
        style, label = LIMITS[name]
        axes.plot(along, list(forces), style, lw=1.4, label=label, path_effects=halo)


def limit_lines() -> list[Any]:
    """Return what a legend has of the limits."""
    from matplotlib.lines import Line2D

    return [
        Line2D([], [], color="k", ls=style[1:], label=label) for style, label in LIMITS.values()
    ]
