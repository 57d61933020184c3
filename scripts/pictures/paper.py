"""Figures 2 to 6 of the paper, and the picture of the site's home, from this model.

Where the paper compares with measurements, these figures compare with the model's theory, because
the measured curves are not published.
"""

import json
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import yehu_server as yehu
from pictures.saving import ROOT, save
from yehu_server.core.physics import kernel
from yehu_server.core.physics.bridge import advance_bridge
from yehu_server.core.physics.default_quantities import Quantities, override

NOTEBOOK = ROOT / "examples" / "notebooks" / "2_figures_of_the_paper.ipynb"
DRAWN = ("2_admittance", "3_bowed", "4_strings", "5_gestures", "6_energy")  # in its order
PAPERS = {"base": "paper"}  # its instrument
BLUE, RED = "#1f5fa8", "#c03a2b"


def from_notebook(folder: Path) -> None:
    """Run the notebook's code, and write its figures; the first has the strings' peaks, too."""
    cells = json.loads(NOTEBOOK.read_text("utf-8"))["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    before, yehu.play = yehu.play, lambda *_words, **_named: None
    try:
        exec(compile(code, NOTEBOOK, "exec"), {})  # noqa: S102 - our own
    finally:
        yehu.play = before
    for number, name in zip(plt.get_fignums(), DRAWN, strict=True):
        if name != DRAWN[0]:
            save(plt.figure(number), folder / f"figure_{name}.png")
    plt.close("all")


def admittance(folder: Path) -> None:
    """Draw figure 2: the admittance of the bridge alone, and how it and a strung one are struck."""
    rate, frames = 44100.0, 1 << 15
    quantities = override(Quantities(), PAPERS)
    model = kernel.prepare(quantities, rate)
    force = np.zeros(frames)
    pulse = int(0.0012 * rate)
    force[:pulse] = 20.0 * np.sin(np.pi * np.arange(pulse) / pulse) ** 2
    q = np.zeros((3, 16))
    total = np.zeros(frames + 2)
    for n in range(frames):
        total[n + 2] = advance_bridge(model[0], q[(n + 1) % 3], q[n % 3], q[(n + 2) % 3], force[n])
    velocity = (total[2:] - total[:-2]) * rate / 2.0
    f = np.fft.rfftfreq(frames, 1 / rate)
    band = (f > 0.0) & (f < 6e3)  # where the pulse has enough energy
    omega = 2j * np.pi * f[band]
    body = quantities.body
    modes = zip(body.mass, body.damping, body.omega, strict=True)
    theory = sum(omega / (mass * (w**2 + omega**2) + omega * damping) for mass, damping, w in modes)
    simulated = np.fft.rfft(velocity)[band] / np.fft.rfft(force)[band]
    hammer = np.stack([np.arange(pulse + 2) / rate, force[: pulse + 2]], axis=1)
    strung = yehu.simulate({"duration": 0.05, "instrument": PAPERS, "hammer": hammer})

    figure, (top, bottom) = plt.subplots(2, 1, figsize=(8, 6.5))
    top.plot(f[band], 20 * np.log10(np.abs(theory)), BLUE, label="11 measured modes")
    top.plot(f[band], 20 * np.log10(np.abs(simulated)), RED, ls="--", label="scheme at 44.1 kHz")
    top.set(xlim=(200, 5000), ylim=(-70, 5), xlabel="Hz", ylabel="admittance, dB re 1 m/s/N")
    top.legend()
    moments, struck = strung.arrays["time"], strung.arrays["bridge_velocity"]
    bottom.plot(1e3 * moments, struck, "0.6", label="strung")
    bottom.plot(1e3 * (np.arange(2000) - 1) / rate, velocity[:2000], RED, label="bridge alone")
    bottom.set(xlim=(0, 30), xlabel="ms", ylabel="bridge velocity, m/s")
    bottom.legend()
    save(figure, folder / f"figure_{DRAWN[0]}.png")


def picture(folder: Path) -> None:
    """Draw the picture of the site's home: moving strings, and the spectrogram of a tune."""
    controls = {
        "bow_force": [[0, 0], [0.03, 0.6]],
        "bow_velocity": [[0, 0], [0.03, 0.3]],
        "press_force": [[0, 0], [0.2, 0], [0.21, 1.0]],
    }
    gesture = {"duration": 0.5, "instrument": PAPERS, "controls": controls}
    arrays = yehu.simulate(gesture, strings_every=6).arrays
    figure, panels = plt.subplots(2, 1, figsize=(9, 5), height_ratios=(1, 2), layout="constrained")
    top: Any = panels[0]
    for row in range(3000, 3022):
        top.plot(arrays["x_1"], 1e3 * arrays["string_1"][row], BLUE, lw=0.7, alpha=0.5)
        top.plot(arrays["x_2"], 1e3 * arrays["string_2"][row], "0.3", lw=0.6, alpha=0.4)
    arrow = {"arrowstyle": "-|>", "color": RED, "lw": 1.5}
    top.annotate("finger", (0.1, -0.5), (0.1, 0.55), arrowprops=arrow, ha="center", fontsize=9)
    top.axvline(0.255, color=RED, lw=1.5)
    top.plot(0.30, -0.12, "k^", ms=9)
    top.annotate("bow", (0.258, -0.75), fontsize=9)
    top.annotate("bridge", (0.303, -0.35), fontsize=9)
    top.set(xlim=(0, 0.38), ylim=(-0.9, 0.9), ylabel="mm", yticks=(-0.5, 0, 0.5))
    tune = yehu.render(ROOT / "examples" / "shi_bei_jiu.mid", dry=True, mono=True)
    played, rate = tune.sound[: 12 * tune.sample_rate], tune.sample_rate
    yehu.plot.spectrogram(played, rate, pitch=False, top_hz=6000.0, ax=panels[1])
    save(figure, folder / "yehu.png")


def draw_all(figures: Path, _sounds: Path) -> None:
    admittance(figures)
    from_notebook(figures)
    picture(figures)
