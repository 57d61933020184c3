"""``yehu-server render``."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import (
    add_command,
    add_instrument,
    add_output,
    add_reporting,
    check_output,
    progress_bar,
    warn_of_compiling,
)
from yehu_server.cli.converters import channel, decibels, seconds, share, whole
from yehu_server.cli.style_options import add_playing, style_of
from yehu_server.cli.terminal import tell, warn

if TYPE_CHECKING:
    from yehu_server.playing.style import Style

PHRASING = 0.5  # of files, where nothing else is asked for
EXAMPLES = """\
examples:
  yehu-server render tune.mid -o tune.wav
  yehu-server render tune.mid -o tune.flac --rate 48000 --normalize
  yehu-server render suite-1.mid suite-2.mid -o suite.wav --channel 1
  yehu-server render tune.mid -o close.wav --set /playing/bow_position=0.08 --gain-db 6
"""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "render",
        run=run,
        help="render MIDI files to a sound file",
        description="Render MIDI files, one after another, to a sound file.",
        epilog=EXAMPLES,
    )
    parser.add_argument("midi", nargs="+", type=Path, metavar="IN.mid", help="the MIDI files")
    add_output(parser)
    parser.add_argument(
        "--rate",
        type=whole,
        default=44100,
        metavar="HZ",
        help="sample rate (default: 44100)",
    )
    parser.add_argument(
        "--format", choices=("wav", "flac"), help="file format (default: by the ending of OUT)"
    )
    parser.add_argument(
        "--subtype",
        choices=("16", "24", "float"),
        default="24",
        help="sample format (default: 24 bits)",
    )
    parser.add_argument(
        "--channel",
        type=channel,
        action="append",
        metavar="N",
        help="play only this MIDI channel, 1 to 16; may be repeated (default: all but 10)",
    )
    parser.add_argument(
        "--tail",
        type=seconds,
        metavar="SECONDS",
        help="time after the end of the score, up to 600 "
        "(default: until 80 dB below full scale, at most 5 s)",
    )
    parser.add_argument(
        "--gain-db",
        type=decibels,
        metavar="DB",
        help="gain before the limiter, -60 to 24 (default: 0, or that of --preset)",
    )
    parser.add_argument(
        "--normalize", action="store_true", help="scale the result to a peak of -1 dBFS"
    )
    parser.add_argument(
        "--phrasing",
        type=share,
        metavar="SHARE",
        help="how much plain notes are shaped, by phrases, accents, slurs, vibrato and slides; "
        "what a file marks stays: 0 to 1 (default: 0.5; 0: exactly as written)",
    )
    add_instrument(parser)
    add_playing(parser)
    add_reporting(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.audio.file import format_of
    from yehu_server.engine.warming import warm_up
    from yehu_server.files import check_apart
    from yehu_server.physics.grid import check_rate
    from yehu_server.physics.quantities import Quantities, read_quantities
    from yehu_server.playing.calibration import calibration_key
    from yehu_server.playing.calibrations import calibration_for
    from yehu_server.render import Options, render
    from yehu_server.score.phrasing import is_fingered, phrased
    from yehu_server.score.smf import concatenate, read_score

    check_rate(arguments.rate)
    style = style_of(arguments)
    phrasing = arguments.phrasing
    if phrasing is None:
        phrasing = dict(style.settings).get("/playing/phrasing", PHRASING)
    instrument = [] if arguments.instrument is None else [arguments.instrument]
    check_apart({"-o": arguments.output}, [*arguments.midi, *style.files, *instrument])
    may_replace = check_output(arguments)
    _warn_of_own(arguments, style)
    channels = arguments.channel
    options = Options(
        rate=arguments.rate,
        format_name=arguments.format or format_of(arguments.output),
        subtype=arguments.subtype,
        channels=frozenset(channels) if channels is not None else None,
        tail_s=arguments.tail,
        gain_db=arguments.gain_db,
        normalize=arguments.normalize,
        style=style,
        quantities=read_quantities(arguments.instrument) if arguments.instrument else Quantities(),
    )
    scores = [read_score(path) for path in arguments.midi]
    score = concatenate([phrased(score, phrasing) for score in scores])
    options = replace(options, phrasing=0.0 if is_fingered(score) else phrasing)
    for warning in score.warnings:
        warn(warning)
    warn_of_compiling(arguments)
    warm_up()
    with progress_bar(arguments, "calibrating", "notes") as progress:
        rate = float(options.rate)
        calibration = calibration_for(
            rate, options.quantities, a4=options.style.a4, progress=progress
        )
    options = replace(options, calibration=calibration)
    with progress_bar(arguments, "rendering") as progress:
        summary = render(score, arguments.output, options, progress, may_replace)
    if arguments.json:
        fields = dict(vars(summary))
        by_channel = fields.pop("notes_by_channel")
        fields["policy"] = summary.policy.value
        fields["mapping"] = {"name": style.mapping.name, "files": [*map(str, style.mapping.files)]}
        fields["phrasing"] = phrasing
        fields["preset"] = None if style.preset is None else str(style.preset)
        fields["calibration"] = calibration_key(rate, options.quantities, style.a4)
        fields["practice"] = "shipped" if style.practice is None else str(style.practice)
        fields["channels"] = {str(channel + 1): notes for channel, notes in by_channel.items()}
        print(json.dumps(fields))
    elif not arguments.quiet:
        from yehu_server.report import render_report

        tell(render_report(arguments.output, summary))
    return 0


def _warn_of_own(arguments: argparse.Namespace, style: Style) -> None:
    """Warn where serve would use the user's own mapping of this name."""
    from yehu_server.playing.mapping import MINE, own_mappings

    own = style.mapping.files[0].stem
    if (arguments.mapping or own) == own and own in own_mappings() and not arguments.quiet:
        warn(f"mapping {own}: the shipped one; --mapping {MINE}{own} is your own")
