"""Fit a body to measurements of your fiddle, and show it.

  yehu-server body taps -o taps
  yehu-server body fit taps/*.wav --channels force=32,velocity=0.5,pressure=4 -o mine.toml
  yehu-server body fit admittance.csv --kind mobility --radiation sound.csv -o mine.toml
  yehu-server body show mine.toml -o mine.png
  yehu-server render tune.mid -o tune.wav --instrument mine.toml

docs/body.md describes how to measure, and what the files hold.
"""

from __future__ import annotations

import argparse
import json
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import (
    add_action,
    add_actions,
    add_command,
    add_options,
    picture_output,
)
from yehu_server.cli.converters import folder, number_within, positive, target, whole
from yehu_server.cli.terminal import print_result, warn
from yehu_server.util.files import check_distinct

if TYPE_CHECKING:
    from yehu_lab.body import Fit


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "body", __doc__)
    actions = add_actions(parser)
    _add_fit(actions)
    show = add_action(actions, "show", _show, "show a body next to its measurement")
    add_options(
        show,
        "body FILE: an instrument file or a body file (default: the body that is shipped)",
        body={"nargs": "?", "type": Path},
    )
    add_options(
        show,
        """
        -o --output PNG: draw the body to this picture
        --overwrite: replace an existing file
        --json: print one JSON object
        """,
        output=target,
    )
    taps = add_action(actions, "taps", _taps, "write example taps of the shipped body")
    add_options(
        taps,
        """
        -o --output FOLDER: folder for the sound files; created if missing
        --count N: number of taps (default: 5)
        --noise-db DB: level of the noise, dB below the signals (default: 40)
        --overwrite: replace existing files
        """,
        output={"required": True, "type": folder},
        count={"type": positive, "default": 5},
        noise_db={"type": number_within(0.0, 200.0, "dB"), "default": 40.0},
    )


def _add_fit(actions: Any) -> None:
    fit = add_action(actions, "fit", _fit, "fit a body to measurements")
    add_options(
        fit,
        """
        measurements FILE: taps as sound files or .csv, or responses as .csv or .uff
        -o --output OUT: an instrument file, .toml, with its body file beside it; or a body file,
            .json
        --radiation FILE: measurements of the sound pressure, apart from the others
        --channels NAME=UNITS,...: what the channels of sound files are, and their SI units at full
            scale: force, velocity, acceleration, displacement, pressure or none
        --radiation-channels NAME=UNITS,...: what the channels of --radiation are, and their SI
            units at full scale: force, velocity, acceleration, displacement, pressure or none
        --kind: what the responses of a .csv or .uff file measure, where the file does not say
        --sensor-mass GRAMS: mass of the accelerometer on the bridge, whose effect is removed
        --band LO:HI: frequencies to fit, in Hz (default: from 100 to where the hammer excites)
        --modes N: number of bridge modes (default: as many as the measurement shows)
        --plot PNG: also draw the measurement and the fit
        --overwrite: replace existing files
        --json: print one JSON object when done
        """,
        measurements={"nargs": "*", "type": Path},
        output={"required": True, "type": target},
        radiation={"nargs": "+", "type": Path, "default": []},
        kind={"choices": ("mobility", "receptance", "accelerance", "radiation")},
        sensor_mass=number_within(0.0, 50.0, "g"),
        band=_band,
        modes=whole,
        plot=target,
    )


def _fit(arguments: argparse.Namespace) -> int:
    # Before NumPy is loaded: threads would only wait for each other, since matrices are small.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from yehu_lab.body import fit, read
    from yehu_lab.body.body_file import body_file_of, check_targets
    from yehu_lab.plot.body import write_picture

    measurements = [*arguments.measurements, *arguments.radiation]
    outputs = {"-o": arguments.output}
    if body_file_of(arguments.output) != arguments.output:
        outputs["the body file"] = body_file_of(arguments.output)
    check_distinct(outputs | picture_output(arguments), measurements)
    check_targets(arguments.output, overwrite=arguments.overwrite)
    measured = read(
        arguments.measurements,
        radiation=arguments.radiation,
        channels=arguments.channels,
        radiation_channels=arguments.radiation_channels,
        kind=arguments.kind,
        sensor_mass=None if arguments.sensor_mass is None else 1e-3 * arguments.sensor_mass,
    )
    found = fit(measured, band_hz=arguments.band, modes=arguments.modes)
    written = found.save(arguments.output, overwrite=arguments.overwrite)
    if arguments.plot is not None:
        write_picture(found, arguments.plot, overwrite=arguments.overwrite)
    _report(found, as_json=arguments.json)
    if not arguments.json:
        print_result(f"written: {', '.join(map(str, written))}")
    return 0


def _show(arguments: argparse.Namespace) -> int:
    from yehu_lab.body.body_file import read_fit
    from yehu_lab.plot.body import write_picture
    from yehu_server.core.physics.default_quantities import BODY_FILE
    from yehu_server.plot.png import check_picture

    path = arguments.body or BODY_FILE
    if arguments.output is not None:
        check_picture(arguments.output, "a picture", overwrite=arguments.overwrite)
        check_distinct({"-o": arguments.output}, [path])
    found = read_fit(path)
    if arguments.output is not None:
        write_picture(found, arguments.output, overwrite=arguments.overwrite)
    _report(found, as_json=arguments.json)
    return 0


def _report(found: Fit, *, as_json: bool) -> None:
    from yehu_lab.body.report import fields_of, lines_of

    if as_json:
        print(json.dumps(fields_of(found)))
        return
    for line in lines_of(found):
        print_result(line)
    for line in found.warnings:
        warn(line)


def _taps(arguments: argparse.Namespace) -> int:
    from yehu_lab.body import made_taps
    from yehu_lab.body.tap import write_taps

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
