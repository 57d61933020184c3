"""Where the model can be bowed, and the forces by which the player bows it.

A stopped note on each string is bowed with forces over bow positions at three speeds, and over bow
speeds. The rule of docs/sweep.md names the regimes; the lines are Schelleng's limits of the force.
"""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

from pictures.saving import save
from yehu_lab.plot.cells import LABELS, limit_lines, regime_patches
from yehu_lab.plot.study import draw_limits_over
from yehu_lab.plot.sweep_maps import draw_map, map_of
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_server.core.controls.kernel_controls import EXTRA_SHARE, EXTRA_SHARE_SPEED
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.schelleng import upper_limit
from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    DISTANCE_FACTOR,
    FIRM,
    LIGHT,
    MIN_PRESS,
    TOP_SPEED,
    bow_pressure_for,
    bowing_value,
)
from yehu_server.params.table import find
from yehu_server.playing.bowing_tables import shipped_bowing_table
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.pitch_and_level import note_name

Array = Any

RATE = 44100.0
STOPPED = {"F4": 70, "C5": 77}  # the note that is bowed on each string
NAMES = tuple(STOPPED)
FORCES = {"from": 0.03, "to": 5.0, "steps": 13, "spread": "log"}  # N
BETAS = {"from": 0.04, "to": 0.4, "steps": 13, "spread": "log"}
SPEEDS = {"from": 0.03, "to": 0.6, "steps": 13, "spread": "log"}  # m/s
THREE = (0.1, 0.2, 0.3)  # m/s
USUAL_BETA = find("/bow/position").default
STROKE = {"acceleration": 10.0, "noise": find("/bow/noise").default}
HALVED = 2  # times a step is, where regimes meet


class Player:
    """How the player bows one note on one string of the tuned instrument."""

    def __init__(self, string: int, note: int) -> None:
        tuned = calibration_for(RATE).tuned(Quantities())
        silk, bow = tuned.strings[string], tuned.bow
        self.string, self.note = string, note
        self.bowing = shipped_bowing_table(RATE)
        self.impedance = float(np.sqrt(silk.T * silk.rho_A))
        self.grip = bow.mu_S - bow.mu_C

    def bowing_value(self, column: int) -> float:
        """A column of the bowing table; see player.bowing."""
        return bowing_value(self.bowing, self.string, USUAL_BETA, float(self.note), column)

    def force(self, speed: Array, beta: float, command: float) -> Array:
        """The force (N) that the player's assist sets for a value of ``/playing/pressure``."""
        fast = EXTRA_SHARE * np.minimum(1.0, (np.asarray(speed) / EXTRA_SHARE_SPEED) ** 2)
        flautando, light, firm = map(self.bowing_value, (AT_FLAUTANDO, AT_LIGHT, AT_FIRM))
        usual = bow_pressure_for(flautando, light, firm, command, self.string)
        highest = speed * upper_limit(self.impedance, self.grip, 1.0, beta)  # it goes as the speed
        return (usual + fast) * highest


def bowed(player: Player, vary: dict[str, Any]) -> Result:
    """Bow the note in all combinations."""
    press = max(find("/playing/press").default, player.bowing_value(MIN_PRESS))
    stroke = {"string": player.string + 1, "note": player.note, "press": press}
    along = next(name for name in ("position", "speed") if isinstance(vary.get(name), dict))
    return sweep(
        study_of(
            {
                "sample_rate": RATE,
                "duration": 0.4,
                "stroke": STROKE | stroke,
                "vary": {"force": FORCES} | vary,
                "refine": {"axes": ["force", along], "levels": HALVED},
            }
        )
    )


def draw(axes: Any, found: Result, x: str, at: dict[str, int]) -> None:
    """Draw regimes over force and another quantity, and Schelleng's limits."""
    cells = map_of(found, found.grid("regime"), x, "force", at)
    draw_map(axes, found, x, "force", cells, "regime")
    draw_limits_over(axes, found, found.study(), x, "force", at)
    axes.set(xlabel=LABELS[x], ylabel="")
    shares = np.bincount(cells.astype(int).ravel(), minlength=len(found.regimes)) / cells.size
    words = [
        f"{name} {100 * part:.0f}"
        for name, part in zip(found.regimes, shares, strict=False)
        if part
    ]
    print(f"{axes.get_title():16} per cent: {', '.join(words)}")


def draw_note(panels: Any, player: Player) -> list[Result]:
    """Draw the maps of one note: a row."""
    title = f"{note_name(player.note)} on {NAMES[player.string]}"
    places = bowed(player, {"speed": list(THREE), "position": BETAS})
    for i, speed in enumerate(THREE):
        panels[i].set_title(f"{title}, {speed:g} m/s")
        draw(panels[i], places, "position", {"speed": i})
        if speed <= player.bowing_value(TOP_SPEED):
            beta = USUAL_BETA * player.bowing_value(DISTANCE_FACTOR)
            ends = [float(player.force(speed, beta, command)) for command in (LIGHT, FIRM)]
            panels[i].plot([beta, beta], ends, color="k", lw=2.5, marker="_", ms=9, mew=2.5)
    speeds = bowed(player, {"position": [USUAL_BETA], "speed": SPEEDS})
    panels[-1].set_title(f"{title}, β = {USUAL_BETA:g}")
    draw(panels[-1], speeds, "speed", {"position": 0})
    if player.bowing_value(DISTANCE_FACTOR) == 1.0:
        borne = speeds.axes["speed"]
        borne = borne[borne <= player.bowing_value(TOP_SPEED)]
        for command in (LIGHT, FIRM):
            panels[-1].plot(borne, player.force(borne, USUAL_BETA, command), "k:", lw=2.0)
    panels[0].set_ylabel(LABELS["force"])
    return [places, speeds]


def draw_all(figures: Path, _sounds: Path) -> None:
    """Bow both notes, print how often there was each regime, and write the picture."""
    size = (16, 4.2 * len(NAMES) + 1.2)
    figure, panels = plt.subplots(
        len(NAMES), len(THREE) + 1, figsize=size, sharey=True, layout="constrained"
    )
    found: list[Result] = []
    for i, (row, note) in enumerate(zip(panels, STOPPED.values(), strict=True)):
        found += draw_note(row, Player(i, note))
    occurring = np.concatenate([np.unique(each.grid("regime")) for each in found])
    lines = [
        Line2D([], [], marker="|", ms=13, mew=2.5, color="k", ls="", label="the player's forces"),
        Line2D([], [], color="k", ls=":", lw=2.0, label="the player's lightest and firmest"),
    ]
    handles = [*regime_patches(found[0].regimes, occurring), *limit_lines(), *lines]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
    save(figure, figures / "schelleng.png")
