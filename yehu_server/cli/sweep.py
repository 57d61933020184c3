"""``yehu-server sweep``."""

from __future__ import annotations

import argparse
import json
from typing import Any

from yehu_server.cli.arguments import (
    add_command,
    add_folder,
    add_gesture,
    add_reporting,
    progress_bar,
    warn_of_compiling,
)
from yehu_server.cli.converters import positive
from yehu_server.cli.terminal import tell

EXAMPLES = """\
examples:
  yehu-server sweep gesture.json -o runs --vary bow_force=0.1:2:20 --vary bow_velocity=0.1,0.2
  yehu-server sweep gesture.json -o runs --vary instrument.bow.epsilon_0=2e4,3e4,4e4 --index-only

Names are those of a gesture file, which is described in docs/simulate.md
"""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "sweep",
        run=run,
        help="run a gesture with all combinations of some values, on all cores",
        description="Run a gesture file with all combinations of some values, on all cores.",
        epilog=EXAMPLES,
    )
    add_gesture(parser)
    add_folder(parser, text="folder for the results")
    parser.add_argument(
        "--vary",
        action="append",
        required=True,
        metavar="NAME=VALUES",
        help="V1,V2,... or FROM:TO:STEPS of a control or instrument entry; may be repeated",
    )
    parser.add_argument(
        "--index-only", action="store_true", help="keep pitch and level of each run, but no arrays"
    )
    parser.add_argument(
        "--workers",
        type=positive,
        metavar="N",
        help="number of runs at a time (default: one per core)",
    )
    parser.add_argument(
        "--overwrite",
        action="store_true",
        help="remove the results of an earlier sweep from the folder",
    )
    add_reporting(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    import time

    from yehu_server.score.gesture import read_gesture
    from yehu_server.sweep import INDEX, axis_of, sweep, variations

    gesture = read_gesture(arguments.gesture)
    axes = [axis_of(text) for text in arguments.vary]
    runs = variations(gesture.source, axes, arguments.gesture.parent)
    start = time.perf_counter()
    warn_of_compiling(arguments, plays=False)
    with progress_bar(arguments, "sweeping", "runs") as progress:
        rows = sweep(
            runs,
            arguments.output,
            energy=arguments.energy,
            strings_every=arguments.strings,
            keep=not arguments.index_only,
            workers=arguments.workers,
            overwrite=arguments.overwrite,
            progress=progress,
        )
    elapsed = time.perf_counter() - start
    seconds = len(rows) * gesture.duration
    if arguments.json:
        print(json.dumps({"runs": len(rows), "elapsed_s": elapsed, "simulated_s": seconds}))
    elif not arguments.quiet:
        pace = f"{seconds:.1f} s in {elapsed:.1f} s"
        tell(f"{arguments.output / INDEX}: {len(rows)} runs, {pace}")
    return 0
