"""`phrases`: how bare tunes are shaped: dynamics over a tune and inside notes, attacks, vibrato.

Ten tunes of examples/tunes are played without a room at phrasing 0 and 0.5. What musicians do
stands beside it: recordings of an erhu, a solo violin and a cello. A measure without right and
wrong, but for the dynamics over a tune.
"""

from pathlib import Path
from typing import Any

import numpy as np

import yehu_server as yehu
from measures.heard import HOP_S, Track, heard
from measures.shares import Share, share_line
from measures.take import Setup
from yehu_server.scores.reading import performed_part, read_written
from yehu_server.scores.score import ScoreNote

TUNES = Path(__file__).parents[2] / "examples" / "tunes"
PHRASINGS = (0.0, 0.5)
SILENT_DB = 35.0  # below the loudest moment of a tune
LONG_S, EDGE_S, SCRAPE_S, RISEN = 0.4, 0.1, 0.08, 0.9
MIN_DB, MAX_DB = 10.0, 17.0  # over a tune, from the 5th to the 95th of a hundred


def over_tune(track: Track) -> float:
    """How far the level ranges over a tune (dB): 5 to 95 of a hundred of what sounds."""
    level = track.level_db[track.level_db > track.level_db.max() - SILENT_DB]
    low, high = np.quantile(level, (0.05, 0.95))
    return float(high - low)


def of_note(track: Track, note: ScoreNote) -> tuple[float, float, float]:
    """Rise (ms) to 90 % of the loudest, SD of the level (dB), width of the vibrato (cents)."""
    part = track.part(note.start_s, note.end_s)
    risen_db = part.level_db.max() + 20.0 * np.log10(RISEN)
    rise = 1e3 * HOP_S * float(np.argmax(part.level_db > risen_db))
    edge = round(EDGE_S / HOP_S)
    level, pitch = part.level_db[edge:-edge], part.pitch[edge:-edge]
    pitch = pitch[np.isfinite(pitch)]
    late = pitch[len(pitch) // 2 :]
    width = 100.0 * float(np.ptp(np.quantile(late, (0.1, 0.9)))) if len(late) > 20 else np.nan
    return rise, float(level.std()), width


def scrape_db(sound: Any, rate: float, note: ScoreNote) -> float:
    """Power between the harmonics, of that of the harmonics, in a note's first 80 ms (dB)."""
    begin = round((note.start_s + 0.01) * rate)
    part = sound[begin : begin + round(SCRAPE_S * rate)]
    power = np.abs(np.fft.rfft(part * np.hanning(len(part)), 4 * len(part))) ** 2
    hz = np.fft.rfftfreq(4 * len(part), 1.0 / rate)
    own = 440.0 * 2.0 ** ((note.key - 69) / 12.0)
    apart = np.abs(hz - own * np.rint(hz / own))
    heard_hz = (hz > 150.0) & (hz < 8000.0)
    near = power[heard_hz & (apart < 60.0)].sum()
    between = power[heard_hz & (apart >= 60.0)].sum() / (1.0 - 120.0 / own)
    return float(10.0 * np.log10(between / near))


def shape_of(path: Path, phrasing: float, rate: float, seed: int) -> dict[str, Any]:
    """What is heard of a tune."""
    on_time = yehu.render(path, phrasing=phrasing, rubato=0.0, dry=True, mono=True, seed=seed)
    sound = np.asarray(on_time.sound, np.float64)
    track = heard(sound, rate)
    notes = performed_part(read_written(path)).notes
    long = [note for note in notes if note.length_s >= LONG_S]
    rows = np.array([of_note(track, note) for note in long])
    return {
        "over": over_tune(track),
        "rise": rows[:, 0],
        "inside": rows[:, 1],
        "vibrato": rows[:, 2],
        "scrape": np.array([scrape_db(sound, rate, note) for note in notes]),
    }


def phrases(setup: Setup) -> list[Share]:
    """Print how tunes are shaped, without phrasing and with the usual."""
    parts = []
    paths = sorted(TUNES.glob("*.jianpu"))
    for phrasing in PHRASINGS:
        found = [shape_of(path, phrasing, setup.rate, setup.seed) for path in paths]
        over = [each["over"] for each in found]
        print(f"phrasing {phrasing:g}: over a tune {min(over):.1f} to {max(over):.1f} dB")
        for name, unit in (
            ("rise", "ms"),
            ("inside", "dB"),
            ("vibrato", "cents"),
            ("scrape", "dB"),
        ):
            values = np.concatenate([each[name] for each in found])
            low, middle, high = np.nanquantile(values, (0.1, 0.5, 0.9))
            print(f"    {name}: {low:.1f} / {middle:.1f} / {high:.1f} {unit}", flush=True)
        words = [f"{path.stem} {db:.1f}" for path, db in zip(paths, over, strict=True)]
        right = [MIN_DB <= db <= MAX_DB for db in over]
        name = f"{MIN_DB:g} to {MAX_DB:g} dB over a tune at phrasing {phrasing:g}"
        parts.append(share_line(name, right, words, counts=phrasing > 0.0))
    return parts
