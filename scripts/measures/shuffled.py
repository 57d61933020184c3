"""`shuffled`: notes in random order that speak as the others of their pitch do.

A note speaks if its level is within 4 dB of the pitch's median, its pitch within 15 cents in the
second half, and its harmonics over all else within 15 dB of the pitch's median. Three counts
follow each note that does not always speak: too loud or soft, out of tune, rough.
"""

import math
from itertools import chain
from typing import Any

import numpy as np

from measures.intonation import overtones_off_by
from measures.shares import Share, share_line
from measures.take import NOTES, Setup, Sound, Take, in_parallel
from yehu_server.core.player.note_tables import frequency_hz
from yehu_server.playing.pitch_and_level import a_weighted_db

EACH_S, REST_S = 0.4, 0.02
SHUFFLED, ORDERS = 300, 3
LEVEL_DB, ROUGH_DB, ERROR_CENTS = 4.0, 15.0, 15.0
WAYS: dict[str, dict[str, Any]] = {
    "default": {},
    "bow at 0.08": {"settings": {"/playing/bow_position": 0.08}},
    "bow at 0.1": {"settings": {"/playing/bow_position": 0.1}},
    "bow at 0.2": {"settings": {"/playing/bow_position": 0.2}},
    "flautando": {"preset": "flautando"},
    "sul tasto": {"preset": "sul-tasto"},
    "sul ponticello": {"preset": "sul-ponticello"},
    "wind": {"mapping": "wind"},
}


def _harmonics_db(sound: Sound, rate: float, pitch: float) -> float:
    """Return the power of the harmonics (dB) relative to all between them."""
    size = 4 * len(sound)
    power = np.abs(np.fft.rfft(sound * np.hanning(len(sound)), size)) ** 2
    frequency = frequency_hz(pitch, 440.0)
    multiples = np.arange(len(power)) * rate / size / frequency
    near = np.abs(multiples - np.rint(multiples)) * frequency < 4.0 * rate / len(sound)
    heard = (multiples > 0.5) & (multiples * frequency < 10000.0)
    return 10.0 * math.log10(power[heard & near].sum() / (power[heard & ~near].sum() + 1e-30))


def _in_order(
    setup: Setup, order: int, how: dict[str, Any]
) -> list[tuple[int, float, float, float]]:
    """Play notes in an order; return pitch, level (dB), error (cents), harmonics (dB) of each."""
    notes = np.random.default_rng(order).choice(NOTES, SHUFFLED).tolist()
    take, rate = Take(setup, **how), setup.rate
    for i, note in enumerate(notes):
        take.on(i * EACH_S, note)
        take.off((i + 1) * EACH_S - REST_S, note)
    sound = take.play(len(notes) * EACH_S)
    found = []
    for i, note in enumerate(notes):
        end = round(((i + 1) * EACH_S - REST_S) * rate)
        half = sound[end - round(0.5 * EACH_S * rate) : end]
        error = overtones_off_by(half, rate, 0.0, 0.5 * EACH_S, note)
        found.append((note, a_weighted_db(half, rate), error, _harmonics_db(half, rate, note)))
    return found


def _spoken(name: str, rows: list[tuple[int, float, float, float]]) -> Share:
    """Print the share of notes that speak, and those that do not."""
    pitch, level, error, harmonics = np.array(rows).T
    speaks = np.ones(len(rows), bool)
    wrong: list[str] = []
    for note in NOTES:
        own = pitch == note
        soft = np.abs(level[own] - np.median(level[own])) > LEVEL_DB
        off = np.abs(error[own]) > ERROR_CENTS
        rough = harmonics[own] < np.median(harmonics[own]) - ROUGH_DB
        bad = soft | off | rough
        speaks[own] = ~bad
        if bad.any():
            wrong.append(
                f"{note} {bad.sum()} of {own.sum()} ({soft.sum()} {off.sum()} {rough.sum()})"
            )
    found = share_line(name, speaks)
    if wrong:
        print("   ", ", ".join(wrong), flush=True)
    return found


def shuffled(setup: Setup) -> list[Share]:
    """Print the share of 300 notes in each of three orders that speak, in each way of bowing."""
    orders = range(ORDERS * setup.seed + 1, ORDERS * (setup.seed + 1) + 1)
    ways = WAYS if setup.way is None else {setup.way: WAYS[setup.way]}
    parts = []
    for name, how in ways.items():
        played = in_parallel(setup, _in_order, [(order, how) for order in orders])
        parts.append(_spoken(name, list(chain.from_iterable(played))))
    return parts
