"""Read options of a command from a TOML file: any option, by its name without the dashes."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import Parser
from yehu_server.errors import ParameterError, did_you_mean
from yehu_server.live.network import OSC_ADDRESS, parse_address
from yehu_server.util.documents import MAX_ERRORS, Document, looks_like
from yehu_server.util.values import brief, flag

CONFIG = "a config file"
NOT_IN_FILES = {"--config": "cannot name another", "--help": "cannot ask for help"}
MAX_VALUES = 1000  # of one option


def add_config(group: Any, command: Parser) -> None:
    """Add --config to a command, whose `parse` then reads the file."""
    group.add_argument(
        "--config",
        type=Path,
        metavar="FILE",
        help="a TOML file of any of these options, such as rate = 48000; the command line wins",
    )
    command.set_defaults(command=command)


def parse(argv: Sequence[str], parser: Parser) -> argparse.Namespace:
    """Parse a command line, and the file that it names with --config, whose options it overrides.

    Options that may be repeated add to those of the file. Raises ParameterError as `read_config`;
    SystemExit where the command line is wrong, as argparse does.
    """
    arguments = parser.parse_args(argv)
    path = getattr(arguments, "config", None)
    if path is None:
        return arguments
    command: Parser = arguments.command
    return command.parse_args(argv[1:], read_config(path, command, arguments.presets))


def read_config(path: Path, command: Parser, presets: Path | None) -> argparse.Namespace:
    """Read a file's options, checked as the command's own; ParameterError names the lines.

    `presets`: the folder of presets that the command line names, if it does.
    """
    namespace = argparse.Namespace()

    def parse_entry(name: str, value: Any) -> None:
        try:
            command.parse_known_args(_words(command, name, value, table.data), namespace)
        except argparse.ArgumentError as error:
            raise ParameterError(command.worded(error.message)) from error

    def check(name: str, value: Any) -> None:
        for word in _words(command, name, value, table.data):
            _check(*word.partition("=")[::2], presets or getattr(namespace, "presets", None))

    document = Document(path, CONFIG, most_errors=MAX_ERRORS)
    table = document.read(path).toml()
    command.exit_on_error = False
    table.each(parse_entry)
    command.exit_on_error = True
    document.raise_errors()
    table.each(check)
    document.raise_errors()
    return namespace


def _check(option: str, text: str, presets: Path | None) -> None:
    """Refuse (ParameterError) here, where the line is known, what would be refused in its use."""
    from yehu_server.params.table import assignment
    from yehu_server.playing.mapping import load
    from yehu_server.playing.preset_folders import Presets

    readers: dict[str, Callable[[str], object]] = {
        "--set": assignment,
        "--mapping": partial(load, user_first=True),
        "--preset": Presets(presets).find,
        "--osc": lambda text: parse_address(text, *OSC_ADDRESS),
    }
    readers.get(option, str)(text)


def _words(command: Parser, name: str, value: Any, table: Mapping[str, Any]) -> list[str]:
    """The words of the command line that give an option the value of a file's entry."""
    option = f"--{name.replace('_', '-')}"
    if option in NOT_IN_FILES:
        raise ParameterError(f"a config file {NOT_IN_FILES[option]}")
    action = command.options.get(option)
    if action is None:
        known = [other.removeprefix("--") for other in command.options]
        raise ParameterError(
            f"unknown option{did_you_mean(name, known)}{looks_like(table, CONFIG)}"
        )
    if action.nargs == 0 or (action.nargs == "?" and isinstance(value, bool)):
        if flag(value):
            return [option]
        opposites = [other for other in action.option_strings if other != option]
        return opposites if isinstance(action, argparse.BooleanOptionalAction) else []
    values = value if isinstance(value, list) else [value]
    if isinstance(value, dict):  # such as [set]
        values = [f"{key}={_text(entry)}" for key, entry in value.items()]
    if len(values) > MAX_VALUES:
        raise ParameterError(f"more than {MAX_VALUES} values")
    return [f"{option}={_text(each)}" for each in values]


def _text(value: Any) -> str:
    """A value as the command line would have it."""
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        return str(value)
    raise ParameterError(f"expected text or a number, got {brief(value)}")
