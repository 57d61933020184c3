"""Play every note in many ways and measure intonation, timing, clicks and loudness.

    .venv/bin/python scripts/playability.py [MEASURE] [--rate HZ] [--variation VALUE]
        [--seed N] [--way NAME] [--json FILE]

grid       Pitch of 500 notes of 0.8 s: F4 to F6 with the keyboard mapping, at velocities 20 to
           127, with the mod wheel untouched and at 0, 64 and 127: within 10 cents (open strings
           12) from 0.1 s on.
isolated   The same of each note alone, at velocity 80.
chromatic  The same of a chromatic scale up and down without rests, separate and slurred.
steady     Pitch error from 0.45 s on, at velocities 40 to 127 and six wheel positions: within
           5 cents (open strings 12).
quarters   Quarter tones, F4+50 to F6-50: within 5 cents from 0.4 s on.
legato     Time until a slurred note stays within 10 cents (open strings 12), after steps of 1 to
           5 semitones.
bends      Pitch error while the bend wheel moves: by two semitones and back within a second, and
           by a fourth.
tunes      Three tunes in sixteenths of 125 and 87 ms, slurred and separate: within 10 cents (open
           strings 12) in the second half of each note.
hunting    Held notes of 3 s, with listening and without: the largest periodic component of the
           pitch from 1 s on, 0.5 to 20 Hz; at most 1 cent.
life       How much the steady part of held notes varies, at three velocities: pitch in windows of
           20 ms, amplitude from period to period, harmonics to noise; within what people do.
clicks     Largest step between two samples where notes meet, relative to the largest inside
           them: less than 2.
evenness   Loudness (dB, A-weighted) of every note at several dynamics: within 2 dB of the median.
velocity   Loudness (dB, A-weighted) of every note at velocities from 1 to 127, in every mapping
           that binds velocity: rises by 16 to 24 dB, by 3 or more above 80. Also the spectral
           centroid, the attack (time to -6 dB of the steady level), and what the limiter bent.
shuffled   Share of 300 notes in random order, three times, that speak as the others of their
           pitch do, in many ways of bowing.
strings    Share of notes within 5 cents from 0.4 s on, on strings and bridges that nobody
           calibrated for.
presets    Share of notes in tune, loudness and spectral centroid (Hz) of every shipped preset, on
           F4 to F6 at velocities 30, 64 and 110, measured from 0.3 s on (plucked: from 0.05 s).

The last line is the share of all cases that are right. Under variation the mean pitch from 0.4 s on
counts in grid, steady, quarters, strings and presets.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path

from measures.bends import bends
from measures.grid import chromatic, grid, isolated
from measures.hunting import hunting
from measures.life import life
from measures.loudness import evenness, velocity
from measures.presets import presets
from measures.shares import Share, whole
from measures.shuffled import WAYS, shuffled
from measures.steady import quarters, steady
from measures.strings import strings
from measures.take import Setup
from measures.transitions import clicks, legato
from measures.tunes import tunes

from yehu_server.core.physics.quantities import Quantities, read_quantities
from yehu_server.errors import YehuError
from yehu_server.params.table import find
from yehu_server.playing.practice_files import read_practice

MEASURES: dict[str, Callable[[Setup], list[Share]]] = {
    each.__name__: each
    for each in (
        grid,
        isolated,
        chromatic,
        steady,
        quarters,
        legato,
        bends,
        tunes,
        hunting,
        life,
        clicks,
        evenness,
        velocity,
        shuffled,
        strings,
        presets,
    )
}


def variation(text: str) -> float:
    """Read the value of `/playing/variation`, or `default`."""
    param = find("/playing/variation")
    return param.default if text == "default" else param.accept(float(text))


def append(
    file: Path, setup: Setup, found: Share, parts: list[Share], **files: Path | None
) -> None:
    """Append a line of JSON: what was measured, its share, and those of its parts.

    `files` names what was measured in place of what ships.
    """
    data = {
        "measure": found.what,
        "rate": setup.rate,
        "variation": setup.variation,
        "seed": setup.seed,
        **{name: str(path) for name, path in files.items() if path is not None},
        **{name: value for name, value in found.as_data().items() if name != "what"},
        "parts": [part.as_data() for part in parts],
    }
    with file.open("a", encoding="utf-8") as lines:
        lines.write(json.dumps(data) + "\n")


def main() -> None:
    """Run the measure named on the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("measure", nargs="?", choices=MEASURES, default="grid")
    parser.add_argument("--rate", type=float, default=44100.0, help="sample rate (Hz)")
    parser.add_argument(
        "--variation", type=variation, default=0.0, help="0 to 1, or 'default' (default: 0)"
    )
    parser.add_argument("--seed", type=int, default=0, help="of orders and of the variation")
    parser.add_argument("--way", choices=WAYS, help="measure this way alone (shuffled)")
    parser.add_argument("--instrument", type=Path, metavar="FILE", help="as of `render`")
    parser.add_argument("--practice", type=Path, metavar="FILE", help="as of `render`")
    parser.add_argument("--json", type=Path, metavar="FILE", help="append the shares to this file")
    arguments = parser.parse_args()
    if arguments.way is not None and arguments.measure != shuffled.__name__:
        parser.error("--way is for shuffled")
    instrument, practice = arguments.instrument, arguments.practice
    try:
        own = read_quantities(instrument) if instrument else Quantities()
        bowing = read_practice(practice) if practice else None
    except YehuError as error:
        parser.error(str(error))
    asked = arguments.rate, arguments.variation, arguments.seed, arguments.way
    setup = Setup(*asked, own, bowing)
    parts = MEASURES[arguments.measure](setup)
    found = whole(arguments.measure, parts)
    print(found)
    if arguments.json is not None:
        append(arguments.json, setup, found, parts, instrument=instrument, practice=practice)


if __name__ == "__main__":
    main()
