"""The command line: words to calls."""

from __future__ import annotations

import argparse
import contextlib
import json
import signal
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NoReturn

from rich_argparse import RawDescriptionRichHelpFormatter

from yehu_server import __version__
from yehu_server.errors import YehuError

RENDER_EXAMPLES = """\
examples:
  yehu-server render tune.mid -o tune.wav
  yehu-server render tune.mid -o tune.flac --rate 48000 --normalize
  yehu-server render suite-1.mid suite-2.mid -o suite.wav --channel 1
  yehu-server render tune.mid -o close.wav --set /bow/position=0.08 --gain-db 6
"""
SIMULATE_EXAMPLES = """\
examples:
  yehu-server simulate gesture.json -o run.npz --energy
  yehu-server simulate gesture.json -o run.npz --strings 100

The gesture file is described in docs/simulate.md.
"""


class Parser(argparse.ArgumentParser):
    """One clear line for a wrong call, without the usage around it."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong and leave with code 2."""
        line = message.replace("\n", "\\n")
        self.exit(2, f"{self.prog}: {line} (see {self.prog} --help)\n")


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; return its exit code: 0, 2 for bad input, 130 when interrupted."""
    arguments = _parser().parse_args(argv)
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), _interrupt)
    try:
        code: int = arguments.run(arguments)
    except YehuError as error:
        line = str(error).replace("\n", "\\n")
        print(f"yehu-server: {line}", file=sys.stderr)
        return 2
    except MemoryError:
        print("yehu-server: not enough memory", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("yehu-server: interrupted, nothing written", file=sys.stderr)
        return 130
    return code


def _interrupt(*_: object) -> NoReturn:
    raise KeyboardInterrupt


def _parser() -> Parser:
    parser = Parser(
        prog="yehu-server",
        description="A virtual yehu, the Chinese two-stringed fiddle: its physics, simulated.",
        formatter_class=RawDescriptionRichHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"yehu-server {__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    _add_render(commands)
    _add_simulate(commands)
    return parser


def _add_render(commands: Any) -> None:
    parser = commands.add_parser(
        "render",
        help="MIDI files into a sound file",
        description="Play MIDI files on the instrument, one after another, into a sound file.",
        epilog=RENDER_EXAMPLES,
        formatter_class=RawDescriptionRichHelpFormatter,
        allow_abbrev=False,
    )
    parser.set_defaults(run=_render)
    parser.add_argument("midi", nargs="+", type=Path, metavar="IN.mid", help="what to play")
    parser.add_argument(
        "-o", "--output", required=True, type=Path, metavar="OUT", help="the sound file to write"
    )
    parser.add_argument(
        "--rate",
        type=_whole,
        default=44100,
        metavar="HZ",
        help="sample rate, 22050 to 192000 (default: 44100)",
    )
    parser.add_argument("--format", choices=("wav", "flac"), help="default: by the ending of OUT")
    parser.add_argument(
        "--subtype",
        choices=("16", "24", "float"),
        default="24",
        help="how samples are stored (default: 24 bits)",
    )
    parser.add_argument(
        "--channel",
        type=_channel,
        action="append",
        metavar="N",
        help="play only this MIDI channel, 1 to 16; may be repeated (default: all but 10)",
    )
    parser.add_argument(
        "--tail",
        type=_seconds,
        metavar="SECONDS",
        help="how long to go on after the end of the score, up to 600 "
        "(default: until 80 dB under full scale, at most 5 s)",
    )
    parser.add_argument(
        "--gain-db",
        type=_decibels,
        default=0.0,
        metavar="DB",
        help="gain before the limiter, -60 to 24 (default: 0)",
    )
    parser.add_argument(
        "--normalize", action="store_true", help="scale the result to a peak of -1 dBFS"
    )
    parser.add_argument(
        "--mapping",
        default="keyboard",
        metavar="FILE",
        help="what controllers do: a shipped mapping's name or a file (default: keyboard)",
    )
    parser.add_argument(
        "--instrument",
        type=Path,
        metavar="FILE",
        help="a TOML or JSON file of physical quantities to change",
    )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="ADDRESS=VALUE",
        help="hold a parameter at a value, such as /bow/position=0.1; may be repeated",
    )
    parser.add_argument(
        "--range",
        choices=("transpose", "clamp", "skip"),
        default="transpose",
        help="what becomes of notes outside F4 to F6 (default: transpose, by octaves)",
    )
    parser.add_argument(
        "--seed",
        type=_whole,
        default=0,
        metavar="N",
        help="of the chance in /playing/variation (default: 0)",
    )
    _add_reporting(parser)


def _add_simulate(commands: Any) -> None:
    parser = commands.add_parser(
        "simulate",
        help="a gesture in physical units into arrays",
        description="Run the physical model through a gesture file and keep every signal.",
        epilog=SIMULATE_EXAMPLES,
        formatter_class=RawDescriptionRichHelpFormatter,
        allow_abbrev=False,
    )
    parser.set_defaults(run=_simulate)
    parser.add_argument("gesture", type=Path, metavar="GESTURE.json", help="what bow and finger do")
    parser.add_argument(
        "-o", "--output", required=True, type=Path, metavar="OUT.npz", help="the arrays to write"
    )
    parser.add_argument("--energy", action="store_true", help="keep the energy ledger too")
    parser.add_argument(
        "--strings",
        type=_positive,
        default=0,
        metavar="EVERY",
        help="keep the strings' shapes every so many samples",
    )
    _add_reporting(parser)


def _add_reporting(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object when done")
    parser.add_argument("--quiet", action="store_true", help="no progress bar, no summary")


def _render(arguments: argparse.Namespace) -> int:
    from yehu_server.audio.file import format_of
    from yehu_server.files import check_target
    from yehu_server.params.table import assignment
    from yehu_server.physics.grid import check_rate
    from yehu_server.physics.quantities import Quantities, read_quantities
    from yehu_server.playing.fingering import RangePolicy
    from yehu_server.playing.mapping import load
    from yehu_server.render import Options, render, warm_up
    from yehu_server.score.smf import concatenate, read_score

    check_rate(arguments.rate)
    check_target(arguments.output, arguments.midi)
    channels = arguments.channel
    options = Options(
        rate=arguments.rate,
        format_name=arguments.format or format_of(arguments.output),
        subtype=arguments.subtype,
        channels=frozenset(channels) if channels is not None else None,
        tail_s=arguments.tail,
        gain_db=arguments.gain_db,
        normalize=arguments.normalize,
        mapping=load(arguments.mapping),
        settings=tuple(assignment(text) for text in arguments.set),
        seed=arguments.seed,
        policy=RangePolicy(arguments.range),
        quantities=read_quantities(arguments.instrument) if arguments.instrument else Quantities(),
    )
    score = concatenate([read_score(path) for path in arguments.midi])
    for warning in score.warnings:
        print(f"yehu-server: {warning}", file=sys.stderr)
    with _compiling(arguments):
        warm_up()
    with _progress(arguments, "rendering") as progress:
        summary = render(score, arguments.output, options, progress)
    if arguments.json:
        fields = dict(vars(summary))
        by_channel = fields.pop("notes_by_channel")
        fields["policy"] = summary.policy.value
        fields["channels"] = {str(channel + 1): notes for channel, notes in by_channel.items()}
        print(json.dumps(fields))
    elif not arguments.quiet:
        from yehu_server.report import render_report

        print(render_report(arguments.output, summary))
    return 0


def _simulate(arguments: argparse.Namespace) -> int:
    import time

    from yehu_server.files import check_target
    from yehu_server.score.gesture import read_gesture
    from yehu_server.simulate import simulate

    gesture = read_gesture(arguments.gesture)
    check_target(arguments.output, [arguments.gesture])
    start = time.perf_counter()
    with _compiling(arguments), _progress(arguments, "simulating") as progress:
        result = simulate(
            gesture,
            energy=arguments.energy,
            strings_every=arguments.strings,
            progress=progress,
        )
    result.save(arguments.output)
    elapsed = time.perf_counter() - start
    if arguments.json:
        print(json.dumps({**result.meta, "elapsed_s": elapsed}))
    elif not arguments.quiet:
        from yehu_server.report import simulate_report

        print(simulate_report(arguments.output, result))
    return 0


@contextlib.contextmanager
def _compiling(arguments: argparse.Namespace) -> Iterator[None]:
    """Say why the first use takes a while."""
    from yehu_server.jit import IS_CACHED, cache_folder

    if arguments.quiet:
        pass
    elif not IS_CACHED:
        print(f"yehu-server: compiling; {cache_folder()} is not writable", file=sys.stderr)
    elif not any(cache_folder().rglob("*.nbi")):
        print("yehu-server: compiling for this machine, once ...", file=sys.stderr)
    yield


@contextlib.contextmanager
def _progress(arguments: argparse.Namespace, what: str) -> Iterator[Any]:
    """A progress bar on a terminal; silence elsewhere."""
    if arguments.quiet or not sys.stderr.isatty():
        yield lambda _done, _total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn(what),
        BarColumn(),
        TextColumn("{task.completed:.1f} of {task.total:.1f} s"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=0.0)
        yield lambda done, total: bar.update(task, completed=min(done, total), total=total)


def _whole(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None


def _natural(text: str) -> int:
    value = _whole(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"{value} is below 0")
    return value


def _positive(text: str) -> int:
    value = _whole(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{value} is not 1 or more")
    return value


def _channel(text: str) -> int:
    value = _whole(text)
    if not 1 <= value <= 16:
        raise argparse.ArgumentTypeError(f"{value} is not a MIDI channel, 1 to 16")
    return value - 1


def _within(text: str, lo: float, hi: float, unit: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not lo <= value <= hi:  # also refuses NaN
        raise argparse.ArgumentTypeError(f"{text} is not within {lo:g} to {hi:g} {unit}")
    return value


def _seconds(text: str) -> float:
    return _within(text, 0.0, 600.0, "s")


def _decibels(text: str) -> float:
    return _within(text, -60.0, 24.0, "dB")
