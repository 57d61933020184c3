"""Onsets of a section: the law they follow, and how they stay together."""

from __future__ import annotations

from typing import Any

import numpy as np

from measures.section_take import SectionTake
from measures.together import Together

PULSE_S, NOTE_S = 0.5, 0.3
NOTES = (67, 69, 70, 72, 74)
DRAWN = 4000  # onsets
PLAYED_S = 150.0
ONSET_DB = -20.0  # below the steady level of a note, where it is heard to begin [Rasch]
HOP_S = 0.001


def fit(onsets: Any) -> tuple[Any, float]:
    """Fit the law of ``midi.section_players`` to onsets.

    Parameters
    ----------
    onsets : ndarray [shape=(notes, players)]
        In any unit, each counted from any moment that the players of a note share.

    Returns
    -------
    gains : ndarray [shape=(players,)]
    error : float
        Standard deviation of each player's own error, in the same unit.
    """
    apart = onsets - onsets.mean(axis=1, keepdims=True)
    now, change = apart[:-1], np.diff(apart, axis=0)
    notes, players = now.shape
    corrected = -players * now[:, :, np.newaxis] * np.eye(players)  # [note, player, gain]
    corrected -= corrected.mean(axis=1, keepdims=True)
    terms = corrected.reshape(-1, players)
    gains, *_ = np.linalg.lstsq(terms, change.ravel(), rcond=None)
    left = change.ravel() - terms @ gains
    return gains, float(np.sqrt(np.sum(left**2) / (notes * (players - 1))))


def spread(onsets: Any) -> float:
    """Return the standard deviation of the asynchronies of all pairs of players."""
    apart = onsets - onsets.mean(axis=1, keepdims=True)
    players = onsets.shape[1]
    return float(np.sqrt(2.0 * np.mean(apart**2) * players / (players - 1)))


def pulse(rate: float, seed: int, players: int, seconds: float) -> tuple[Any, Any]:
    """Play a pulse; return the onsets (ms after the planned ones) and the sound of each."""
    take = SectionTake(rate, seed, players)
    count = int(seconds / PULSE_S)
    for beat in range(count):
        take.note(NOTES[beat % len(NOTES)], beat * PULSE_S, beat * PULSE_S + NOTE_S)
    sounds = take.play(seconds)
    planned = np.round(np.arange(count) * PULSE_S * rate)[:, np.newaxis]
    return 1e3 * (np.array(take.begun).T - planned) / rate, sounds


def heard(sounds: Any, rate: float) -> Any:
    """Return when each note of a pulse is heard to begin (ms) [shape=(notes, players)]."""
    hop = round(HOP_S * rate)
    frames = round(PULSE_S * rate)
    found = []
    for sound in sounds:
        notes = sound[: len(sound) // frames * frames].reshape(-1, frames)
        power = notes[:, : frames // hop * hop].reshape(len(notes), -1, hop) ** 2
        smooth = np.apply_along_axis(np.convolve, 1, power.mean(axis=2), np.ones(5) / 5, "same")
        steady = smooth[:, 150:290].mean(axis=1, keepdims=True)
        found.append(np.argmax(smooth > steady * 10.0 ** (0.1 * ONSET_DB), axis=1) * HOP_S * 1e3)
    return np.array(found).T


def law(rate: float, seed: int) -> dict[str, Any]:
    """See scripts/section.py."""
    figures = {}
    for players in (2, 4, 8, 16):
        timing = Together(players, rate, seed)
        step = round(rate)
        late = [timing.onset(step * note) for note in range(DRAWN)]
        onsets = 1e3 * np.array(late) / rate
        gains, error = fit(onsets)
        figures[f"{players} players, planned"] = {
            "gain": round(float(gains.mean()), 3),
            "farthest gain from its own": round(float(abs(gains - timing.gains).max()), 3),
            "error ms": round(error, 2),
            "asynchrony ms": round(spread(onsets), 1),
            "latest ms": round(float(onsets.max()), 1),
            "share at the latest": round(float(np.mean(onsets > 39.9)), 4),
        }
    began, sounds = pulse(rate, seed, 4, PLAYED_S)
    for name, onsets in (("begun", began), ("heard", heard(sounds, rate))):
        gains, error = fit(onsets[2:])
        figures[f"4 players, {name}"] = {
            "gain": round(float(gains.mean()), 3),
            "error ms": round(error, 2),
            "asynchrony ms": round(spread(onsets[2:]), 1),
        }
    return figures


def together(rate: float, seed: int) -> dict[str, Any]:
    """See scripts/section.py."""
    began, sounds = pulse(rate, seed, 8, 600.0)
    listened = heard(sounds, rate)
    a_minute = round(60.0 / PULSE_S)
    return {
        f"minute {minute + 1}": {
            "begun apart ms": round(spread(began[at : at + a_minute]), 1),
            "heard apart ms": round(spread(listened[at : at + a_minute]), 1),
            "mean late ms": round(float(began[at : at + a_minute].mean()), 1),
            "latest ms": round(float(began[at : at + a_minute].max()), 1),
        }
        for minute, at in enumerate(range(0, len(began), a_minute))
    }
