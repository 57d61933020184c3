"""The figures of bench/results/validation.md."""

from collections.abc import Mapping
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from pictures.saving import ROOT, save

from validation import ideal, laws, monochord, published
from validation.tables import KINDS
from yehu_server import body

FIGURES = ROOT / "docs" / "figures"
BETA = 0.117


def draw(found: Mapping[str, Any]) -> None:
    """Draw all of them."""
    save(ideal_string(found["ideal"]), FIGURES / "validation_ideal.png", dpi=80)
    save(convergence(found["convergence"]), FIGURES / "validation_convergence.png", dpi=80)
    save(friction_laws(), FIGURES / "validation_laws.png", dpi=80)
    save(measured(found), FIGURES / "validation_measured.png", dpi=80)


def ideal_string(found: Mapping[str, Any]) -> Any:
    """A steady note with its closed form; the limits with Schelleng's."""
    figure, panels = plt.subplots(1, 3, figsize=(15.0, 4.6), layout="constrained")
    quantities = ideal.instrument()
    force = ideal.ORDINARY * ideal.greatest_force(quantities, BETA)
    run = ideal.run(quantities, BETA, force, ideal.SETTLE_S)
    cycle, wave = ideal.period(quantities), ideal.impedance(quantities)
    time = run.arrays["time"]
    part = time >= time[-1] - 4.0 * cycle
    starts = ideal.slips_of(run, BETA)
    periods = (time[part] - starts[starts >= time[-1] - 4.0 * cycle][0]) / cycle
    velocity, bridge = run.arrays["relative_velocity"][part], run.arrays["bridge_force_1"][part]
    panels[0].plot(periods, velocity, lw=0.9, label="model")
    ideal_velocity = np.where(periods % 1.0 < BETA, -ideal.SPEED / BETA, 0.0)
    panels[0].plot(periods, ideal_velocity, "k--", lw=1.0, label="Helmholtz")
    panels[0].set(xlabel="periods", ylabel="string on hair, m/s", title="Rigid ends, β = 0.117")
    panels[0].legend(frameon=False, loc="lower left")
    jump = 2.0 * wave * ideal.SPEED / BETA
    panels[1].plot(periods, bridge - bridge.mean(), lw=0.9, label="model")
    saw = jump * (0.5 - (periods - _phase(periods, bridge)) % 1.0)
    sign = np.sign(saw @ (bridge - bridge.mean()))
    panels[1].plot(periods, sign * saw, "k--", lw=1.0, label="sawtooth 2 Z v/β")
    panels[1].set(xlabel="periods", ylabel="force at the bridge, N", title="The same")
    panels[1].legend(frameon=False, loc="lower left")
    for name, colour in (("least", "#1f5fa8"), ("greatest", "#c03a2b")):
        beta, measured, theory = (
            np.array([row[key] for row in found[name]]) for key in ("beta", "limit", "schelleng")
        )
        panels[2].loglog(beta, measured, "o", color=colour, label=f"{name} force")
        panels[2].loglog(beta, theory, "--", color=colour)
    panels[2].set(xlabel="β", ylabel="bow force, N", title="On a dashpot; lines: Schelleng")
    panels[2].set_xticks(ideal.BETAS, [f"{beta:g}" for beta in ideal.BETAS])
    panels[2].minorticks_off()
    panels[2].legend(frameon=False, loc="center right")
    return figure


def _phase(periods: Any, force: Any) -> float:
    """When the force jumps (periods)."""
    return float(periods[1:][np.abs(np.diff(force)).argmax()])


def convergence(found: Mapping[str, Any]) -> Any:
    """Shares of regimes and cells alike, over the rate, with the bars of grid and hair."""
    figure, panels = plt.subplots(1, 3, figsize=(15.0, 4.4), layout="constrained")
    rates = [name for name in KINDS if name.startswith("rate")]
    khz = [float(name.split()[1]) / 1e3 for name in rates]
    for (note, maps), colour in zip(found.items(), ("C0", "C1", "C2", "C3"), strict=True):
        by_name = {row["map"]: row for row in maps}
        seeds = [row for row in maps if row["map"].startswith("seed")]
        grids = [row for row in maps if row["map"].startswith("grid")]
        for ax, key in zip(panels, ("helmholtz", "aperiodic", "cents"), strict=True):
            ax.semilogx(khz, [by_name[name][key] for name in rates], "o-", color=colour, label=note)
            for others, place in ((seeds, 38.0), (grids, 41.0)):
                values = [row[key] for row in others]
                if key == "cents":  # of the map at 44.1 kHz
                    values = [value + by_name[rates[0]][key] for value in values]
                ax.plot([place] * 2, [min(values), max(values)], color=colour, lw=3, alpha=0.5)
    for ax, label in zip(
        panels,
        ("share of Helmholtz motion", "share of aperiodic motion", "cents off 352.8 kHz, median"),
        strict=True,
    ):
        ax.set(xlabel="sample rate, kHz", ylabel=label)
        ax.set_xticks(khz, [f"{each:g}" for each in khz])
        ax.minorticks_off()
    panels[0].legend(frameon=False)
    return figure


def friction_laws() -> Any:
    """Four periods of a stroke by each law, and the friction that its hair has over its slip."""
    figure, panels = plt.subplots(
        2, len(laws.LAWS), figsize=(16.0, 6.4), sharey="row", layout="constrained"
    )
    for (above, below), law in zip(panels.T, laws.LAWS, strict=True):
        run = laws.stroke(law)
        last = run["time"] >= run["time"][-1] - 4.0 / 466.16
        since = 1e3 * (run["time"][last] - run["time"][last][0])
        above.plot(since, run["relative_velocity"][last], lw=0.8)
        below.plot(run["relative_velocity"][last], run["coefficient"][last], lw=0.6)
        above.set(title=law, xlabel="ms")
        below.set(xlabel="string on hair, m/s")
    panels[0, 0].set_ylabel("string on hair, m/s")
    panels[1, 0].set_ylabel("friction over bow force")
    return figure


def measured(found: Mapping[str, Any]) -> Any:
    """The filter of the published scale, by notes, with ours; Guettler's wedge."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(12.0, 4.4), layout="constrained")
    filtered = np.array(found["published"]["filtered"])
    numbers = np.arange(1, published.HARMONICS + 1)
    hertz = np.outer([hertz for _, hertz, _ in published.NOTES], numbers)
    own = 20.0 * np.log10(np.abs(body.load().radiation(hertz.ravel()))).reshape(hertz.shape)
    gain = np.median(filtered - own)
    for note, (place, levels) in enumerate(zip(hertz, filtered - gain, strict=True)):
        name = "published, each note" if note == 0 else None
        left.plot(place, levels, "o", color="C0", alpha=0.7, label=name)
    along = np.geomspace(300.0, 7000.0, 600)
    left.plot(along, 20.0 * np.log10(np.abs(body.load().radiation(along))), "k", label="here")
    left.set(xscale="log", xlabel="Hz", ylabel="dB", title="From bridge force to sound")
    ticks = [300, 500, 1000, 2000, 5000]
    left.set_xticks(ticks, [str(tick) for tick in ticks])
    left.minorticks_off()
    left.legend()
    for name, each in monochord.MEASURED.items():
        label = "measured, four strings" if name == "A" else None
        edge(right, each, color="C0", linewidth=2.5 if name == "A" else 1.0, label=label)
    for name, style in (("one point", "k-"), ("torsion", "k--"), ("no bristles", "k:")):
        edge(right, monochord.Wedge(**found["monochord"][name]["wedge"]), style, label=name)
    right.set(ylim=(0.0, 4.2), xlabel="acceleration, m/s²", ylabel="N")
    right.set_title("Least force to begin within 20 periods")
    right.legend()
    return figure


def edge(axes: Any, wedge: monochord.Wedge, *style: Any, **more: Any) -> None:
    """Draw the edge of a wedge."""
    ends = np.array([monochord.ACCELERATIONS[0], monochord.ACCELERATIONS[-1]])
    axes.plot(ends, wedge.at_zero + wedge.slope * ends, *style, **more)
