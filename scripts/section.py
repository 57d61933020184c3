"""Let sections play and measure whether they sound as several players do.

    .venv/bin/python scripts/section.py [MEASURE] [--rate HZ] [--seed N] [--json FILE]

law       Gain of the correction and error of the onsets, by regression, of two, four, eight and
          sixteen players: from the onsets that are planned, and of four players from their sound.
together  A pulse of ten minutes: how far apart eight players begin, and how late, in each minute.
tuning    Pitch of each of eight players on all notes, against the section's mean (cents).
chorus    Spectrum of eight players over that of their powers (0 dB), in third octaves, and how it
          changes within notes; beside it eight copies of one player, and copies that are late.
loudness  Loudness of a section over that of one player (dB, A-weighted), alone and in the room.
vibrato   How far the pitch swings of each of sixteen with a vibrato, and of all together (cents).
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from measures.section_sound import chorus, loudness, tuning, vibrato
from measures.section_time import law, together

MEASURES: dict[str, Callable[[float, int], dict[str, Any]]] = {
    "law": law,
    "together": together,
    "tuning": tuning,
    "chorus": chorus,
    "loudness": loudness,
    "vibrato": vibrato,
}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("measure", nargs="?", choices=MEASURES, help="by default all")
    parser.add_argument("--rate", type=float, default=44100.0, help="Hz")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="write all figures to a file")
    options = parser.parse_args()
    chosen = [options.measure] if options.measure else list(MEASURES)
    found = {}
    for name in chosen:
        found[name] = MEASURES[name](options.rate, options.seed)
        print(f"{name}: {json.dumps(found[name], indent=1)}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
