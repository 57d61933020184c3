"""A hummed tune, and what is played of it: pictures and sounds. The hum is made by rule."""

from pathlib import Path
from typing import Any

import numpy as np

import yehu_server as yehu
from pictures.saving import save_sound
from yehu_server.cli import main

RATE = 22050
# Pitch (fractional MIDI note) and seconds; between notes of a line the voice slides in 60 ms.
LINES = (
    ((50.0, 0.5), (52.0, 0.4), (55.0, 0.9)),
    ((57.2, 0.3), (55.0, 0.3), (52.0, 0.4), (50.0, 1.1)),
)
FORMANTS = ((450.0, 90.0, 1.0), (1000.0, 120.0, 0.15), (2400.0, 200.0, 0.05))


def hum() -> Any:
    """A tune as one hums it, with a swell in each line and vibrato on long notes."""
    parts = [np.zeros(RATE // 4)]
    for line in LINES:
        pitch = np.concatenate([np.full(round(length * RATE), each) for each, length in line])
        window = np.hanning(round(0.06 * RATE))
        ends = np.pad(pitch, len(window) // 2, mode="edge")
        pitch = np.convolve(ends, window / window.sum(), "same")[len(window) // 2 :][: len(pitch)]
        time = np.arange(len(pitch)) / RATE
        left = time[-1] - time
        swing = np.clip((0.8 - left) / 0.3, 0.0, 1.0) * 0.3 * np.sin(2.0 * np.pi * 5.2 * time)
        hz = 440.0 * 2.0 ** ((pitch + swing - 69.0) / 12.0)
        phase = 2.0 * np.pi * np.cumsum(hz) / RATE
        sound = np.zeros(len(time))
        for n in range(1, 25):
            gain = sum(g / (1.0 + ((n * hz - f) / w) ** 2) for f, w, g in FORMANTS)
            sound += gain / n * np.sin(n * phase)
        swell = np.sin(np.pi * np.clip(time / time[-1], 0.02, 0.98)) ** 0.7
        parts += [sound * swell, np.zeros(RATE // 5)]
    whole = np.concatenate(parts)
    whole *= 0.5 / np.abs(whole).max()
    return whole + 1e-3 * np.random.default_rng(1).normal(size=len(whole))


def draw_all(figures: Path, sounds: Path) -> None:
    source = sounds / "hum.flac"
    save_sound(source, hum(), RATE)
    played, picture = sounds / "hum_played.flac", figures / "followed.png"
    words = ["--subtype", "16", "--normalize", "--mono", "--tail", "0.5"]
    main(["follow", str(source), "-o", str(played), "--plot", str(picture), *words, "--overwrite"])
    print(yehu.follow(source))
