"""Read options of a command from a TOML file: any option, by its name without the dashes."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import Parser
from yehu_server.errors import ParameterError
from yehu_server.playing.toml_lines import lines_of
from yehu_server.util.documents import parse_toml
from yehu_server.util.files import MAX_SETTINGS_BYTES, read_text

NOT_IN_FILES = {"--config": "cannot name another", "--help": "cannot ask for help"}
MOST_VALUES = 1000  # of one option
LONGEST_NAME = 100  # characters looked at for a similar one


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

    Options that may be repeated add to those of the file.

    Raises
    ------
    ParameterError
        As `read_config`.
    SystemExit
        Where the command line is wrong, as argparse does.
    """
    arguments = parser.parse_args(argv)
    path = getattr(arguments, "config", None)
    if path is None:
        return arguments
    command: Parser = arguments.command
    return command.parse_args(argv[1:], read_config(path, command))


def read_config(path: Path, command: Parser) -> argparse.Namespace:
    """Read the options of a file, converted and checked as the command's own.

    Raises
    ------
    ParameterError
        Naming file and line.
    """
    try:
        text = read_text(path, MAX_SETTINGS_BYTES)
        data = parse_toml(text)
    except OSError as error:
        raise ParameterError(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise ParameterError(f"{path}: not a TOML file ({error})") from error
    namespace = argparse.Namespace()
    for name, value in data.items():
        try:
            _set(command, namespace, name, value)
        except ParameterError as error:
            line = lines_of(text).get((name,))
            where = path if line is None else f"{path}:{line}"
            raise ParameterError(f"{where}: {error}") from error
    return namespace


def _set(command: Parser, namespace: argparse.Namespace, name: str, value: Any) -> None:
    """Set an option by the value that a file has for it."""
    option = f"--{name.replace('_', '-')}"
    if option in NOT_IN_FILES:
        raise ParameterError(f"a config file {NOT_IN_FILES[option]}")
    action = command.option(option)
    if action is None:
        near = difflib.get_close_matches(option[:LONGEST_NAME], command.options, n=1)
        hint = f"; did you mean {near[0].removeprefix('--')}?" if near else ""
        raise ParameterError(f"unknown option {name!r}{hint}")
    if action.nargs == 0:
        _set_flag(command, namespace, action, option, value)
        return
    values = [value]
    if isinstance(value, list):
        values = value
    elif isinstance(value, dict):  # such as [set]
        values = [f"{key}={_text(name, entry)}" for key, entry in value.items()]
    if len(values) > MOST_VALUES:
        raise ParameterError(f"{name}: more than {MOST_VALUES} values")
    for each in values:
        action(command, namespace, _converted(action, name, _text(name, each)), option)


def _set_flag(
    command: Parser,
    namespace: argparse.Namespace,
    action: argparse.Action,
    option: str,
    value: Any,
) -> None:
    if not isinstance(value, bool):
        raise ParameterError(f"{option[2:]}: expected true or false, got {value!r}")
    if not value:  # the opposite, where there is one; else the option is not given
        opposite = isinstance(action, argparse.BooleanOptionalAction)
        others = [other for other in action.option_strings if other != option]
        option = others[0] if opposite else ""
    if option:
        action(command, namespace, [], option)


def _text(name: str, value: Any) -> str:
    """A value as the command line would have it."""
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        return str(value)
    raise ParameterError(f"{name}: expected text or a number, got {value!r}")


def _converted(action: argparse.Action, name: str, text: str) -> Any:
    """A value converted and checked as argparse does."""
    try:
        value = action.type(text) if callable(action.type) else text
    except (argparse.ArgumentTypeError, ValueError) as error:
        raise ParameterError(f"{name}: {error}") from error
    if action.choices is not None and value not in action.choices:
        choices = ", ".join(map(str, action.choices))
        raise ParameterError(f"{name}: {text!r} is none of {choices}")
    return value
