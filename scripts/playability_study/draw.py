"""Draw the figures of docs/playability.md from the kept maps, and write its tables.

    .venv/bin/python scripts/playability_study/draw.py [FOLDER]

It writes figures to docs/figures, and the tables into the page; or figures alone to FOLDER.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from maps import KINDS, NEVER, Maps, bands, median, read
from matplotlib.ticker import FormatStrFormatter
from tables import STRINGS, Errors, named, write_tables

from yehu_lab.plot.cells import (
    LABELS,
    draw_cells,
    draw_limits,
    limit_lines,
    regime_colours,
    regime_patches,
)
from yehu_lab.plot.sweep_maps import PERIOD_COLOURS, PERIODS
from yehu_server.core.physics.quantities import measured_body
from yehu_server.playing.pitch_and_level import note_name

ROOT = Path(__file__).resolve().parents[2]
BLUE, RED = "#1f5fa8", "#c03a2b"
ACROSS = 8
Array = Any


def panel(axes: Any, maps: Maps, i: int, cells: Array, **options: Any) -> Any:
    """Draw one map, with Schelleng's limits of note or bow `i`."""
    image = draw_cells(axes, maps.places, maps.forces, cells, log=(True, True), **options)
    draw_limits(axes, maps.places, maps.lower[i], maps.upper[i])
    axes.tick_params(labelsize=7)
    return image


def of_all_notes(strings: list[Maps], x: str, draw: Callable[[Any, Maps, int], Any]) -> Any:
    """Draw a map of every note on both strings; return the figure, the panels and an image."""
    every = [(k, maps, i) for k, maps in enumerate(strings) for i in range(len(maps.notes))]
    down = -(-len(every) // ACROSS)
    figure, panels = plt.subplots(
        down, ACROSS, figsize=(2.15 * ACROSS, 2.05 * down + 0.7), sharex=True, sharey=True,
        layout="constrained",
    )  # fmt: skip
    image: Any = None
    for axes, (k, maps, i) in zip(panels.flat, every, strict=False):
        image = draw(axes, maps, i)
        axes.set_title(named(maps.notes[i], k), fontsize=8, pad=2)
    for axes in panels.flat[len(every) :]:
        axes.set_visible(False)
    for axes in panels[:, 0]:
        axes.set_ylabel(LABELS["force"], fontsize=8)
    for axes in panels[-1]:
        axes.set_xlabel(LABELS[x], fontsize=8)
    return figure, panels, image


def regimes(strings: list[Maps], target: Path, errors: str) -> None:
    """Draw Schelleng's diagram of every note on both strings."""
    names = strings[0].facts["regimes"]
    figure, *_ = of_all_notes(
        strings,
        "position",
        lambda axes, maps, i: panel(axes, maps, i, maps.regime[i], **regime_colours(names)),
    )
    occurring = np.concatenate([np.unique(maps.regime) for maps in strings])
    handles = [*regime_patches(names, occurring), *limit_lines()]
    figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False)
    figure.suptitle(errors, fontsize=9)
    save(figure, target / "playability_schelleng.png")


def onsets(strings: list[Maps], target: Path) -> None:
    """Draw Guettler's diagram of every note on both strings."""

    def draw(axes: Any, maps: Maps, i: int) -> Any:
        shown = np.where(maps.periods[i] == NEVER, np.nan, maps.periods[i])
        return panel(axes, maps, i, shown, **PERIOD_COLOURS)

    figure, panels, image = of_all_notes(strings, "acceleration", draw)
    figure.colorbar(image, ax=panels, label=f"{PERIODS}; grey: never", aspect=50, pad=0.01)
    save(figure, target / "playability_guettler.png")


def forces(strings: list[Maps], target: Path) -> None:
    """Draw least and greatest force over the notes, beside Schelleng's limits."""
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.6), sharey=True, layout="constrained")
    for axes, maps, name in zip(panels, strings, STRINGS, strict=True):
        least, greatest = bands(maps)
        at = int(np.abs(np.log(maps.places / 0.13)).argmin())
        near = slice(max(0, at - 4), at + 5)
        for found, limit, colour, label in (
            (greatest, maps.upper, RED, "greatest"),
            (least, maps.lower, BLUE, "least"),
        ):
            middle = median(found[:, near])
            axes.plot(maps.notes, middle, "o-", color=colour, label=f"{label} force, measured")
            axes.plot(maps.notes, limit[:, at], "--", color=colour, label="Schelleng's limit")
        for frequency in measured_body().frequency_hz:
            note = 69.0 + 12.0 * np.log2(frequency / 440.0)
            if maps.notes[0] - 0.5 < note < maps.notes[-1] + 0.5:
                axes.axvline(note, color="0.7", lw=3, zorder=0)
        axes.set(yscale="log", title=f"{name}, β = 0.13, 0.2 m/s")
        axes.set_xticks(maps.notes, [note_name(float(note)) for note in maps.notes], rotation=90)
        axes.yaxis.set_major_formatter(FormatStrFormatter("%g"))
    panels[0].set_ylabel("bow force, N; grey: modes of the body")
    panels[0].legend(fontsize=8)
    save(figure, target / "playability_forces.png")


def repeats(both: list[Maps], target: Path, errors: str) -> None:
    """Draw how many of the bows make Helmholtz motion, and on how many cells they agree."""
    figure, panels = plt.subplots(
        1, len(both), figsize=(11, 4.6), layout="constrained", squeeze=False
    )
    image: Any = None
    for axes, maps in zip(panels[0], both, strict=True):
        share = maps.helmholtz.mean(axis=0)
        image = panel(axes, maps, 0, share, cmap="cividis", vmin=0.0, vmax=1.0)
        title = maps.facts["about"].rpartition(", ")[2]
        axes.set(title=title, xlabel=LABELS["position"], ylabel=LABELS["force"])
    figure.colorbar(image, ax=panels, label="share of sixteen bows in Helmholtz motion")
    figure.suptitle(errors, fontsize=9)
    save(figure, target / "playability_repeats.png")


def save(figure: Any, path: Path) -> None:
    figure.savefig(path, dpi=90)
    plt.close(figure)
    print(path)


def main() -> None:
    """Draw all figures, and write all tables."""
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "figures"
    found: dict[str, list[Maps]] = {
        kind: [maps for maps in (read(f"{kind}_{i}") for i in (1, 2)) if maps is not None]
        for kind in KINDS
    }
    errors = Errors.of(found["repeats"]).text
    regimes(found["schelleng"], target, errors)
    onsets(found["guettler"], target)
    forces(found["schelleng"], target)
    repeats(found["repeats"], target, errors)
    if len(sys.argv) == 1:
        write_tables(found)


if __name__ == "__main__":
    main()
