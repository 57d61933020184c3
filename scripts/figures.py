"""Redraw figures 2 to 6 of the paper, and the README's picture, from this model.

    .venv/bin/python scripts/figures.py [FOLDER]

It writes PNG files to FOLDER (default: docs/figures). Where the paper compares with measurements,
these figures compare with the model's theory, because the measured curves are not published.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

from yehu_server.core.physics import kernel
from yehu_server.core.physics.bridge import advance_bridge
from yehu_server.core.physics.quantities import Quantities
from yehu_server.lab.simulation import simulate
from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.gesture import Gesture, gesture_from
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parent.parent
BLUE, RED, GREY = "#1f5fa8", "#c03a2b", "0.6"


def paper(data: dict[str, Any]) -> Gesture:
    """Return a gesture for the paper's model, in which string tension is constant."""
    return gesture_from({"instrument": {"tension_modulation": 0.0}, **data})


def points(times: Any, values: Any) -> list[list[float]]:
    """Return a curve in the form that gesture files use: pairs of time and value."""
    return [[float(t), float(v)] for t, v in zip(times, values, strict=True)]


def admittance(folder: Path) -> None:
    """Draw figure 2: the admittance of the bridge and its response to a hammer."""
    rate = 44100.0
    quantities = Quantities(tension_modulation=0.0)
    body = quantities.body
    model = kernel.prepare(quantities, rate)
    frames = 1 << 15
    force = np.zeros(frames)
    pulse = int(0.0012 * rate)
    force[:pulse] = 20.0 * np.sin(np.pi * np.arange(pulse) / pulse) ** 2
    q = np.zeros((3, 16))
    total = np.zeros(frames + 2)
    for n in range(frames):
        total[n + 2] = advance_bridge(model[0], q[(n + 1) % 3], q[n % 3], q[(n + 2) % 3], force[n])
    velocity = (total[2:] - total[:-2]) * rate / 2.0
    velocity = np.concatenate([velocity[1:], [0.0]])  # centred: sample n needs q at n + 1

    f = np.fft.rfftfreq(frames, 1 / rate)
    band = (f > 0.0) & (f < 6e3)  # where the pulse has enough energy
    f = f[band]
    omega = 2.0 * np.pi * f
    theory = sum(
        1j * omega / (mass * (w**2 - omega**2) + 1j * omega * damping)
        for mass, damping, w in zip(body.mass, body.damping, body.omega, strict=True)
    )
    delayed = np.concatenate([[0.0], velocity[:-1]])
    simulated = np.fft.rfft(delayed)[band] / np.fft.rfft(force)[band]
    gesture = paper(
        {
            "duration": 0.05,
            "hammer": points(np.arange(frames)[: pulse + 2] / rate, force[: pulse + 2]),
        }
    )
    strung = simulate(gesture)

    figure, (top, bottom) = plt.subplots(2, 1, figsize=(8, 6.5))
    top.plot(f, 20 * np.log10(np.abs(theory)), BLUE, label="11 measured modes")
    top.plot(f, 20 * np.log10(np.abs(simulated)), RED, ls="--", label="scheme at 44.1 kHz")
    top.set(xlim=(200, 5000), ylim=(-70, 5), xlabel="Hz", ylabel="admittance, dB re 1 m/s/N")
    top.legend()
    ms = 1e3 * np.arange(2000) / rate
    bottom.plot(1e3 * strung.arrays["time"], strung.arrays["bridge_velocity"], GREY, label="strung")
    bottom.plot(ms, velocity[:2000], RED, label="bridge alone")
    bottom.set(xlim=(0, 30), xlabel="ms", ylabel="bridge velocity, m/s")
    bottom.legend()
    save(figure, folder / "figure_2_admittance.png")


def bowed(folder: Path) -> None:
    """Draw figure 3: steady bridge velocity, with the F string bowed at 0.7 N and 0.3 m/s."""
    gesture = paper(
        {
            "duration": 1.0,
            "controls": {
                "bow_force": [[0, 0], [0.03, 0.7]],
                "bow_velocity": [[0, 0], [0.03, 0.3]],
            },
        }
    )
    arrays = simulate(gesture).arrays
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(8, 5), sharex=True)
    for axes, name, label in (
        (top, "bridge_velocity", "bridge velocity, m/s"),
        (bottom, "relative_velocity", "hair on string, m/s"),
    ):
        axes.plot(1e3 * (arrays["time"] - 0.9), arrays[name], RED)
        axes.set(xlim=(0, 15), ylabel=label)
    bottom.set(xlabel="ms")
    save(figure, folder / "figure_3_bowed.png")


def shapes(folder: Path) -> None:
    """Draw figure 4: the shapes of both strings, bowed and pressed."""
    gesture = paper(
        {
            "duration": 0.5,
            "controls": {
                "bow_force": [[0, 0], [0.03, 0.7]],
                "bow_velocity": [[0, 0], [0.03, 0.3]],
                "press_force": [[0, 0], [0.2, 0], [0.21, 0.5]],
            },
        }
    )
    result = simulate(gesture, strings_every=10)
    figure, panels = plt.subplots(2, 2, figsize=(9, 5), sharex=True, sharey=True)
    for axes, moment in zip(panels.flat, (0.1, 0.206, 0.25, 0.4), strict=True):
        draw_strings(axes, result.arrays, moment)
        axes.set_title(f"{1e3 * moment:.0f} ms", fontsize=9)
    for axes in panels[1]:
        axes.set_xlabel("m from the loop")
    for axes in panels[:, 0]:
        axes.set_ylabel("mm")
    save(figure, folder / "figure_4_strings.png")


def draw_strings(axes: Any, arrays: Any, moment: float) -> None:
    """Draw both strings, the finger, the bow and the bridge at one moment."""
    row = int(np.searchsorted(arrays["strings_time"], moment))
    at = int(np.searchsorted(arrays["time"], moment))
    axes.plot(arrays["x_1"], 1e3 * arrays["string_1"][row], "k", lw=1.2)
    axes.plot(arrays["x_2"], 1e3 * arrays["string_2"][row], "k--", lw=1)
    height = 1e3 * arrays["finger_displacement"][at]
    axes.plot(arrays["finger_position"][at], height, "o", color=RED, ms=11, mfc="none")
    axes.axvline(arrays["bow_position"][at], color=BLUE, lw=1)
    axes.plot(0.30, 0.0, "k^", ms=7)


def gestures(folder: Path) -> None:
    """Draw figure 5: two gestures. The paper does not give their exact curves."""
    t = np.arange(0.0, 2.0, 0.002)
    crossing = paper(
        {
            "duration": 2.0,
            "controls": {
                "bow_force": points(t, 0.7 * np.sin(2 * np.pi * 2.1 * t)),
                "bow_velocity": points(
                    t, 0.5 * np.sin(2 * np.pi * 1.3 * t) * np.cos(2 * np.pi * 7 * t)
                ),
                "press_force": [[0, 0], [1.0, 0], [1.02, 0.5]],
            },
        }
    )
    t = np.arange(0.0, 1.5, 0.002)
    steps = np.interp(t, [0, 0.5, 0.55, 1.0, 1.05, 1.5], [0.04, 0.04, 0.09, 0.09, 0.13, 0.13])
    vibrato = paper(
        {
            "duration": 1.5,
            "controls": {
                "bow_force": [[0, 0], [0.03, 0.5]],
                "bow_velocity": [[0, 0], [0.03, 0.25]],
                "press_force": [[0, 0], [0.02, 0.5]],
                "finger_position": points(t, steps + 0.002 * np.sin(2 * np.pi * 6 * t)),
            },
        }
    )
    figure, panels = plt.subplots(2, 1, figsize=(8, 7))
    for axes, gesture in zip(panels, (crossing, vibrato), strict=True):
        draw_spectrogram(axes, simulate(gesture).arrays["pressure"], gesture.sample_rate)
    panels[1].set_xlabel("s")
    save(figure, folder / "figure_5_gestures.png")


def draw_spectrogram(axes: Any, signal: Any, rate: float, top_hz: float = 6000.0) -> None:
    """Draw a spectrogram with a range of 80 dB."""
    _, _, _, image = axes.specgram(signal + 1e-12, NFFT=2048, Fs=rate, noverlap=1792, cmap="magma")
    peak = image.get_array().max()
    image.set_clim(peak - 80, peak)
    axes.set(ylim=(0, top_hz), ylabel="Hz")


def energy(folder: Path) -> None:
    """Draw figure 6: the energy error over ten seconds of bowing with random finger presses."""
    chance = np.random.default_rng(6)
    moments = np.arange(0.0, 10.0, 0.4)
    gesture: Gesture = paper(
        {
            "duration": 10.0,
            "controls": {
                "bow_force": [[0, 0], [0.03, 0.7]],
                "bow_velocity": [[0, 0], [0.03, 0.3]],
                "finger_position": points(moments, chance.uniform(0.02, 0.15, len(moments))),
                "press_force": points(moments, chance.uniform(0.0, 1.0, len(moments))),
            },
        }
    )
    arrays = simulate(gesture, energy=True).arrays
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(8, 5), sharex=True)
    top.plot(arrays["time"], 1e3 * arrays["energy"], BLUE, lw=0.5)
    top.set(ylabel="energy, mJ")
    per_sample = arrays["energy_error"] / gesture.sample_rate
    bottom.plot(arrays["time"], per_sample, RED, lw=0.3)
    bottom.set(xlabel="s", ylabel="energy error, J a sample")
    save(figure, folder / "figure_6_energy.png")


def picture(folder: Path) -> None:
    """Draw the README's picture: moving strings, and the spectrogram of a tune."""
    gesture = paper(
        {
            "duration": 0.5,
            "controls": {
                "bow_force": [[0, 0], [0.03, 0.6]],
                "bow_velocity": [[0, 0], [0.03, 0.3]],
                "press_force": [[0, 0], [0.2, 0], [0.21, 1.0]],
            },
        }
    )
    arrays = simulate(gesture, strings_every=6).arrays
    figure, (top, bottom) = plt.subplots(
        2, 1, figsize=(9, 5), height_ratios=(1, 2), layout="constrained"
    )
    rows = range(3000, 3022)
    for row in rows:
        top.plot(arrays["x_1"], 1e3 * arrays["string_1"][row], BLUE, lw=0.7, alpha=0.5)
        top.plot(arrays["x_2"], 1e3 * arrays["string_2"][row], "0.3", lw=0.6, alpha=0.4)
    arrow = {"arrowstyle": "-|>", "color": RED, "lw": 1.5}
    top.annotate("finger", (0.1, -0.5), (0.1, 0.55), arrowprops=arrow, ha="center", fontsize=9)
    top.axvline(0.255, color=RED, lw=1.5)
    top.plot(0.30, -0.12, "k^", ms=9)
    top.annotate("bow", (0.258, -0.75), fontsize=9)
    top.annotate("bridge", (0.303, -0.35), fontsize=9)
    top.set(xlim=(0, 0.38), ylim=(-0.9, 0.9), ylabel="mm", yticks=(-0.5, 0, 0.5))
    score = read_score(ROOT / "examples" / "shi_bei_jiu.mid")
    options = Options(is_dry=True, is_mono=True)
    played = np.concatenate(list(Performance(score, options).blocks()))
    draw_spectrogram(bottom, played[: 12 * 44100], 44100.0)
    bottom.set(xlabel="s")
    save(figure, folder / "yehu.png")


def save(figure: Any, path: Path) -> None:
    """Write a figure to a file and print its path."""
    if figure.get_layout_engine() is None:
        figure.tight_layout()
    figure.savefig(path, dpi=90)
    plt.close(figure)
    print(path)


def main() -> None:
    """Draw all figures."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    for draw in (admittance, bowed, shapes, gestures, energy, picture):
        draw(folder)


if __name__ == "__main__":
    main()
