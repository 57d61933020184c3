"""Options from a TOML file: any option of a command, by its name without the dashes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import Parser
from yehu_server.documents import parse_toml
from yehu_server.errors import ParameterError
from yehu_server.files import MAX_SETTINGS_BYTES, read_text

OPTION, HELP = "--config", "--help"
MOST_WORDS = 1000  # argparse takes time by the square of their number


def as_words(path: Path) -> list[str]:
    """The file's options as they would be on the command line. Errors: ParameterError."""
    try:
        data = parse_toml(read_text(path, MAX_SETTINGS_BYTES))
    except OSError as error:
        raise ParameterError(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise ParameterError(f"{path}: not a TOML file ({error})") from error
    words: list[str] = []
    for name, value in data.items():
        option = f"--{name.replace('_', '-')}"
        if option == OPTION:
            raise ParameterError(f"{path}: a config file cannot name another")
        if option == HELP:
            raise ParameterError(f"{path}: a config file cannot ask for help")
        if value is True:
            words.append(option)
        elif isinstance(value, dict):  # such as [set]
            words += [f"{option}={key}={_text(path, name, entry)}" for key, entry in value.items()]
        elif value is not False:
            values = value if isinstance(value, list) else [value]
            words += [f"{option}={_text(path, name, entry)}" for entry in values]
    if len(words) > MOST_WORDS:
        raise ParameterError(f"{path}: more than {MOST_WORDS} options")
    return words


def _text(path: Path, name: str, value: Any) -> str:
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        try:
            return str(value)
        except ValueError as error:  # an int of thousands of digits
            raise ParameterError(f"{path}: {name}: {error}") from error
    raise ParameterError(f"{path}: {name}: expected a word or a number, got {value!r}")


def expand(argv: Sequence[str], parser: Parser) -> list[str]:
    """Put the options of a ``--config`` file before the command line's own, which so win.

    Errors: as of the parser, naming the file.
    """
    words = list(argv)
    for place, word in enumerate(words):
        if word == OPTION and place + 1 < len(words):
            path = Path(words[place + 1])
        elif word.startswith(f"{OPTION}="):
            path = Path(word.removeprefix(f"{OPTION}="))
        else:
            continue
        from_file = [words[0], *as_words(path)]
        with Parser.reading(path):
            parser.parse_args(from_file)
        return [*from_file, *words[1:]]
    return words
