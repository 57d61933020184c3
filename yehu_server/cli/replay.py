"""Render a captured session to a sound file: the same samples, on the same build.

  yehu-server serve --capture session.jsonl --record session.wav
  yehu-server replay session.jsonl -o again.wav

The capture file is described in docs/capture.md.
"""

import argparse
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import (
    add_command,
    add_options,
    add_output,
    add_reporting,
    check_output,
)
from yehu_server.cli.converters import hours
from yehu_server.cli.terminal import compile_all, print_report, progress_bar, warn
from yehu_server.util.files import check_distinct
from yehu_server.util.subtypes import DEFAULT_SUBTYPES, FORMATS, SUBTYPES

MAX_DURATION_H = 12.0


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "replay", __doc__, run)
    add_options(parser, "capture CAPTURE: a capture that serve --capture wrote", capture=Path)
    add_output(parser)
    add_options(
        parser,
        f"""
        --format: file format (default: by the ending of OUT)
        --subtype: sample format (default: float in WAV, as recorded; 24 in FLAC)
        --max-duration HOURS: refuse a capture that lasts longer (default: {MAX_DURATION_H:g})
        """,
        format={"choices": FORMATS},
        subtype={"choices": tuple(SUBTYPES)},
        max_duration={"type": hours, "default": MAX_DURATION_H},
    )
    add_reporting(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.cli.report import replay_report
    from yehu_server.rendering.replay import replay
    from yehu_server.scores.capture import read_capture
    from yehu_server.util.sound_file import format_of

    check_distinct({"-o": arguments.output}, [arguments.capture])
    may_replace = check_output(arguments)
    format_name = arguments.format or format_of(arguments.output)
    capture = read_capture(arguments.capture)
    for warning in capture.warnings:
        warn(f"{arguments.capture}: {warning}")
    compile_all(arguments)
    with progress_bar(arguments, "replaying") as progress:
        result = replay(
            capture,
            arguments.output,
            format_name=format_name,
            subtype=arguments.subtype or DEFAULT_SUBTYPES[format_name],
            max_duration_h=arguments.max_duration,
            progress=progress,
            may_replace=may_replace,
        )
    print_report(arguments, vars(result), replay_report(arguments.output, result))
    return 0
