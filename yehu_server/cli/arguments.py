"""Arguments, warnings and progress bars that several commands share."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NoReturn

from rich_argparse import RawDescriptionRichHelpFormatter

from yehu_server.cli.converters import positive, target
from yehu_server.cli.terminal import warn
from yehu_server.errors import one_line
from yehu_server.live.addresses import OSC_ADDRESS, format_address, parse_address
from yehu_server.util.files import shipped_folder


def add_cluster(group: Any) -> None:
    """Add --dask, the address of a cluster's scheduler, to a parser or a group of its options."""
    group.add_argument(
        "--dask",
        metavar="ADDRESS",
        help="do the jobs on a cluster: the address of its Dask scheduler, such as "
        "tcp://10.0.0.1:8786, or the file it wrote (needs yehu-server[cluster])",
    )


class Parser(argparse.ArgumentParser):
    """A parser that reports a wrong call in one line, without the usage."""

    def __init__(self, *args: Any, **words: Any) -> None:
        super().__init__(*args, **words)
        self._actions_by_word: dict[str, Parser] = {}

    def add_word(self, word: str, run: Callable[[argparse.Namespace], int], text: str) -> Parser:
        """Add an action beside the command's own arguments, by its first word; return its parser.

        argparse's subparsers leave no room for such arguments.
        """
        parser = Parser(
            prog=f"{self.prog} {word}",
            description=f"{text.capitalize()}.",
            formatter_class=RawDescriptionRichHelpFormatter,
            allow_abbrev=False,
        )
        parser.set_defaults(run=run)
        self._actions_by_word[word] = parser
        return parser

    def parse_known_args(  # type: ignore[override]
        self, args: Any = None, namespace: Any = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Parse as argparse does, or leave it to the parser of the first word."""
        action = self._actions_by_word.get(args[0]) if args else None
        if action is not None:
            return action.parse_known_args(args[1:], namespace)
        known: tuple[argparse.Namespace, list[str]] = super().parse_known_args(args, namespace)
        return known

    @property
    def options(self) -> list[str]:
        """All options, with their dashes."""
        return list(self._option_string_actions)

    def option(self, name: str) -> argparse.Action | None:
        """The action of an option; argparse has no public way to find it."""
        return self._option_string_actions.get(name)

    def error(self, message: str) -> NoReturn:
        """Print what is wrong and exit with code 2."""
        self.exit(2, f"{self.prog}: {one_line(message)} (see {self.prog} --help)\n")


def add_command(
    commands: Any,
    name: str,
    run: Callable[[argparse.Namespace], int] | None = None,
    **words: str,
) -> Any:
    """Add a command, or an action of one, with the texts that argparse takes; return its parser.

    Pages named in the epilog, such as docs/osc.md, are shown with their full path.
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
    """Add an action of a command, with its help as the description; return its parser."""
    return add_command(actions, name, run, help=text, description=f"{text.capitalize()}.")


def add_instrument(parser: argparse.ArgumentParser) -> None:
    """Add the option that names an instrument file."""
    parser.add_argument(
        "--instrument",
        type=Path,
        metavar="FILE",
        help="a TOML or JSON file of physical quantities to change",
    )


def add_reporting(parser: argparse.ArgumentParser) -> None:
    """Add --json and --quiet."""
    parser.add_argument("--json", action="store_true", help="print one JSON object when done")
    parser.add_argument("--quiet", action="store_true", help="no progress bar, no summary")


def add_output(
    parser: argparse.ArgumentParser, kind: Callable[[str], Path] = target, more: str = ""
) -> None:
    """Add -o and --overwrite, for the sound file to write; `kind` converts its name."""
    parser.add_argument(
        "-o",
        "--output",
        required=True,
        type=kind,
        metavar="OUT",
        help=f"the sound file to write{more}",
    )
    parser.add_argument(
        "--overwrite",
        action="store_true",
        help="replace OUT whatever it is (default: only files made by render and replay)",
    )


def add_folder(parser: argparse.ArgumentParser, *, required: bool = True, text: str = "") -> None:
    """Add -o, for a folder to write to."""
    parser.add_argument(
        "-o",
        "--output",
        required=required,
        type=target,
        metavar="FOLDER",
        help=text or "folder to write to; created if missing",
    )


def check_output(
    arguments: argparse.Namespace, output: Path | None = None
) -> Callable[[Path], bool]:
    """Check that the output of `add_output` may be written; return which files it may replace.

    Parameters
    ----------
    output : Path, optional
        Another file that is written beside it.

    Raises
    ------
    OutputError
        Where it may not be written.
    """
    from yehu_server.util.files import anything, check_free, check_target
    from yehu_server.util.sound_file import is_rendered

    may_replace = anything if arguments.overwrite else is_rendered
    check_target(output or arguments.output)
    check_free(output or arguments.output, may_replace)
    return may_replace


def add_gesture(parser: Any) -> None:
    """Add a gesture file, and options of what is kept of its run."""
    parser.add_argument(
        "gesture",
        type=Path,
        metavar="GESTURE.json",
        help="a gesture file: motion of bow and finger",
    )
    parser.add_argument("--energy", action="store_true", help="also keep the energy ledger")
    parser.add_argument(
        "--strings",
        type=positive,
        default=0,
        metavar="EVERY",
        help="keep the shapes of the strings every EVERY samples (default: never)",
    )


def add_server(parser: Any) -> None:
    """Add --server, the address of a running server."""
    parser.add_argument(
        "--server",
        default=format_address(*OSC_ADDRESS),
        metavar="HOST:PORT",
        help=f"the OSC address of the server (default: {format_address(*OSC_ADDRESS)})",
    )


def server_of(arguments: argparse.Namespace) -> tuple[str, int]:
    """The address given with --server.

    Raises
    ------
    ParameterError
        Where it is none.
    """
    return parse_address(arguments.server, *OSC_ADDRESS)


def warn_of_compiling(arguments: argparse.Namespace, *, plays: bool = True) -> None:
    """Warn where the model will be compiled: at its first use, or always if it is not cached.

    Parameters
    ----------
    plays : bool
        Whether the command plays the instrument, which is what code is made of in advance.
    """
    from yehu_server.compile.bitcode.start import why_not
    from yehu_server.compile.jit import WHY_NOT_CACHED, cache_folder, source_hash

    if arguments.quiet:
        return
    if WHY_NOT_CACHED:
        warn(f"compiling; {cache_folder()}: {WHY_NOT_CACHED}")
    elif any(cache_folder().glob("*.code")):
        return
    elif not plays:
        warn("compiling for this machine, once ...")
    elif reason := why_not(source_hash()):
        warn(f"compiling for this machine, once, for half a minute: {reason}")
    else:
        warn("preparing for this processor, once ...")


@contextlib.contextmanager
def progress_bar(arguments: argparse.Namespace, what: str, unit: str = "s") -> Iterator[Any]:
    """Show a progress bar on a terminal; yield a function that takes what is done and the total."""
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
