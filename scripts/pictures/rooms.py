"""How the rooms of the presets answer: reflections, decay, and the spectrum of the tail."""

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from pictures.saving import ROOT, levels, save
from yehu_server.playing.preset_folders import Presets

sys.path.insert(0, str(ROOT / "tests"))
acoustics: Any = import_module("acoustics")
stages: Any = import_module("stages")

RATE = 48000.0
NAMES = ("study", "chamber", "courtyard", "hall")
BANDS = ((250.0, "#1f5fa8"), (1000.0, "0.4"), (4000.0, "#c03a2b"))


def heard(name: str) -> tuple[dict[str, float], Any, Any]:
    """What is asked of a preset's room, and what an impulse gives there: directly, by the room."""
    values = Presets().load(name).values
    asked = {address.rpartition("/")[2]: value for address, value in values.items()}
    return asked, *stages.response(RATE, 1.2 * asked["decay"] + 0.1, **asked)


def draw_all(figures: Path, _sounds: Path) -> None:
    figure, rows = plt.subplots(len(NAMES), 3, figsize=(12.0, 10.5), layout="constrained")
    for axes, name in zip(rows, NAMES, strict=True):
        asked, direct, room = heard(name)
        at = np.arange(len(room)) / RATE
        axes[0].plot(1e3 * at, direct[:, 0], color="0.7", lw=0.8)
        axes[0].plot(1e3 * at, room[:, 0], color="#1f5fa8", lw=0.6)
        axes[0].set(xlim=(-2.0, 120.0), ylim=(-0.5, 0.8), xlabel="ms", ylabel=name)
        for centre, colour in BANDS:
            left = acoustics.energy_left(acoustics.octave(room, RATE, centre))
            label = f"{centre:g} Hz"
            axes[1].plot(at, levels(left / left[0]), color=colour, lw=1.0, label=label)
        axes[1].set(xlim=(0.0, 1.2 * asked["decay"]), ylim=(-70.0, 3.0), xlabel="s", ylabel="dB")
        axes[1].legend(fontsize=8)
        axes[2].specgram(
            room[:, 0] + 1e-12, NFFT=1024, noverlap=896, Fs=RATE, vmin=-190.0, vmax=-100.0
        )
        axes[2].set(ylim=(0.0, 16000.0), xlabel="s", ylabel="Hz")
    rows[0][0].set_title("an impulse, left ear")
    rows[0][1].set_title("what is left of the sound")
    rows[0][2].set_title("spectrogram of the room")
    save(figure, figures / "rooms.png", dpi=110)
