"""``yehu-server body``: from taps on a fiddle to a body that the model plays."""

from __future__ import annotations

import argparse
import json
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_action, add_command
from yehu_server.cli.converters import positive, target, whole
from yehu_server.cli.terminal import print_result, warn

if TYPE_CHECKING:
    from yehu_server.lab.body import Fit, Measurement

EXAMPLES = """\
examples:
  yehu-server body taps -o taps
  yehu-server body fit taps/*.wav --channels force=32,velocity=0.5,pressure=4 -o mine.toml
  yehu-server body fit admittance.csv --kind mobility --radiation sound.csv -o mine.toml
  yehu-server body show mine.toml -o mine.png
  yehu-server render tune.mid -o tune.wav --instrument mine.toml

docs/body.md tells how to measure, and what the files hold.
"""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "body",
        help="put the body of your own fiddle into the model, from measurements",
        description="Fit a body to measurements of a fiddle, and look at it.",
        epilog=EXAMPLES,
    )
    actions = parser.add_subparsers(
        title="actions", metavar="ACTION", required=True, prog=parser.prog
    )
    _add_fit(actions)
    show = add_action(actions, "show", _show, "show a body, beside what was measured")
    show.add_argument(
        "body", nargs="?", type=Path, metavar="FILE",
        help="an instrument file or a body file (default: the body that is shipped)",
    )  # fmt: skip
    _add_picture(show)
    taps = add_action(actions, "taps", _taps, "write taps of the shipped body, to try this with")
    taps.add_argument(
        "-o", "--output", required=True, type=target, metavar="FOLDER",
        help="folder for the sound files; created if missing",
    )  # fmt: skip
    taps.add_argument("--count", type=positive, default=5, metavar="N", help="taps (default: 5)")
    taps.add_argument(
        "--noise-db", type=_decibels, default=40.0, metavar="DB",
        help="how far noise lies below the signals (default: 40)",
    )  # fmt: skip
    taps.add_argument("--overwrite", action="store_true", help="replace files that are there")


def _add_fit(actions: Any) -> None:
    fit = add_action(actions, "fit", _fit, "fit a body to measurements")
    fit.add_argument(
        "measurements", nargs="*", type=Path, metavar="FILE",
        help="taps as sound files or .csv, or responses as .csv or .uff",
    )  # fmt: skip
    fit.add_argument(
        "-o", "--output", required=True, type=target, metavar="OUT",
        help="an instrument file, .toml, with its body file beside it; or a body file, .json",
    )  # fmt: skip
    fit.add_argument(
        "--radiation", nargs="+", type=Path, default=[], metavar="FILE",
        help="measurements of which the sound pressure alone is used",
    )  # fmt: skip
    for name, text in (("--channels", "sound files"), ("--radiation-channels", "--radiation")):
        fit.add_argument(
            name, metavar="NAME=UNITS,...",
            help=f"what the channels of {text} are, and their SI units at full scale: force, "
            "velocity, acceleration, displacement, pressure or none",
        )  # fmt: skip
    fit.add_argument(
        "--kind", choices=("mobility", "receptance", "accelerance", "radiation"),
        help="what the responses of a .csv or .uff are that does not tell",
    )  # fmt: skip
    fit.add_argument(
        "--band", type=_band, metavar="LO:HI",
        help="frequencies to fit, Hz (default: from 100 to where the hammer excites)",
    )  # fmt: skip
    fit.add_argument(
        "--modes", type=whole, metavar="N",
        help="number of bridge modes, 1 to 16 (default: as many as show)",
    )  # fmt: skip
    fit.add_argument("--plot", type=target, metavar="PNG", help="draw measured and fitted, too")
    fit.add_argument("--overwrite", action="store_true", help="replace other files, too")
    fit.add_argument("--json", action="store_true", help="print one JSON object when done")


def _add_picture(parser: Any) -> None:
    parser.add_argument(
        "-o", "--output", type=target, metavar="PNG", help="draw it, to this picture"
    )
    parser.add_argument("--overwrite", action="store_true", help="replace another file")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def _fit(arguments: argparse.Namespace) -> int:
    # Before NumPy is loaded: threads would only wait for each other, since matrices are small.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from yehu_server.lab.body import fit
    from yehu_server.lab.body.body_file import body_file_of, check_ending, check_targets
    from yehu_server.lab.plot.body import write_picture
    from yehu_server.lab.plot.png import check_picture
    from yehu_server.util.files import check_distinct

    measurements = [*arguments.measurements, *arguments.radiation]
    outputs = {"-o": arguments.output}
    check_ending(arguments.output)
    if body_file_of(arguments.output) != arguments.output:
        outputs["the body file"] = body_file_of(arguments.output)
    if arguments.plot is not None:
        check_picture(arguments.plot, "--plot", overwrite=arguments.overwrite)
        outputs["--plot"] = arguments.plot
    check_distinct(outputs, measurements)
    check_targets(arguments.output, overwrite=arguments.overwrite)
    found = fit(_read(arguments), band_hz=arguments.band, modes=arguments.modes)
    written = found.save(arguments.output, overwrite=arguments.overwrite)
    if arguments.plot is not None:
        write_picture(found, arguments.plot, overwrite=arguments.overwrite)
    _tell(found, as_json=arguments.json)
    if not arguments.json:
        print_result(f"written: {', '.join(map(str, written))}")
    return 0


def _read(arguments: argparse.Namespace) -> Measurement:
    from yehu_server.lab.body import read

    return read(
        arguments.measurements,
        radiation=arguments.radiation,
        channels=arguments.channels,
        radiation_channels=arguments.radiation_channels,
        kind=arguments.kind,
    )


def _show(arguments: argparse.Namespace) -> int:
    from yehu_server.core.physics.quantities import BODY_FILE
    from yehu_server.lab.body.body_file import read_fit
    from yehu_server.lab.plot.body import write_picture
    from yehu_server.lab.plot.png import check_picture
    from yehu_server.util.files import check_distinct

    path = arguments.body or BODY_FILE
    if arguments.output is not None:
        check_picture(arguments.output, "a picture", overwrite=arguments.overwrite)
        check_distinct({"-o": arguments.output}, [path])
    found = read_fit(path)
    if arguments.output is not None:
        write_picture(found, arguments.output, overwrite=arguments.overwrite)
    _tell(found, as_json=arguments.json)
    return 0


def _tell(found: Fit, *, as_json: bool) -> None:
    from yehu_server.lab.body.report import fields_of, lines_of

    if as_json:
        print(json.dumps(fields_of(found)))
        return
    for line in lines_of(found):
        print_result(line)
    for line in found.warnings:
        warn(line)


def _taps(arguments: argparse.Namespace) -> int:
    from yehu_server.lab.body import made_taps
    from yehu_server.lab.body.tap_files import write_taps

    taps = made_taps(count=arguments.count, noise_db=arguments.noise_db)
    files, channels = write_taps(taps, arguments.output, overwrite=arguments.overwrite)
    print_result(f"{len(files)} files in {arguments.output}, for --channels {channels}")
    return 0


def _band(text: str) -> tuple[float, float]:
    lo, _, hi = text.partition(":")
    try:
        band = float(lo), float(hi)
    except ValueError:
        band = (math.nan, math.nan)
    if not 0.0 < band[0] < band[1] < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not a band, such as 100:5000")
    return band


def _decibels(text: str) -> float:
    from yehu_server.cli.converters import within

    return within(text, 0.0, 200.0, "dB")
