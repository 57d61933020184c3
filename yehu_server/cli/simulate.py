"""Run the physical model with a gesture file and keep every signal.

  yehu-server simulate gesture.json -o run.npz --energy
  yehu-server simulate gesture.json -o run.npz --strings 100

The gesture file is described in docs/simulate.md.
"""

import argparse
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import (
    add_command,
    add_instrument,
    add_options,
    add_reporting,
    check_new,
)
from yehu_server.cli.converters import positive, target
from yehu_server.cli.terminal import compile_all, print_report, progress_bar
from yehu_server.util.files import check_distinct


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "simulate", __doc__, run)
    add_options(
        parser,
        """
        gesture GESTURE.json: a gesture file: motion of bow and finger
        --energy: also keep the energy ledger
        --strings EVERY: keep the shapes of the strings, once in EVERY samples (default: never)
        -o --output OUT.npz: the arrays to write
        --overwrite: replace OUT.npz if it exists
        """,
        gesture=Path,
        strings={"type": positive, "default": 0},
        output={"required": True, "type": target},
    )
    add_instrument(parser)
    add_reporting(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.cli.report import simulate_report
    from yehu_server.scores.gesture import read_gesture
    from yehu_server.simulation.run import COMPILED, simulate
    from yehu_server.util.npz_file import check_npz

    gesture = read_gesture(arguments.gesture, arguments.instrument)
    own = [] if arguments.instrument is None else [arguments.instrument]
    check_distinct({"-o": arguments.output}, [arguments.gesture, *own])
    check_new(arguments)
    check_npz(arguments.output)
    compile_all(arguments, COMPILED if arguments.energy else {})
    with progress_bar(arguments, "simulating") as progress:
        result = simulate(
            gesture, energy=arguments.energy, strings_every=arguments.strings, progress=progress
        )
    result.save(arguments.output, overwrite=arguments.overwrite)
    text = simulate_report(arguments.output, result)
    print_report(arguments, dict(result.meta), text)
    return 0
