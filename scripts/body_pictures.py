"""Draw a body that was fitted to taps, and how an instrument with another body sounds.

    .venv/bin/python scripts/body_pictures.py [FOLDER]

It writes body.png and body_sound.png to FOLDER (default: docs/figures). The taps are made of
bodies whose modes are known; see `lab.body.synthetic`.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import soundfile

from yehu_server.cli import main as run
from yehu_server.core.physics.quantities import Body, measured_body
from yehu_server.lab.body import made_taps
from yehu_server.lab.body.tap_files import write_taps

ROOT = Path(__file__).resolve().parent.parent
TUNE = ROOT / "examples" / "slow_air.mid"
LARGER = 1.18  # the other body's size: all its resonances lie lower by this
FRAMES, STEP = 8192, 1024
RANGE_DB = 75.0


def larger_body() -> Body:
    """The measured body as if its shell were larger: lower, heavier, and a little more damped."""
    body = measured_body()
    return replace(
        body,
        frequency_hz=tuple(hz / LARGER for hz in body.frequency_hz),
        mass=tuple(1.2 * mass for mass in body.mass),
        damping=tuple(1.2 * damping / LARGER for damping in body.damping),
        radiation_rate=round(body.radiation_rate / LARGER),
    )


def fit(folder: Path, name: str, body: Body, *more: str) -> Path:
    """Fit a body to five taps of it, as the command line does; return its instrument file."""
    taps = made_taps(body, rate=body.radiation_rate, noise_db=40.0)
    files, channels = write_taps(taps, folder / name)
    target = folder / f"{name}.toml"
    words = ["body", "fit", *map(str, files), "--channels", channels, "-o", str(target), *more]
    if run(words) != 0:
        raise SystemExit(1)
    return target


def sound_of(folder: Path, instrument: Path) -> tuple[Any, int]:
    """The tune on an instrument, dry: samples and their rate."""
    target = folder / f"{instrument.stem}.wav"
    words = ["render", str(TUNE), "-o", str(target), "--instrument", str(instrument), "--dry",
             "--mono", "--quiet", "--mapping", "keyboard-expressive"]  # fmt: skip
    if run(words) != 0:
        raise SystemExit(1)
    samples, rate = soundfile.read(target)
    return samples, rate


def spectrogram(samples: Any) -> Any:
    """Levels of a sound [shape=(frequencies, times), dB of its loudest]."""
    window = np.hanning(FRAMES)
    starts = range(0, len(samples) - FRAMES, STEP)
    spectra = [np.abs(np.fft.rfft(window * samples[n : n + FRAMES])) for n in starts]
    levels = 20.0 * np.log10(np.maximum(np.array(spectra).T, 1e-9))
    return levels - levels.max()


def draw_sounds(target: Path, sounds: dict[str, tuple[Any, int]]) -> None:
    """Draw the spectrograms of sounds, one below the other."""
    figure, panels = plt.subplots(
        len(sounds), 1, figsize=(12.0, 6.5), sharex=True, layout="constrained"
    )
    for axes, (title, (samples, rate)) in zip(panels, sounds.items(), strict=True):
        levels = spectrogram(samples)
        extent = (0.0, levels.shape[1] * STEP / rate, 0.0, rate / 2e3)
        image = axes.imshow(levels, origin="lower", aspect="auto", cmap="magma", extent=extent,
                            vmin=-RANGE_DB, vmax=0.0)  # fmt: skip
        axes.set(ylim=(0.0, 5.0), ylabel="kHz")
        axes.set_title(title, loc="left", fontsize=10.5)
    panels[-1].set_xlabel("s")
    figure.colorbar(image, ax=panels, label="dB of the loudest", pad=0.01)
    figure.savefig(target, dpi=90)


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "figures"
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        picture = str(folder / "body.png")
        usual = fit(work, "taps", measured_body(), "--plot", picture, "--overwrite")
        larger = fit(work, "larger", larger_body())
        draw_sounds(
            folder / "body_sound.png",
            {
                "The measured yehu, fitted to taps that were made of it": sound_of(work, usual),
                f"A body {LARGER:g} times as large, fitted likewise": sound_of(work, larger),
            },
        )


if __name__ == "__main__":
    main()
