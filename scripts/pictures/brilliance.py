"""How bright nine notes are from soft to hard, with the law of brilliance and without it.

brilliance.png has their centroids over velocity, and brilliance.flac a few notes at three dynamics.
"""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from measures.loudness import END_S, STEADY_S, centroid_hz
from measures.take import Setup, Take, held, in_parallel
from scipy.signal import resample_poly

from pictures.saving import save, save_sound
from yehu_server.playing.pitch_and_level import note_name

RATE, FILE_RATE = 44100, 22050
NOTES = range(65, 90, 3)
VELOCITIES = (20, 40, 60, 80, 100, 127)
TUNE, DYNAMICS = (67, 72, 74, 79, 74), (30, 80, 120)
LENGTH_S, REST_S = 0.45, 0.4


def centroid(setup: Setup, note: int, velocity: int, law: float) -> float:
    """Centroid (Hz) of a note once it is steady; `law` is `/playing/brilliance`."""
    sound, _ = held(setup, note, velocity, END_S, settings={"/playing/brilliance": law})
    return centroid_hz(sound[round(STEADY_S * RATE) :], RATE)


def tune(setup: Setup) -> Any:
    """Some notes, at three dynamics."""
    take, at = Take(setup, settings={"/playing/vibrato": 20.0}), 0.05
    for velocity in DYNAMICS:
        for note in TUNE:
            take.long(at, LENGTH_S)
            take.on(at, note, velocity)
            take.off(at + LENGTH_S, note)
            at += LENGTH_S
        at += REST_S
    return take.play(at)


def draw_all(figures: Path, sounds: Path) -> None:
    """Draw centroids, and write the sound."""
    setup = Setup(float(RATE))
    figure, panels = plt.subplots(1, 2, figsize=(11.0, 4.4), layout="constrained", sharey=True)
    for axes, law in zip(panels, (0.0, 1.0), strict=True):
        jobs = [(note, velocity, law) for note in NOTES for velocity in VELOCITIES]
        found = np.reshape(in_parallel(setup, centroid, jobs), (len(NOTES), -1))
        for note, row in zip(NOTES, found, strict=True):
            axes.semilogy(VELOCITIES, row, "o-", ms=3.0, lw=1.0, label=note_name(note))
        axes.set_title("as by the law" if law else "of the model alone (/playing/brilliance 0)")
        axes.set_xlabel("velocity")
        axes.grid(alpha=0.3, which="both")
    panels[0].set_ylabel("spectral centroid, Hz")
    panels[1].legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    save(figure, figures / "brilliance.png", dpi=80)
    sound = resample_poly(tune(setup).astype(float), 1, RATE // FILE_RATE)
    save_sound(sounds / "brilliance.flac", sound, FILE_RATE)
