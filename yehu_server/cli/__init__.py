"""The command line: a module for each command."""

import contextlib
import errno
import importlib
import logging
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from yehu_server.cli.arguments import HelpFormatter, Parser
from yehu_server.cli.commands import all_commands, module_of
from yehu_server.cli.config import parse
from yehu_server.cli.render_pipe import BROKEN_PIPE
from yehu_server.cli.terminal import INTERRUPTED, interrupt, warn, warn_of
from yehu_server.cli.wrong_words import hint_at
from yehu_server.errors import YehuError
from yehu_server.system.processes import on_termination
from yehu_server.util import __version__
from yehu_server.util.files import error_reason
from yehu_server.util.hints import command_name

OF_ALL: tuple[list[str], ...] = (
    [],
    ["-h"],
    ["--help"],
    ["--version"],
)  # words for which no command is imported


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; return its exit code.

    0; 1 where something asked for failed a check; 2 for bad input; 130 when interrupted.
    """
    # No Python that is started here takes modules from the current folder, where anything may lie.
    os.environ["PYTHONSAFEPATH"] = "1"
    on_termination(interrupt)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else it is to be ignored
        signal.signal(signal.SIGINT, interrupt)
    logging.basicConfig(format="yehu-server: %(message)s", level=logging.WARNING)
    if hasattr(sys.stdout, "reconfigure"):  # a title may have letters that a terminal has not
        sys.stdout.reconfigure(errors="backslashreplace")
    words = sys.argv[1:] if argv is None else argv
    try:
        try:
            arguments = parse(words, _parser(words, whole=False))
            code: int = arguments.run(arguments)
        finally:
            with contextlib.suppress(BrokenPipeError):
                sys.stdout.flush()  # here, where we notice that it is full
    except BrokenPipeError:  # such as `| head`, which has read enough
        with Path(os.devnull).open("w") as nothing:
            os.dup2(nothing.fileno(), sys.stdout.fileno())
        return BROKEN_PIPE
    except YehuError as error:
        warn_of(error, hint_at(words, str(error)))
        return 2
    except OSError as error:
        if error.errno != errno.ENOSPC:  # of standard output: errors of files name them
            raise
        with Path(os.devnull).open("w") as nothing:  # Python would try again, and report it again
            os.dup2(nothing.fileno(), sys.stdout.fileno())
        warn(f"standard output: {error_reason(error)}")
        return 2
    except MemoryError:
        warn("not enough memory")
        return 2
    except KeyboardInterrupt as interruption:
        warn(f"interrupted, {str(interruption) or 'nothing written'}")
        return INTERRUPTED
    return code


def _parser(words: Sequence[str] = (), *, whole: bool = True) -> Parser:
    """The parser of some words.

    Of those that begin with a command it has that one alone, so that no other is imported; it has
    all of them else, and of those of OF_ALL their names, unless it is to be `whole`.
    """
    parser = Parser(
        prog=command_name(),
        description="A virtual yehu, the Chinese two-stringed fiddle: its physics, simulated.",
        formatter_class=HelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"yehu-server {__version__}")
    # With `prog`, nothing is written to standard output here, which may be full.
    commands = parser.add_subparsers(
        title="commands", metavar="COMMAND", required=True, prog=parser.prog
    )
    if list(words) in OF_ALL and not whole:
        for name, (_, text) in all_commands().items():
            commands.add_parser(name, help=text)
        return parser
    named = module_of(words[0]) if words else None
    for module in [named] if named else [module for module, _ in all_commands().values()]:
        importlib.import_module(module).add_to(commands)
    return parser
