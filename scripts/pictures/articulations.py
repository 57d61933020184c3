"""Every articulation on one note: sounds of strokes, slides and beats, and what is heard."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from measures.articulated import Way, play
from measures.heard import HOP_S, heard
from measures.take import Setup
from scipy.signal import resample_poly

from pictures.saving import save, save_sound
from yehu_server.params.articulations import ARTICULATIONS

RATE, FILE_RATE = 44100, 16000
NOTE, VELOCITY, LENGTH_S, LONG_S, SPACE_S = 74, 88, 0.5, 0.9, 0.12
LONG = {"tremolo", "swell", "trill", "wide-trill", "wavering"}  # and those with a vibrato
REACH, FLOOR_DB = 5.0, 55.0


def kinds() -> dict[str, list[str]]:
    """The names of the strokes, of what slides, and of what beats or rocks."""
    found: dict[str, list[str]] = {"strokes": [], "slides": [], "beats": []}
    for row in ARTICULATIONS:
        slides = any(step.glide_ms for step in row.fingers) and not row.repeat_ms
        kind = "slides" if slides else "beats" if row.fingers or row.vibrato else "strokes"
        found[kind].append(row.name)
    return found


def sound_of(names: list[str], setup: Setup) -> tuple[Any, list[float]]:
    """Return all of a kind one after another, and when each begins (s)."""
    parts, begins, at = [], [], 0.0
    for name in names:
        is_long = name in LONG or name.endswith("vibrato")
        length_s = LONG_S if is_long else LENGTH_S
        sound, (begin,) = play(setup, Way(name, length_s, VELOCITY), (NOTE,))
        sound = sound[: round((begin + length_s + SPACE_S) * RATE)]
        fade = RATE // 20
        sound[-fade:] *= np.linspace(1.0, 0.0, fade, dtype=np.float32)
        begins.append(at + begin)
        at += len(sound) / RATE
        parts.append(sound)
    return np.concatenate(parts), begins


def draw_all(figures: Path, sounds: Path) -> None:
    """Draw level and pitch of each, and write the sounds."""
    setup = Setup(float(RATE), variation=0.25)
    heights = [1.0, 1.3, 0.25] * 3
    figure, rows = plt.subplots(
        9, 1, figsize=(14.0, 11.0), layout="constrained", height_ratios=heights
    )
    for number, (kind, names) in enumerate(kinds().items()):
        sound, begins = sound_of(names, setup)
        track = heard(sound, RATE)
        at = np.arange(len(track.pitch)) * HOP_S
        level, pitch, space = rows[3 * number : 3 * number + 3]
        top = track.level_db.max()
        level.plot(at, track.level_db - top, lw=0.7)
        level.set(ylim=(-FLOOR_DB, 3.0), ylabel="dB", title=kind)
        is_loud = track.level_db > top - 30.0
        pitch.plot(at[is_loud], track.pitch[is_loud] - NOTE, ".", ms=2)
        pitch.set(ylim=(-REACH, REACH), ylabel="semitones", xlabel="s")
        for begin, name in zip(begins, names, strict=True):
            pitch.text(begin, 0.8 * REACH, name, fontsize=8)
        for axes in (level, pitch):
            axes.set(xlim=(0.0, at[-1]))
            axes.grid(alpha=0.3)
        space.axis("off")
        smaller = resample_poly(sound, 160, 441)
        save_sound(sounds / f"{kind}.flac", smaller, FILE_RATE)
    save(figure, figures / "articulations.png", dpi=80)
