"""A body that was fitted to taps, and how an instrument with another body sounds.

The taps are made of bodies whose modes are known; see `lab.body.synthetic`.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt

import yehu_server as yehu
from pictures.saving import ROOT, save
from yehu_lab.body import made_taps
from yehu_lab.body.tap import write_taps
from yehu_server.cli import main as run
from yehu_server.core.physics.default_quantities import Body, measured_body

TUNE = ROOT / "examples" / "slow_air.mid"
LARGER = 1.18  # the other body's size: all its resonances lie lower by this


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


def draw_all(figures: Path, _sounds: Path) -> None:
    figure, panels = plt.subplots(2, 1, figsize=(12.0, 6.5), sharex=True, layout="constrained")
    with tempfile.TemporaryDirectory() as name:
        work, picture = Path(name), str(figures / "body.png")
        usual = fit(work, "taps", measured_body(), "--plot", picture, "--overwrite")
        larger = fit(work, "larger", larger_body())
        for axes, instrument, title in zip(
            panels,
            (usual, larger),
            (
                "The measured yehu, fitted to taps that were made of it",
                f"A body {LARGER:g} times as large, fitted likewise",
            ),
            strict=True,
        ):
            mapping = "keyboard-expressive"
            tune = yehu.render(TUNE, instrument=instrument, mapping=mapping, dry=True, mono=True)
            yehu.plot.spectrogram(tune, pitch=False, top_hz=5000.0, ax=axes)
            axes.set_title(title, loc="left", fontsize=10.5)
    save(figure, figures / "body_sound.png")
