"""What commands share: reading arguments, telling of progress."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from rich_argparse import RawDescriptionRichHelpFormatter

from yehu_server.cli.terminal import warn
from yehu_server.control.addresses import OSC_ADDRESS, parse_address, shown
from yehu_server.errors import ParameterError
from yehu_server.files import shipped_folder
from yehu_server.lines import one_line

if TYPE_CHECKING:
    from yehu_server.playing.mapping import Mapping
    from yehu_server.playing.style import Style


class Parser(argparse.ArgumentParser):
    """One clear line for a wrong call, without the usage around it."""

    _source = ""  # where the words come from, if not from the command line

    @classmethod
    @contextlib.contextmanager
    def reading(cls, source: Path) -> Iterator[None]:
        """Name a file in errors."""
        Parser._source = f"{source}: "
        try:
            yield
        finally:
            Parser._source = ""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong and leave with code 2."""
        line = one_line(f"{Parser._source}{message}")
        self.exit(2, f"{self.prog}: {line} (see {self.prog} --help)\n")


def add_command(
    commands: Any,
    name: str,
    run: Callable[[argparse.Namespace], int] | None = None,
    **words: str,
) -> Any:
    """Add a command, or an action of one, with the words that argparse takes; return its parser.

    A page that the epilog names, such as docs/osc.md, is shown with where it is.
    """
    if "epilog" in words:
        words["epilog"] = words["epilog"].replace("docs/", f"{shipped_folder('docs')}/")
    parser = commands.add_parser(
        name, formatter_class=RawDescriptionRichHelpFormatter, allow_abbrev=False, **words
    )
    if run is not None:
        parser.set_defaults(run=run)
    return parser


def add_action(actions: Any, name: str, run: Callable[[argparse.Namespace], int], text: str) -> Any:
    """Add an action that tells something; return its parser."""
    return add_command(actions, name, run, help=text, description=f"Tell {text}.")


def add_reporting(parser: argparse.ArgumentParser) -> None:
    """Add --json and --quiet."""
    parser.add_argument("--json", action="store_true", help="print one JSON object when done")
    parser.add_argument("--quiet", action="store_true", help="no progress bar, no summary")


def add_output(parser: argparse.ArgumentParser) -> None:
    """Add the sound file to write."""
    parser.add_argument(
        "-o", "--output", required=True, type=target, metavar="OUT", help="the sound file to write"
    )
    parser.add_argument(
        "--overwrite",
        action="store_true",
        help="replace OUT whatever it is; else only what render and replay made",
    )


def check_output(arguments: argparse.Namespace) -> Callable[[Path], bool]:
    """Refuse what `add_output` was told where that may not be written; return what may go.

    Errors: OutputError.
    """
    from yehu_server.audio.file import is_rendered
    from yehu_server.files import anything, check_free, check_target

    may_replace = anything if arguments.overwrite else is_rendered
    check_target(arguments.output)
    check_free(arguments.output, may_replace)
    return may_replace


def add_gesture(parser: Any) -> None:
    """Add a gesture file, and what is kept of its run."""
    parser.add_argument("gesture", type=Path, metavar="GESTURE.json", help="what bow and finger do")
    parser.add_argument("--energy", action="store_true", help="keep the energy ledger too")
    parser.add_argument(
        "--strings",
        type=positive,
        default=0,
        metavar="EVERY",
        help="keep the strings' shapes every so many samples",
    )


def add_server(parser: Any) -> None:
    """Add which running server is meant."""
    parser.add_argument(
        "--server",
        default=shown(*OSC_ADDRESS),
        metavar="HOST:PORT",
        help=f"the OSC address of the server (default: {shown(*OSC_ADDRESS)})",
    )


def server_of(arguments: argparse.Namespace) -> tuple[str, int]:
    """What `add_server` was told. Errors: ParameterError."""
    return parse_address(arguments.server, *OSC_ADDRESS)


def add_playing(group: Any) -> None:
    """Add what tells how the instrument is played, live and from files alike."""
    group.add_argument(
        "--mapping",
        metavar="FILE",
        help="what controllers do: the name of a mapping, mine/NAME for one of yours, or a file "
        "(default: keyboard)",
    )
    group.add_argument(
        "--mpe",
        action="store_true",
        help="begin with one MPE zone of 15 member channels; with no --mapping, take mpe",
    )
    group.add_argument(
        "--preset",
        metavar="NAME",
        help="the sound to begin with: a preset's name or a file (see yehu-server presets)",
    )
    group.add_argument(
        "--programs",
        action="store_true",
        help="let MIDI program changes select presets (default: they are ignored)",
    )
    add_presets_folder(group)
    group.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="ADDRESS=VALUE",
        help="hold a parameter at a value, such as /playing/bow_position=0.1; may be repeated",
    )
    group.add_argument(
        "--a4",
        type=a4,
        default=440.0,
        metavar="HZ",
        help="reference pitch, 390 to 480 (default: 440)",
    )
    group.add_argument(
        "--tuning",
        type=Path,
        metavar="FILE.scl",
        help="a Scala scale, or a shipped one's name, from C up (default: equal temperament)",
    )
    group.add_argument(
        "--keyboard-map",
        type=Path,
        metavar="FILE.kbm",
        help="a Scala keyboard map for it, or a shipped one's name; it fixes the pitch in Hz",
    )
    group.add_argument(
        "--range",
        choices=("transpose", "clamp", "skip"),
        default="transpose",
        help="what becomes of notes outside F4 to F6 (default: transpose, by octaves)",
    )
    group.add_argument(
        "--open-strings",
        choices=("always", "on-pitch", "never"),
        default="always",
        help="when C5 is played on the open string; else on the inner one (default: always)",
    )
    group.add_argument(
        "--seed",
        type=seed,
        default=0,
        metavar="N",
        help="of the chance in /playing/variation, to 65535 (default: 0)",
    )


def mapping_of(arguments: argparse.Namespace, *, is_live: bool = False) -> Mapping:
    """The mapping that `add_playing` was told. Errors: MappingError."""
    from yehu_server.playing.mapping import DEFAULT, MPE, load

    name = arguments.mapping or (MPE if arguments.mpe else DEFAULT)
    mapping = load(name, own_first=is_live)
    return replace(mapping, mpe=mapping.mpe or arguments.mpe)


def add_presets_folder(group: Any) -> None:
    """Add where presets are."""
    group.add_argument(
        "--presets",
        type=Path,
        metavar="FOLDER",
        help="where your own presets are (default: among your settings)",
    )


def style_of(arguments: argparse.Namespace, *, is_live: bool = False) -> Style:
    """What `add_playing` was told.

    Live, mappings and presets of the user's own count before shipped ones of the same name.
    Else what their folders hold counts only where it is named: what is rendered hangs on the
    words of the command alone.
    Errors: YehuError for files and values that are wrong.
    """
    from yehu_server.params.table import assignment
    from yehu_server.playing.fingering import OpenStrings, RangePolicy
    from yehu_server.playing.presets import Presets
    from yehu_server.playing.style import Style
    from yehu_server.playing.tuning import EQUAL, read_tuning

    if arguments.keyboard_map is not None and arguments.tuning is None:
        raise ParameterError("--keyboard-map needs a scale: --tuning FILE.scl")
    own_first = is_live or arguments.presets is not None
    presets = Presets(arguments.presets, own_first=own_first)
    start: tuple[tuple[str, float], ...] = ()
    file = None
    if arguments.preset is not None:
        file = presets.find_file(arguments.preset)
        preset = presets.find(arguments.preset)
        start = tuple(preset.values.items())
        for remark in preset.remarks():
            warn(remark)
    return Style(
        mapping=mapping_of(arguments, is_live=is_live),
        presets=presets,
        preset=file,
        start=start,
        programs=arguments.programs,
        settings=tuple(assignment(text) for text in arguments.set),
        a4=arguments.a4,
        tuning=read_tuning(arguments.tuning, arguments.keyboard_map) if arguments.tuning else EQUAL,
        policy=RangePolicy(arguments.range),
        open_strings=OpenStrings(arguments.open_strings),
        seed=arguments.seed,
    )


@contextlib.contextmanager
def compiling(arguments: argparse.Namespace) -> Iterator[None]:
    """Say why the first use takes a while."""
    from yehu_server.jit import WHY_NOT_CACHED, cache_folder

    if arguments.quiet:
        pass
    elif WHY_NOT_CACHED:
        warn(f"compiling; {cache_folder()}: {WHY_NOT_CACHED}")
    elif not any(cache_folder().glob("*.code")):
        warn("compiling for this machine, once ...")
    yield


@contextlib.contextmanager
def progress_bar(arguments: argparse.Namespace, what: str, unit: str = "s") -> Iterator[Any]:
    """A progress bar on a terminal; silence elsewhere."""
    if arguments.quiet or not sys.stderr.isatty():
        yield lambda _done, _total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn(what),
        BarColumn(),
        TextColumn(f"{{task.completed:.1f}} of {{task.total:.1f}} {unit}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=0.0)
        yield lambda done, total: bar.update(task, completed=min(done, total), total=total)


def target(text: str) -> Path:
    """A file or folder to write."""
    if text == "-":
        raise argparse.ArgumentTypeError(
            "nothing is written to standard output; name a file (./- is one of that name)"
        )
    return Path(text)


def a4(text: str) -> float:
    """The frequency of A4 in Hz."""
    return within(text, 390.0, 480.0, "Hz")


def whole(text: str) -> int:
    """A whole number."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None


def seed(text: str) -> int:
    """A whole number, 0 to 65535."""
    value = whole(text)
    if not 0 <= value <= 65535:
        raise argparse.ArgumentTypeError(f"{value} is not a seed, 0 to 65535")
    return value


def positive(text: str) -> int:
    """A whole number from 1."""
    value = whole(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{value} is not 1 or more")
    return value


def channel(text: str) -> int:
    """A MIDI channel as people count, to 0-15."""
    value = whole(text)
    if not 1 <= value <= 16:
        raise argparse.ArgumentTypeError(f"{value} is not a MIDI channel, 1 to 16")
    return value - 1


def within(text: str, lo: float, hi: float, unit: str) -> float:
    """A number between bounds."""
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
    if not lo <= value <= hi:  # also refuses NaN
        raise argparse.ArgumentTypeError(f"{text} is not within {lo:g} to {hi:g} {unit}")
    return value


def seconds(text: str) -> float:
    """Seconds, 0 to 600."""
    return within(text, 0.0, 600.0, "s")


def hours(text: str) -> float:
    """Hours, up to 1000."""
    return within(text, 0.0, 1000.0, "hours")


def decibels(text: str) -> float:
    """Decibels, -60 to 24."""
    return within(text, -60.0, 24.0, "dB")
