"""Compare what a first sound may be: presets, rooms and mappings, in phrases.

    .venv/bin/python scripts/first_sound.py

Four tunes are played as files are, and as somebody at a keyboard plays them, whose velocities shape
phrases and who moves no wheel. What is heard is compared with what is published, and with
recordings of an erhu, a violin and a cello (docs/playing.md, "Beside published performances"). The
last column is the distance: by how much of each range's width a figure is outside, in the mean.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from measures.heard import HOP_S, Track, heard
from measures.phrases import of_note, over_tune

import yehu_server as yehu
from yehu_server.api.notes import Note
from yehu_server.playing.mapping import shipped_mappings
from yehu_server.scores.phrasing import phrased
from yehu_server.scores.reading import read_any
from yehu_server.scores.score import Score, ScoreNote, notes_of

EXAMPLES = Path(__file__).parents[1] / "examples"
PHRASES = ("phrases/mo_li_hua", "phrases/zou_xi_kou", "tunes/song_bie", "tunes/amazing_grace")
SHAPED = 0.5
VIBRATED_S, RISING_S, EDGE_S, OPEN = 0.6, 0.4, 0.1, (65,)  # notes that may; F4 is open
LEAST_CENTS = 20.0  # from peak to peak, of a vibrato

# Recordings; [Seashore]; [Timmers]; [Suzuki].
RANGES = {
    "dB over a tune": (10.0, 17.0),
    "rise (ms)": (120.0, 250.0),
    "vibrato (cents)": (39.0, 105.0),
    "with vibrato (%)": (85.0, 100.0),
    "rate (Hz)": (5.0, 8.0),
    "lowest middle": (-17.0, 26.0),
    "highest middle": (-17.0, 26.0),
}


@dataclass(frozen=True)
class Candidate:
    """What is played, and how."""

    name: str
    is_live: bool = False
    more: dict[str, Any] = field(default_factory=dict)  # arguments of `render`


def rate_of(pitch: Any) -> float:
    """The rate (Hz) of a vibrato, from the pitch each 5 ms."""
    own = pitch - np.mean(pitch)
    power = np.abs(np.fft.rfft(own * np.hanning(len(own)), 1 << 12))
    hz = np.fft.rfftfreq(1 << 12, HOP_S)
    inside = (hz > 3.0) & (hz < 10.0)
    return float(hz[inside][np.argmax(power[inside])])


def figures(track: Track, notes: Iterable[ScoreNote]) -> list[tuple[str, float]]:
    """What is heard of one tune: names of RANGES, and values, some of them for each note."""
    found = [("dB over a tune", over_tune(track))]
    for note in notes:
        if note.length_s < RISING_S:
            continue
        rise, _, width = of_note(track, note)
        found.append(("rise (ms)", rise))
        part = track.part(note.start_s + EDGE_S, note.end_s - EDGE_S).pitch
        part = part[np.isfinite(part)]
        if len(part) < 20:
            continue
        found.append(("middle", 100.0 * float(np.median(part) - note.key)))
        if note.length_s >= VIBRATED_S and note.key not in OPEN and np.isfinite(width):
            found.append(("with vibrato (%)", 100.0 * (width >= LEAST_CENTS)))
            if width >= LEAST_CENTS:
                late = part[len(part) // 2 :]
                found += [("vibrato (cents)", width), ("rate (Hz)", rate_of(late))]
    return found


def summed(found: Sequence[tuple[str, float]]) -> dict[str, float]:
    """One value for each name of RANGES: a median, a mean, or the ends of nine tenths."""

    def of(name: str) -> Any:
        values = [value for own, value in found if own == name]
        return np.array(values) if values else np.zeros(1)

    low, high = np.quantile(of("middle"), (0.05, 0.95))
    usual = {name: float(np.median(of(name))) for name in RANGES}
    share = {"with vibrato (%)": float(np.mean(of("with vibrato (%)")))}
    return usual | share | {"lowest middle": float(low), "highest middle": float(high)}


def distance(values: dict[str, float]) -> float:
    """How far outside the ranges, in their widths; the mean of all."""
    return float(np.mean([
        max(low - values[name], values[name] - high, 0.0) / (high - low)
        for name, (low, high) in RANGES.items()
    ]))  # fmt: skip


def at_a_keyboard(score: Score) -> list[Note]:
    """The notes of a score with the velocities of a phrase, and nothing else of it."""
    return [
        Note(note.key, note.start_s, note.length_s, note.velocity)
        for note in notes_of(phrased(score, SHAPED, rubato=0.0))
    ]


def heard_of(candidate: Candidate) -> dict[str, float]:
    """Play all phrases as a candidate has it, and listen."""
    found: list[tuple[str, float]] = []
    for name in PHRASES:
        path = EXAMPLES / f"{name}.jianpu"
        score = read_any(path)
        if candidate.is_live:
            played: Any = at_a_keyboard(score)
            notes = notes_of(score)
        else:
            played = path
            notes = notes_of(phrased(score, SHAPED))
        usual = {"phrasing": 0.0 if candidate.is_live else SHAPED}
        sound = yehu.render(played, **usual | candidate.more).sound
        found += figures(heard(sound.mean(axis=1), 44100.0), notes)
    return summed(found)


def candidates() -> list[Candidate]:
    """All that are compared."""
    bows = ("ordinary", "vibrato", "flautando", "sul-tasto", "sul-ponticello")
    rooms = ("dry", "study", "courtyard", "hall")
    files = [Candidate(f"file, {name}", more={"preset": name}) for name in (*bows, *rooms)]
    live = [Candidate(f"live, {name}", True, {"preset": name}) for name in bows]
    mapped = [Candidate(f"live, {name}", True, {"mapping": name}) for name in shipped_mappings()]
    shaped = {"phrasing": SHAPED}
    return [*files, *live, *mapped, Candidate("live, phrasing 0.5", True, shaped)]


def main() -> None:
    """Print a row for each candidate."""
    print("| " + " | ".join(("", *RANGES, "distance")) + " |")
    print("|" + "---|" * (len(RANGES) + 2))
    print("| published | " + " | ".join(f"{a:g} to {b:g}" for a, b in RANGES.values()) + " | |")
    for candidate in candidates():
        if len(sys.argv) > 1 and not any(word in candidate.name for word in sys.argv[1:]):
            continue
        values = heard_of(candidate)
        shown = [f"{values[name]:.4g}" for name in RANGES]
        row = (candidate.name, *shown, f"{distance(values):.2f}")
        print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
