"""Draw Guettler diagrams: how soon a bow from rest makes Helmholtz motion, by law of friction.

    .venv/bin/python scripts/guettler_map.py [-o OUT.png] [--rate HZ]

The bow is on the string with a constant force and starts with a constant acceleration, up to
0.3 m/s. Counted are the periods until the string slips once a period, and goes on so ([Guettler]).
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from figures import save

from yehu_server.physics import kernel, layout
from yehu_server.physics.quantities import Quantities, override

Array = Any

LAWS = ("elasto-plastic", "thermal")
BETAS = (0.08, 0.13, 0.2)
FORCES = np.geomspace(0.05, 2.5, 28)  # N
ACCELERATIONS = np.geomspace(0.2, 20.0, 28)  # m/s^2
SPEED = 0.3  # m/s, at most
STRING, FINGER_X, PRESS = 1, 0.1, 1.5  # E5 on the outer string; m, N
LENGTH_S = 0.25
LASTING = 5  # periods with one slip each
SLIP = 0.05  # m/s of relative velocity
MOST = 50.0  # periods


def slips(v_r: Array, rate: float) -> Array:
    """Return the times (s) at which slips begin."""
    slipping = np.abs(v_r) > SLIP
    return np.flatnonzero(slipping[1:] & ~slipping[:-1]) / rate


def periods_until_regular(times: Array, period: float) -> float:
    """Return the number of periods from the first slip until one slip a period lasts."""
    if len(times) < LASTING + 1:
        return float("inf")
    regular = np.abs(np.diff(times) / period - 1.0) < 0.08
    for first in range(len(regular) - LASTING + 1):
        if regular[first : first + LASTING].all():
            return float((times[first] - times[0]) / period)
    return float("inf")


def start(
    quantities: Quantities, beta: float, force: float, acceleration: float, rate: float
) -> float:
    """Bow from rest; return the periods until the motion is regular."""
    model = kernel.prepare(quantities, rate)
    state = kernel.at_rest(model)
    frames = round(LENGTH_S * rate)
    time = np.arange(frames) / rate
    controls = np.zeros((frames, layout.control_columns(1)))
    settled = 0.03  # s, in which the finger comes down
    controls[:, layout.F_N] = -force if STRING == 1 else force
    controls[:, layout.V_B] = np.clip(acceleration * (time - settled), 0.0, SPEED)
    bridge_x = quantities.bridge_x
    controls[:, layout.X_B] = bridge_x - beta * (bridge_x - FINGER_X)
    controls[:, layout.FINGER_CONTROLS] = FINGER_X
    controls[:, layout.FINGER_CONTROLS + 1] = PRESS * np.minimum(1.0, time / 0.01)
    probes = np.zeros((frames, layout.probe_columns(1)))
    kernel.advance(model, state, controls, probes, None)
    string = quantities.strings[STRING]
    period = 2.0 * (bridge_x - FINGER_X) * float(np.sqrt(string.rho_A / string.T))
    v_r = probes[:, layout.RELATIVE_VELOCITY]
    return periods_until_regular(slips(v_r[time > settled], rate), period)


def guettler_picture(arguments: argparse.Namespace) -> None:
    """Simulate every cell, print a summary and write the picture."""
    rate = float(arguments.rate)
    instruments = [override(Quantities(), {"bow": {"friction": law}}) for law in LAWS]
    jobs = [
        (quantities, beta, force, acceleration, rate)
        for quantities in instruments
        for beta in BETAS
        for force in FORCES
        for acceleration in ACCELERATIONS
    ]
    with ThreadPoolExecutor(os.cpu_count()) as workers:  # the model runs without the GIL
        found = np.array(list(workers.map(lambda job: start(*job), jobs)))
    cells = found.reshape(len(LAWS), len(BETAS), len(FORCES), len(ACCELERATIONS))
    figure, panels = plt.subplots(
        len(LAWS), len(BETAS), figsize=(13, 8), sharex=True, sharey=True, layout="constrained"
    )
    image: Any = None
    for law, row, of_law in zip(LAWS, panels, cells, strict=True):
        for beta, axes, times in zip(BETAS, row, of_law, strict=True):
            image = draw(axes, times)
            axes.set_title(f"{law}, β = {beta:g}")
            print(summary(f"{law}, beta {beta:g}", times))
        row[0].set_ylabel("bow force, N")
    for axes in panels[-1]:
        axes.set_xlabel("acceleration of the bow, m/s²")
    figure.colorbar(
        image, ax=panels, label="periods until Helmholtz motion; grey: never", aspect=40
    )
    save(figure, arguments.output or Path("guettler.png"))


def draw(axes: Any, times: Array) -> Any:
    """Draw one diagram."""
    axes.set_facecolor("0.8")
    axes.set(xscale="log", yscale="log")
    shown = np.ma.masked_where(times > MOST, times)
    return axes.pcolormesh(ACCELERATIONS, FORCES, shown, vmin=0.0, vmax=20.0, cmap="viridis_r")


def summary(what: str, times: Array) -> str:
    """Return a line with the percentage of starts of some kinds."""
    within: Sequence[float] = (1.0, 5.0, 20.0)
    parts = [f"within {most:g} periods {100.0 * (times <= most).mean():3.0f}" for most in within]
    return f"{what:28} per cent: {', '.join(parts)}, never {100.0 * (times > MOST).mean():3.0f}"


def main() -> None:
    """Parse the command line and draw the picture."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, metavar="OUT.png")
    parser.add_argument("--rate", type=int, default=44100, metavar="HZ")
    guettler_picture(parser.parse_args())


if __name__ == "__main__":
    main()
