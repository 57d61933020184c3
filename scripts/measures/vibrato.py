"""`vibrato`: how far pitch and level of each note swing under vibrato.

The player's own, as files have it, and one that is asked for; from 1.2 s on, as medians of turns.
The level counts without a cubic through all of it, since notes swell.
"""

import numpy as np

from measures.heard import HOP_S, heard
from measures.shares import Share, share_line
from measures.take import NOTES, Setup, held, in_parallel

RATE_HZ, STEADY_S, END_S, LENGTH_S = 5.5, 1.2, 3.1, 3.0
WAYS = {
    "the player's own": {"/playing/phrasing": 0.5, "/playing/note_length": LENGTH_S},
    "asked for, 30 cents to either side": {"/playing/vibrato": 30.0},
}
# From peak to peak: the least width in recordings of an erhu, a violin and a cello; by ear.
MIN_CENTS, MAX_DB = 39.0, 4.0
OPEN = (65, 72)  # no finger


def swings(setup: Setup, note: int, settings: dict[str, float]) -> tuple[float, float]:
    """Pitch (cents) and level (dB) of a note from peak to peak."""
    settings = settings | {"/playing/vibrato_rate": RATE_HZ}
    sound, _ = held(setup, note, 80, END_S, settings=settings)
    track = heard(sound, setup.rate).part(STEADY_S, LENGTH_S)
    turn = round(1.0 / RATE_HZ / HOP_S)
    steps = np.linspace(-1.0, 1.0, len(track.level_db))
    level = track.level_db - np.polyval(np.polyfit(steps, track.level_db, 3), steps)
    cents, level_db = [], []
    for at in range(0, len(track.pitch) - turn, turn):
        pitch = track.pitch[at : at + turn] - note
        pitch = (pitch + 6.0) % 12.0 - 6.0  # a fundamental may be too weak to show the octave
        cents.append(100.0 * np.ptp(pitch[np.isfinite(pitch)]))
        level_db.append(np.ptp(level[at : at + turn]))
    return float(np.median(cents)), float(np.median(level_db))


def vibrato(setup: Setup) -> list[Share]:
    """Print how far pitch and level of each note swing."""
    notes = [note for note in NOTES if note not in OPEN]
    parts = []
    for name, settings in WAYS.items():
        found = in_parallel(setup, swings, [(note, settings) for note in notes])
        right = [cents >= MIN_CENTS and db <= MAX_DB for cents, db in found]
        words = [
            f"{note} {cents:.0f} cents {db:.1f} dB"
            for note, (cents, db) in zip(notes, found, strict=True)
        ]
        cents, db = np.median(found, axis=0)
        print(f"{name}: medians {cents:.0f} cents, {db:.1f} dB; {', '.join(words)}")
        parts.append(
            share_line(f"{MIN_CENTS:g} cents or more, {MAX_DB:g} dB or less", right, words)
        )
    return parts
