"""Where each note can be bowed: Schelleng's diagrams of all notes, and the forces at one place.

Coarser than the maps whose shares docs/playability.md gives, on the same strokes.
"""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from pictures.saving import save
from yehu_lab.plot.cells import LABELS, limit_lines, regime_patches
from yehu_lab.plot.study import draw_limits_over
from yehu_lab.plot.sweep_maps import draw_map, map_of
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_lab.sweeps.thresholds import thresholds_of
from yehu_server.params.table import find
from yehu_server.playing.pitch_and_level import note_name

NOTES = {"F4": range(65, 78), "C5": range(72, 90)}
STROKE = {"speed": 0.2, "acceleration": 10.0, "noise": find("/bow/noise").default}
FORCES = {"from": 0.03, "to": 6.0, "steps": 12, "spread": "log"}  # N
BETAS = {"from": 0.04, "to": 0.4, "steps": 12, "spread": "log"}
USUAL = [find("/bow/position").default]
COLUMNS = 8


def bowed(string: int, notes: range, places: Any, refine: list[str]) -> Result:
    """All notes of a string, over force and place."""
    study = {
        "duration": 0.3,
        "instrument": {"felt_loss": 0.0},
        "stroke": STROKE | {"string": string},
        "vary": {"note": list(notes), "force": FORCES, "position": places},
        "refine": {"axes": refine, "levels": 1},
    }
    return sweep(study_of(study))


def draw_maps(figures: Path) -> None:
    """Regimes over place and force, of every note."""
    rows = [-(-len(notes) // COLUMNS) for notes in NOTES.values()]
    figure, panels = plt.subplots(
        sum(rows), COLUMNS, figsize=(18, 2.4 * sum(rows) + 0.8), sharex=True, sharey=True,
        layout="constrained",
    )  # fmt: skip
    occurring: list[Any] = []
    for i, (name, notes) in enumerate(NOTES.items()):
        found = bowed(i + 1, notes, BETAS, ["force", "position"])
        first, places = sum(rows[:i]), panels[sum(rows[:i]) : sum(rows[: i + 1])].ravel()
        for j, axes in enumerate(places):
            if j >= len(notes):
                axes.set_axis_off()
                continue
            at = {"note": j}
            cells = map_of(found, found.grid("regime"), "position", "force", at)
            draw_map(axes, found, "position", "force", cells, "regime")
            draw_limits_over(axes, found, found.study(), "position", "force", at)
            axes.set(xlabel="", ylabel="", title=f"{note_name(notes[j])}, {name}")
        panels[first, 0].set_ylabel(LABELS["force"])
        occurring.append(np.unique(found.grid("regime")))
    for axes in panels[-1]:
        axes.set_xlabel(LABELS["position"])
    handles = [*regime_patches(found.regimes, np.concatenate(occurring)), *limit_lines()]
    figure.legend(handles=handles, loc="outside lower center", ncols=6, frameon=False)
    save(figure, figures / "playability_schelleng.png")


def draw_forces(figures: Path) -> None:
    """Least and greatest force of every note, and what should keep it."""
    figure, panels = plt.subplots(1, 2, figsize=(14, 4.6), sharey=True, layout="constrained")
    for i, (axes, (name, notes)) in enumerate(zip(panels, NOTES.items(), strict=True)):
        found = thresholds_of(bowed(i + 1, notes, USUAL, ["force"]))
        names = [note_name(note) for note in notes]
        for key, style, label in (
            ("start", "C0o-", "least from rest"),
            ("keep", "C0--", "lower limit: keeps a motion"),
            ("greatest", "C3o-", "greatest"),
            ("bear", "C3--", "upper limit"),
        ):
            axes.semilogy(names, [getattr(each, key) for each in found], style, label=label)
        axes.set(title=f"{name} string", xlabel="note")
        axes.tick_params(axis="x", labelrotation=60)
    panels[0].set_ylabel(LABELS["force"])
    panels[1].legend(frameon=False, loc="lower left")
    save(figure, figures / "playability_forces.png")


def draw_all(figures: Path, _sounds: Path) -> None:
    """Bow all notes, and write both pictures."""
    draw_forces(figures)
    draw_maps(figures)
