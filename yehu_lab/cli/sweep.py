"""Bow all strokes of a study, or variations of a gesture, on all cores, and judge each.

The result has the kind of motion (regime) of each stroke, its onset, pitch, level and brightness.
The same command continues an interrupted sweep. `sweep show FILE` draws the result, `sweep forces
FILE` prints between which bow forces strokes speak.

  yehu-server sweep examples/studies/schelleng.toml -o schelleng.npz
  yehu-server sweep show schelleng.npz -o schelleng.png
  yehu-server sweep show schelleng.npz -o schelleng.html
  yehu-server sweep forces schelleng.npz
  yehu-server sweep gesture.json -o runs.npz --vary bow_force=0.1:2:20:log
  yehu-server sweep gesture.json -o runs.npz --vary instrument.bow.epsilon_0=2e4,3e4 --signals runs

The first example bows 14,780 strokes, which takes some minutes. Studies are described in
docs/sweep.md, gestures in docs/simulate.md.
"""

import argparse
import time
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import (
    Parser,
    add_cluster,
    add_command,
    add_instrument,
    add_options,
    add_reporting,
    check_new,
    cluster_of,
)
from yehu_server.cli.converters import positive, target
from yehu_server.cli.terminal import compile_all, print_report, progress_bar
from yehu_server.errors import ParameterError


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "sweep", __doc__, run)
    add_options(
        parser,
        """
        study STUDY: a study (TOML), or a gesture (JSON) with --vary
        -o --output FILE: the result to write, .npz
        --vary NAME=VALUES ...: values to try, as V1,V2,... or FROM:TO:STEPS or FROM:TO:STEPS:log;
            may be repeated
        --signals FOLDER: also keep all signals of each stroke, as yehu-server simulate does
        --energy: with --signals: also the energy ledger
        --strings EVERY: with --signals: also the shapes of the strings, every EVERY samples
        --workers N: number of strokes at a time (default: one per core)
        """,
        study=Path,
        output={"required": True, "type": target},
        signals=Path,
        strings={"type": positive, "default": 0},
        workers=positive,
    )
    add_instrument(parser)
    add_cluster(parser)
    add_options(parser, "--overwrite: replace an earlier result, or begin anew")
    add_reporting(parser)
    add_show(parser)
    add_forces(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_lab.regimes import strokes
    from yehu_lab.sweeps.axes import axis_of
    from yehu_lab.sweeps.running import (
        check_free_result,
        keep_signals,
        prepare_folder,
        sweep_to,
        warm_up,
    )
    from yehu_lab.sweeps.study import read_study
    from yehu_server.simulation import run as simulation

    axes = [axis_of(text) for text in arguments.vary]
    study = read_study(arguments.study, axes, arguments.instrument)
    check_free_result(arguments.output, overwrite=arguments.overwrite)
    if arguments.signals is not None:
        prepare_folder(study, arguments.signals, overwrite=arguments.overwrite)
    start = time.perf_counter()
    if arguments.dask is None:
        compile_all(arguments, {**simulation.COMPILED, **strokes.COMPILED})
    with (
        cluster_of(arguments, warm_up) as cluster,
        progress_bar(arguments, "sweeping", "strokes") as progress,
    ):
        result = sweep_to(
            study,
            arguments.output,
            workers=arguments.workers,
            cluster=cluster,
            overwrite=arguments.overwrite,
            progress=progress,
        )
    elapsed = time.perf_counter() - start
    if arguments.signals is not None:
        with progress_bar(arguments, "keeping signals", "strokes") as progress:
            keep_signals(
                study,
                result,
                arguments.signals,
                energy=arguments.energy,
                strings_every=arguments.strings,
                workers=arguments.workers,
                progress=progress,
            )
    counts = counts_of(result)
    shares = ", ".join(f"{name} {100.0 * n / len(result):.0f} %" for name, n in counts.items())
    text = f"{arguments.output}: {len(result)} strokes in {elapsed:.1f} s\n{shares}"
    fields = {"strokes": len(result), "elapsed_s": elapsed, "regimes": counts}
    print_report(arguments, fields, text)
    return 0


def counts_of(result: Any) -> dict[str, int]:
    """The number of strokes of each regime that there is."""
    numbers = result.columns["regime"].tolist()
    return {
        name: count
        for number, name in enumerate(result.regimes)
        if (count := numbers.count(number))
    }


DEFAULT = "regime"


def add_show(command: Parser) -> None:
    """Add `sweep show` to the parser of `sweep`."""
    parser = command.add_word("show", show, "draw the result of a sweep")
    add_options(
        parser,
        """
        result FILE: the result of a sweep
        -o --output OUT: a picture, .png, or a page to browse, .html (default: FILE with .png)
        --column NAME: what a picture shows, such as helmholtz_s or pitch_hz (default: regime)
        --overwrite: replace OUT, whatever it is; pictures are replaced anyway
        """,
        result=Path,
        output=target,
        column={"default": DEFAULT},
    )
    add_reporting(parser)


def add_forces(command: Parser) -> None:
    """Add `sweep forces` to the parser of `sweep`."""
    parser = command.add_word(
        "forces", forces, "print the bow forces between which strokes speak, and Schelleng's limits"
    )
    add_options(
        parser,
        """
        result FILE: the result of a sweep over the bow's force
        """,
        result=Path,
    )
    add_reporting(parser)


def forces(arguments: argparse.Namespace) -> int:
    """Print thresholds; return the exit code. Raises ParameterError where there are none."""
    from yehu_lab.sweeps.result import Result
    from yehu_lab.sweeps.thresholds import thresholds_of

    found = thresholds_of(Result.load(arguments.result))
    fields = {"thresholds": [vars(each) for each in found]}
    print_report(arguments, fields, "\n".join(map(str, found)))
    return 0


def show(arguments: argparse.Namespace) -> int:
    """Draw a result; return the exit code. Raises ParameterError where the call is wrong."""
    from yehu_lab.plot.study import write_page, write_picture
    from yehu_lab.sweeps.result import Result
    from yehu_server.plot.png import check_picture

    output = arguments.output or arguments.result.with_suffix(".png")
    if output.suffix not in {".png", ".html"}:
        raise ParameterError(f"{output}: name a picture .png, or a page .html")
    if output.suffix == ".png":
        check_picture(output, "a picture", overwrite=arguments.overwrite)
    else:
        check_new(arguments, output)
    result = Result.load(arguments.result)
    if output.suffix == ".png":
        write_picture(result, output, arguments.column, overwrite=arguments.overwrite)
    else:
        write_page(result, output)
    fields = {"strokes": len(result), "shape": result.shape, "output": str(output)}
    print_report(arguments, fields, f"{output}: {len(result)} strokes")
    return 0
