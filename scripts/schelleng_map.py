"""Draw Schelleng diagrams: the kind of motion over bow force, bow position and bow speed.

    .venv/bin/python scripts/schelleng_map.py [-o OUT.png] [--note F C] [--rate HZ]

One stopped note on each string is bowed in all combinations, with the force set in newtons. The
lines show Schelleng's upper and lower limits of the force.
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from figures import save
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from yehu_server.analysis.pitch import cents, note_name, pitch_hz
from yehu_server.controls.hands import FAST, FAST_SHARE
from yehu_server.engine.instrument import Instrument
from yehu_server.engine.output import BRIDGE_PRESSURE
from yehu_server.errors import ParameterError, YehuError
from yehu_server.params.table import find
from yehu_server.physics import kernel
from yehu_server.physics.layout import MAX_FINGERS
from yehu_server.physics.quantities import Quantities, StringQuantities
from yehu_server.physics.schelleng import bridge_resistance, lower_limit, upper_limit
from yehu_server.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    FARTHER,
    FIRM,
    LEAST_PRESS,
    LIGHT,
    TOP_SPEED,
    manner,
    share,
)
from yehu_server.player.calibration import OPEN_NOTES, PITCHES, frequency_hz
from yehu_server.player.intonation import position_of
from yehu_server.player.record import prepare_player
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.practices import shipped_practice
from yehu_server.playing.style import Style

Array = Any


# ---------------------------------------------------------------- Schelleng's diagram

STRINGS = ("F", "C")
BETAS = np.geomspace(0.04, 0.4, 16)
FORCES = np.geomspace(0.03, 5.0, 14)  # N
BOW_SPEEDS = (0.1, 0.2, 0.3)  # m/s
MANY_SPEEDS = np.geomspace(0.03, 0.6, 16)
USUAL_BETA = find("/bow/position").default
RAMP_MS, CELL_S, LAST_S = 40.0, 0.45, 0.15
ON_NOTE_CENTS, REGISTER_CENTS = 30.0, 600.0
# Limits of the bridge force relative to that of Helmholtz motion. Notes on pitch reach 0.9 to 1.1
# with one slip per period (up to 2 near nodes, far from the bridge), and 0.3 to 0.6 with several.
FULL, BARELY = 0.7, 0.15

KINDS = (
    ("Helmholtz motion: on the note, in full", "#3f9b57"),
    ("on the note but weak: several slips a period", "#b5dba0"),
    ("higher register: flageolet, multiple slip", "#4a86c5"),
    (f"pulled off the note, {ON_NOTE_CENTS:g} to {REGISTER_CENTS:g} cents", "#f2d35b"),
    ("lower register: raucous, anomalous low", "#d9762b"),
    ("no clear pitch: scratch", "#8b3a3a"),
    ("barely sounding", "#ececec"),
)
HELMHOLTZ, WEAK, HIGHER, PULLED, LOWER, SCRATCH, FAINT = range(len(KINDS))


@dataclass(frozen=True)
class Stop:
    """A stopped note on one string of the tuned instrument."""

    string: int
    note: int
    quantities: Quantities
    player: Any  # a record of player.record.PLAYER
    rate: float

    def manner(self, column: int) -> float:
        """Return how the player bows the note; see player.bowing."""
        return manner(self.player["bowing"], self.string, USUAL_BETA, float(self.note), column)

    @property
    def silk(self) -> StringQuantities:
        """Return the quantities of the string."""
        return self.quantities.strings[self.string]

    @property
    def impedance(self) -> float:
        """Return the wave impedance Z of the string (kg/s)."""
        return math.sqrt(self.silk.T * self.silk.rho_A)

    @property
    def grip(self) -> float:
        """Return the difference of the static and the dynamic friction coefficient."""
        return self.quantities.bow.mu_S - self.quantities.bow.mu_C

    @property
    def frequency(self) -> float:
        """Return the nominal frequency (Hz)."""
        return frequency_hz(self.note, 440.0)

    def highest_force(self, speed: Array, beta: Array) -> Array:
        """Return Schelleng's upper limit of the bow force (N)."""
        return np.asarray(upper_limit(self.impedance, self.grip, speed, beta))

    def lowest_force(self, speed: Array, beta: Array) -> Array:
        """Return Schelleng's lower limit of the bow force (N)."""
        model = kernel.prepare(self.quantities, self.rate, MAX_FINGERS)[0]
        resistance = bridge_resistance(model, self.frequency)
        return np.asarray(lower_limit(self.impedance, self.grip, resistance, speed, beta))


def bow(stop: Stop, speed: float, beta: float, force: float) -> int:
    """Bow a note with a force in newtons and return the kind of motion at its end.

    The output is the force on the bridge without the body's resonances. In Helmholtz motion this
    force is a sawtooth with jumps of 2 Z v_b / beta, independent of the bow force.
    """
    instrument = Instrument(stop.rate, stop.quantities)
    place = position_of(stop.player, stop.string, float(stop.note), speed, 0.0)
    press = max(find("/playing/press").default, stop.manner(LEAST_PRESS))
    for address, value in (
        ("/body/blend", 1.0),
        ("/bow/assist", 0.0),
        ("/bow/force", force),
        ("/bow/position", beta),
        ("/finger/1/position", place),
        ("/finger/1/press", press),
    ):
        instrument.write(address, value, ramp_ms=0.0)
    instrument.write("/bow/side", 1.0 if stop.string == 0 else -1.0)
    instrument.write("/bow/speed", speed, ramp_ms=RAMP_MS)
    out = np.zeros(round(CELL_S * stop.rate), np.float32)
    instrument.process(out)
    last = out[-round(LAST_S * stop.rate) :]
    helmholtz = BRIDGE_PRESSURE * 2.0 * stop.impedance * speed / beta / math.sqrt(12.0)
    found = pitch_hz(last, stop.rate, lo=0.22 * stop.frequency, hi=6.5 * stop.frequency)
    error = cents(found, stop.frequency) if math.isfinite(found) else math.nan
    return kind(error, float(last.std()) / helmholtz)


def kind(error: float, strength: float) -> int:
    """Classify motion by pitch error (cents) and strength (bridge force over Helmholtz's)."""
    if strength < BARELY:
        return FAINT
    if math.isnan(error):
        return SCRATCH
    if abs(error) <= ON_NOTE_CENTS:
        return HELMHOLTZ if strength >= FULL else WEAK
    if abs(error) < REGISTER_CENTS:
        return PULLED
    return HIGHER if error > 0.0 else LOWER


def edges(values: Array) -> Array:
    """Return the edges of cells centred on logarithmically spaced values."""
    half = math.sqrt(values[1] / values[0])
    return np.append(values / half, values[-1] * half)


def along(values: Array) -> Array:
    """Return points of a line across all cells of these values."""
    first, *_, last = edges(values)
    return np.geomspace(float(first), float(last), 60)


def player_force(stop: Stop, speed: Array, beta: float, wish: float) -> Array:
    """Return the force (N) that the player's assist sets for a value of ``/playing/pressure``."""
    fast = FAST_SHARE * np.minimum(1.0, (np.asarray(speed) / FAST) ** 2)
    flautando, light, firm = map(stop.manner, (AT_FLAUTANDO, AT_LIGHT, AT_FIRM))
    usual = share(flautando, light, firm, wish, stop.string)
    return (usual + fast) * stop.highest_force(speed, beta)


def draw_map(axes: Any, x: Array, kinds: Sequence[int]) -> None:
    """Draw the kinds of motion as cells of force over `x`, one row for each of FORCES."""
    colours = ListedColormap([colour for _, colour in KINDS])
    norm = BoundaryNorm(np.arange(len(KINDS) + 1) - 0.5, len(KINDS))
    cells = np.reshape(kinds, (len(FORCES), len(x)))
    axes.pcolormesh(edges(x), edges(FORCES), cells, cmap=colours, norm=norm, edgecolors="w", lw=0.4)
    x_edges, y_edges = edges(x), edges(FORCES)
    axes.set(xscale="log", yscale="log", xlim=x_edges[[0, -1]], ylim=y_edges[[0, -1]])
    axes.set_yticks([0.05, 0.1, 0.2, 0.5, 1, 2, 5], labels=["0.05", "0.1", "0.2", "0.5", 1, 2, 5])
    axes.minorticks_off()


def draw_limits(axes: Any, x: Array, highest: Array, lowest: Array) -> None:
    """Draw Schelleng's two limits as lines with a white outline."""
    halo = [withStroke(linewidth=3.5, foreground="w")]
    axes.plot(x, highest, "k-", lw=1.6, path_effects=halo)
    axes.plot(x, lowest, "k--", lw=1.6, path_effects=halo)


def draw_over_beta(axes: Any, stop: Stop, speed: float, kinds: Sequence[int]) -> None:
    """Draw force over bow position, at one bow speed."""
    draw_map(axes, BETAS, kinds)
    x = along(BETAS)
    draw_limits(axes, x, stop.highest_force(speed, x), stop.lowest_force(speed, x))
    if speed <= stop.manner(TOP_SPEED):
        beta = USUAL_BETA * stop.manner(FARTHER)
        ends = [float(player_force(stop, speed, beta, wish)) for wish in (LIGHT, FIRM)]
        axes.plot([beta, beta], ends, color="k", lw=2.5, marker="_", ms=9, mew=2.5)
    axes.set_xticks([0.05, 0.1, 0.2, 0.4], labels=["0.05", "0.1", "0.2", "0.4"])
    axes.set(title=f"{title(stop)}, {speed:g} m/s", xlabel="bow position β")


def draw_over_speed(axes: Any, stop: Stop, kinds: Sequence[int]) -> None:
    """Draw force over bow speed, at the usual bow position."""
    draw_map(axes, MANY_SPEEDS, kinds)
    x = along(MANY_SPEEDS)
    draw_limits(axes, x, stop.highest_force(x, USUAL_BETA), stop.lowest_force(x, USUAL_BETA))
    if stop.manner(FARTHER) == 1.0:
        borne = x[x <= stop.manner(TOP_SPEED)]
        for wish in (LIGHT, FIRM):
            axes.plot(borne, player_force(stop, borne, USUAL_BETA, wish), "k:", lw=2.0)
    axes.set_xticks([0.03, 0.1, 0.2, 0.3, 0.6], labels=["0.03", "0.1", "0.2", "0.3", "0.6"])
    axes.set(title=f"{title(stop)}, β = {USUAL_BETA:g}", xlabel="bow speed, m/s")


def title(stop: Stop) -> str:
    """Return the title of a panel: the note and its string."""
    return f"{note_name(stop.note)} on {STRINGS[stop.string]}"


def schelleng_picture(arguments: argparse.Namespace) -> None:
    """Simulate every cell, print a summary and write the picture."""
    for string, note, lowest, highest in zip(
        STRINGS, arguments.note, OPEN_NOTES, [max(each) for each in PITCHES], strict=True
    ):
        if not lowest < note <= highest:
            raise ParameterError(f"{string} string: stopped notes are {lowest + 1} to {highest}")
    rate = float(arguments.rate)
    calibration = calibration_for(rate)
    instrument = Style().instrument(rate, calibration)
    values = instrument.start_values
    player = prepare_player(
        instrument.quantities,
        rate,
        values,
        calibration=calibration,
        bowing=shipped_practice(rate),
    )[0]
    stops = [
        Stop(i, note, instrument.quantities, player, rate) for i, note in enumerate(arguments.note)
    ]
    jobs = []
    for stop in stops:
        for speed in BOW_SPEEDS:
            jobs += [(stop, speed, beta, force) for force in FORCES for beta in BETAS]
        jobs += [(stop, speed, USUAL_BETA, force) for force in FORCES for speed in MANY_SPEEDS]
    with ThreadPoolExecutor(os.cpu_count()) as workers:  # the model runs without the GIL
        kinds = list(workers.map(lambda job: bow(*job), jobs))

    across, size = len(BOW_SPEEDS) + 1, len(FORCES) * len(BETAS)
    figure, panels = plt.subplots(
        len(stops), across, figsize=(16, 4.2 * len(stops) + 1.2), sharey=True, layout="constrained"
    )
    for row, stop in enumerate(stops):
        for column, axes in enumerate(panels[row]):
            at = (row * across + column) * size
            own = kinds[at : at + size]
            if column < len(BOW_SPEEDS):
                draw_over_beta(axes, stop, BOW_SPEEDS[column], own)
            else:
                draw_over_speed(axes, stop, own)
            print(summary(axes.get_title(), own))
        panels[row][0].set_ylabel("bow force, N")
    figure.legend(handles=legend(), loc="outside lower center", ncols=4, frameon=False)
    save(figure, arguments.output or Path("schelleng.png"))


def summary(what: str, kinds: Sequence[int]) -> str:
    """Return a line with the percentage of each kind of motion in a panel."""
    counts = np.bincount(kinds, minlength=len(KINDS)) * 100.0 / len(kinds)
    words = ("full", "weak", "higher", "pulled", "lower", "scratch", "faint")
    parts = (f"{word} {count:2.0f}" for word, count in zip(words, counts, strict=True))
    return f"{what:24} per cent: {', '.join(parts)}"


def legend() -> list[Any]:
    """Return the legend of colours and lines."""
    patches = [Patch(facecolor=colour, edgecolor="0.6", label=text) for text, colour in KINDS]
    lines = [
        Line2D([], [], color="k", ls="-", label="Schelleng's upper limit"),
        Line2D([], [], color="k", ls="--", label="Schelleng's lower limit, R = Re(1/Y)"),
        Line2D([], [], marker="|", ms=13, mew=2.5, color="k", ls="", label="the player's forces"),
        Line2D([], [], color="k", ls=":", lw=2.0, label="the player's lightest and firmest"),
    ]
    return [*patches, *lines]


# ---------------------------------------------------------------- the command line


def main() -> None:
    """Parse the command line and draw the picture."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, metavar="OUT.png")
    parser.add_argument("--rate", type=int, default=44100, metavar="HZ")
    parser.add_argument(
        "--note",
        nargs=2,
        type=int,
        default=(70, 77),
        metavar=STRINGS,
        help="MIDI note of the stopped note on each string (default: 70 77)",
    )
    try:
        schelleng_picture(parser.parse_args())
    except YehuError as error:
        parser.exit(2, f"{parser.prog}: {error}\n")


if __name__ == "__main__":
    main()
