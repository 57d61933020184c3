"""Schelleng's and Guettler's diagrams with torsion, with wide hair and with both; and their sound.

    .venv/bin/python scripts/playability_study/torsion_and_width.py [FOLDER]

It draws docs/figures/playability_refined_*.png and writes two tables into docs/playability.md, in
some ten minutes. Sweeps that FOLDER already has are not run again.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from draw import ROOT, save
from maps import band
from scipy.signal import welch
from tables import BETA, SOON, named, table, write_table

from yehu_lab.plot.cells import LABELS, draw_cells, regime_colours, regime_patches
from yehu_lab.plot.sweep_maps import PERIOD_COLOURS, PERIODS
from yehu_lab.regimes.columns import HELMHOLTZ
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.running import sweep_to
from yehu_lab.sweeps.study import study_of
from yehu_server.simulation.run import simulate

WIDTH = 0.008  # m
KINDS = {
    "plain": ("off", 0.0),
    "torsion": ("on", 0.0),
    "hair 8 mm wide": ("off", WIDTH),
    "both": ("on", WIDTH),
}
NOTES = ((1, 70), (2, 77))  # string, note
FORCES = {"from": 0.03, "to": 6.0, "steps": 25, "spread": "log"}
INSTRUMENT = {"instrument.torsion": ["off", "on"], "instrument.bow.width": [0.0, WIDTH]}
ALONG: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "position": (
        {"speed": 0.2, "acceleration": 10.0},
        {"from": 0.04, "to": 0.4, "steps": 25, "spread": "log"},
    ),
    "acceleration": (
        {"speed": 0.3, "position": BETA},
        {"from": 0.3, "to": 40.0, "steps": 25, "spread": "log"},
    ),
}
STROKE = {"speed": 0.2, "acceleration": 10.0, "position": BETA}
LOUD = (0.3, 0.5, 0.8, 1.2, 1.8)  # N
LOW, HIGH = 2000.0, 8000.0  # Hz
RATE = 44100.0


def maps(folder: Path, string: int, note: int, x: str) -> Result:
    """The strokes of all kinds of instrument, on one note."""
    stroke, places = ALONG[x]
    target = folder / f"{x}_{note}.npz"
    if not target.exists():
        vary = {**INSTRUMENT, "force": FORCES, x: places}
        data = {"sample_rate": RATE, "duration": 0.3, "vary": vary}
        sweep_to(study_of(data | {"stroke": {"string": string, "note": note, **stroke}}), target)
    return Result.load(target)


def of_kind(result: Result, grid: Any, kind: str) -> Any:
    """The cells of one kind of instrument: force by place."""
    axes = [list(result.axes[name]) for name in INSTRUMENT]
    return grid[tuple(axis.index(value) for axis, value in zip(axes, KINDS[kind], strict=True))]


def brightness_db(kind: str, string: int, note: int, force: float) -> float:
    """The share of the pressure's power that is in 2 to 8 kHz (dB), in a steady note."""
    torsion, width = KINDS[kind]
    stroke = {"string": string, "note": note, "force": force, **STROKE}
    instrument = {"torsion": torsion, "bow": {"width": width}}
    study = study_of(
        {"sample_rate": RATE, "duration": 0.6, "stroke": stroke, "instrument": instrument}
        | {"vary": {"force": [force]}}
    )
    pressure = simulate(study.bow.gesture(study.axes, [0])).arrays["pressure"]
    frequency, power = welch(pressure[round(0.3 * RATE) :], RATE, nperseg=4096)
    high = power[(frequency >= LOW) & (frequency < HIGH)].sum()
    return float(10.0 * np.log10(high / power[frequency > 50.0].sum()))


def draw(found: dict[tuple[str, int], Result], target: Path) -> None:
    """Draw a figure of each diagram: a row for each note, a column for each kind."""
    for x, name in (("position", "schelleng"), ("acceleration", "guettler")):
        figure, panels = plt.subplots(
            len(NOTES),
            len(KINDS),
            figsize=(13, 6.4),
            sharex=True,
            sharey=True,
            layout="constrained",
        )
        image: Any = None
        occurring: list[Any] = []
        for row, (string, note) in zip(panels, NOTES, strict=True):
            result = found[x, note]
            options = regime_colours(result.regimes) if x == "position" else PERIOD_COLOURS
            grid = result.grid("regime") if x == "position" else result.onset_periods()
            occurring.append(np.unique(result.columns["regime"]))
            for axes, kind in zip(row, KINDS, strict=True):
                cells = of_kind(result, grid, kind)
                places, force = result.axes[x], result.axes["force"]
                image = draw_cells(axes, places, force, cells, log=(True, True), **options)
                axes.set_title(f"{named(note, string - 1)}, {kind}", fontsize=9)
                axes.set_xlabel(LABELS[x], fontsize=8)
            row[0].set_ylabel(LABELS["force"], fontsize=8)
        if x == "position":
            patches = regime_patches(found[x, NOTES[0][1]].regimes, np.concatenate(occurring))
            figure.legend(handles=patches, loc="outside lower center", ncols=5, frameon=False)
        else:
            figure.colorbar(image, ax=panels, label=f"{PERIODS}; grey: never")
        save(figure, target / f"playability_refined_{name}.png")


def shares(found: dict[tuple[str, int], Result]) -> list[str]:
    """What the diagrams say of each kind."""
    rows = []
    for kind in KINDS:
        row = [kind]
        for _, note in NOTES:
            result = found["position", note]
            regimes = of_kind(result, result.grid("regime"), kind)
            cells = regimes == HELMHOLTZ
            aperiodic = np.mean(regimes == result.regimes.index("aperiodic"))
            at = int(np.abs(np.log(result.axes["position"] / BETA)).argmin())
            bands = [band(result.axes["force"], cells[:, j]) for j in range(at - 2, at + 3)]
            least, greatest = np.nanmedian(bands, axis=0)
            starts = found["acceleration", note]
            periods = of_kind(starts, starts.onset_periods(), kind)
            row += [f"{100 * cells.mean():.1f} %", f"{100 * aperiodic:.1f} %"]
            row.append(f"{least:.2f} to {greatest:.1f}")
            row.append(f"{100 * np.nan_to_num(periods <= SOON).mean():.1f} %")
        rows.append(row)
    head = ["instrument"]
    for string, note in NOTES:
        name = named(note, string - 1)
        head += [
            f"{name}: Helmholtz",
            "aperiodic",
            "force at β = 0.13, N",
            f"within {SOON} periods",
        ]
    return table(head, rows)


def sounds() -> list[str]:
    """How bright each kind is at some forces."""
    rows = []
    for string, note in NOTES:
        for kind in KINDS:
            each = [f"{brightness_db(kind, string, note, force):.1f}" for force in LOUD]
            rows.append([named(note, string - 1), kind, *each])
            print(*rows[-1], sep=" | ", flush=True)
    return table(["note", "instrument", *(f"{force:g} N" for force in LOUD)], rows)


def main() -> None:
    """Run what is not done, draw, and write the tables."""
    with TemporaryDirectory() as temporary:
        folder = Path(sys.argv[1] if len(sys.argv) > 1 else temporary)
        folder.mkdir(parents=True, exist_ok=True)
        found = {(x, note): maps(folder, string, note, x) for x in ALONG for string, note in NOTES}
    draw(found, ROOT / "docs" / "figures")
    write_table("refined", shares(found))
    write_table("brightness", sounds())


if __name__ == "__main__":
    main()
