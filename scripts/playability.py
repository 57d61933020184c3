"""Play every note in many ways and measure intonation, timing, clicks and loudness.

    .venv/bin/python scripts/playability.py [MEASURE] [--rate HZ] [--variation VALUE]
        [--phrasing VALUE] [--seed N] [--way NAME] [--json FILE]

docs/intonation.md says what each measure plays and counts; `grid` is the default.

The last line is the share of all cases that are right. Under variation the mean pitch of the first
partials from 0.4 s on counts in grid, steady, quarters, strings and presets.
"""

import argparse
import json
from collections.abc import Callable
from pathlib import Path

from measures.bends import bends
from measures.in_tune import chromatic, grid, isolated, presets, quarters, steady, strings
from measures.life import life
from measures.loudness import evenness, velocity
from measures.onsets import onsets
from measures.shares import Share, whole
from measures.shuffled import WAYS, shuffled
from measures.take import Setup
from measures.transitions import clicks, legato
from measures.tunes import detached, tunes
from measures.vibrato import vibrato

from yehu_server.core.physics.default_quantities import Quantities, read_quantities
from yehu_server.errors import YehuError
from yehu_server.params.table import find
from yehu_server.playing.bowing_tables import bowing_table_beside, read_bowing_table

MEASURES: dict[str, Callable[[Setup], list[Share]]] = {
    each.__name__: each
    for each in (
        *(grid, isolated, chromatic, steady, quarters, legato, bends, tunes, detached),
        *(life, clicks, onsets, evenness, velocity, shuffled, strings, presets, vibrato),
    )
}


def variation(text: str) -> float:
    """Read the value of `/playing/variation`, or `default`."""
    param = find("/playing/variation")
    return param.default if text == "default" else param.clamped(float(text))


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
        "phrasing": setup.phrasing,
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
    parser.add_argument("--phrasing", type=float, default=0.0, help="0 to 1 (default: 0)")
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
        practice = practice or bowing_table_beside(instrument)
        bowing = read_bowing_table(practice) if practice else None
    except YehuError as error:
        parser.error(str(error))
    asked = arguments.rate, arguments.variation, arguments.seed, arguments.way
    setup = Setup(
        *asked, own, bowing, phrasing=find("/playing/phrasing").clamped(arguments.phrasing)
    )
    parts = MEASURES[arguments.measure](setup)
    found = whole(arguments.measure, parts)
    print(found)
    if arguments.json is not None:
        append(arguments.json, setup, found, parts, instrument=instrument, practice=practice)


if __name__ == "__main__":
    main()
