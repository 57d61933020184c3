"""Read options of a command from a TOML file: any option, by its name without the dashes."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import Parser
from yehu_server.errors import ParameterError, did_you_mean
from yehu_server.util.documents import Document
from yehu_server.util.values import brief, flag

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
    return command.parse_args(argv[1:], read_config(path, command))


def read_config(path: Path, command: Parser) -> argparse.Namespace:
    """Read a file's options, checked as the command's own; ParameterError names the line."""
    namespace = argparse.Namespace()
    document = Document(path, "a TOML file").read(path)
    document.toml().each(lambda name, value: _set(command, namespace, name, value))
    return namespace


def _set(command: Parser, namespace: argparse.Namespace, name: str, value: Any) -> None:
    """Set an option by the value that a file has for it."""
    option = f"--{name.replace('_', '-')}"
    if option in NOT_IN_FILES:
        raise ParameterError(f"a config file {NOT_IN_FILES[option]}")
    action = command.option(option)
    if action is None:
        known = [other.removeprefix("--") for other in command.options]
        raise ParameterError(f"unknown option{did_you_mean(name, known)}")
    if action.nargs == "?" and isinstance(value, bool):  # an option that may have a value
        if value:
            action(command, namespace, action.const, option)
        return
    if action.nargs == 0:
        _set_flag(command, namespace, action, option, value)
        return
    values = [value]
    if isinstance(value, list):
        values = value
    elif isinstance(value, dict):  # such as [set]
        values = [f"{key}={_text(entry)}" for key, entry in value.items()]
    if len(values) > MAX_VALUES:
        raise ParameterError(f"more than {MAX_VALUES} values")
    for each in values:
        action(command, namespace, _converted(action, _text(each)), option)


def _set_flag(
    command: Parser,
    namespace: argparse.Namespace,
    action: argparse.Action,
    option: str,
    value: Any,
) -> None:
    if not flag(value):  # the opposite, where there is one; else the option is not given
        opposite = isinstance(action, argparse.BooleanOptionalAction)
        others = [other for other in action.option_strings if other != option]
        option = others[0] if opposite else ""
    if option:
        action(command, namespace, [], option)


def _text(value: Any) -> str:
    """A value as the command line would have it."""
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        return str(value)
    raise ParameterError(f"expected text or a number, got {brief(value)}")


def _converted(action: argparse.Action, text: str) -> Any:
    """A value converted and checked as argparse does."""
    try:
        value = action.type(text) if callable(action.type) else text
    except (argparse.ArgumentTypeError, ValueError) as error:
        raise ParameterError(str(error)) from error
    if action.choices is not None and value not in action.choices:
        known = list(map(str, action.choices))
        hint = did_you_mean(text, known)
        raise ParameterError(f"{brief(text)} is not one of {', '.join(known)}{hint}")
    return value
