"""`presets`: notes in tune, loudness and brightness of every shipped preset."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from measures.intonation import bound, in_words, off_by
from measures.shares import Share, share_line
from measures.take import NOTES, Setup, Take, in_parallel
from measures.timbre import centroid_hz
from yehu_server.cli.stage_options import is_of_room
from yehu_server.playing.pitch_and_level import a_weighted_db
from yehu_server.playing.preset_folders import Presets

VELOCITIES = (30, 64, 110)
BOWED_S, PLUCKED_S = (0.3, 0.8), (0.05, 0.25)  # from and to


def _in_preset(setup: Setup, preset: str, note: int, velocity: int) -> tuple[float, float, float]:
    """Return error (cents), loudness (dB, A-weighted) and spectral centroid (Hz) of a note."""
    take = Take(setup, preset)
    take.on(0.0, note, velocity)
    is_plucked = preset == "pizzicato"
    start_s, end_s = PLUCKED_S if is_plucked else BOWED_S
    sound = take.play(end_s)
    from_s = start_s if is_plucked else setup.steady_s(start_s)
    error = off_by(sound, setup.rate, from_s, end_s - from_s, note)
    heard = sound[round(start_s * setup.rate) :]
    return error, a_weighted_db(heard, setup.rate), centroid_hz(heard, setup.rate)


def presets(setup: Setup) -> list[Share]:
    """Print the results of each preset of a way to play, and its notes that are out of tune."""
    cases = [(note, velocity) for note in NOTES for velocity in VELOCITIES]
    parts = []
    shipped = Presets(Path(os.devnull))
    for name in shipped.names():
        if all(map(is_of_room, shipped.load(name).values)):
            continue
        found = in_parallel(setup, _in_preset, [(name, *case) for case in cases])
        errors, levels, middles = np.array(found).T
        print(
            f"{name}: {np.median(levels):.1f} dB (within {np.ptp(levels):.1f}), "
            f"{np.median(middles):.0f} Hz"
        )
        right = np.abs(errors) <= np.array([bound(note) for note, _ in cases])
        words = [f"{n}/{v} {in_words(e)}" for (n, v), e in zip(cases, errors, strict=True)]
        parts.append(share_line(name, right, words))
    return parts
