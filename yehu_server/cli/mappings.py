"""List and show mappings; check or convert files of your own.

  yehu-server mappings list
  yehu-server mappings show wind
  yehu-server mappings show --live
  yehu-server mappings check my-pedals.toml
  yehu-server mappings convert wind -o my-wind.toml

What can be moved is listed in docs/parameters.md.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import (
    add_action,
    add_actions,
    add_command,
    add_options,
    add_server,
    server_of,
)
from yehu_server.cli.converters import target
from yehu_server.cli.terminal import check_files, print_json, print_result
from yehu_server.errors import MappingError, ParameterError
from yehu_server.util.files import write_bytes

if TYPE_CHECKING:
    from yehu_server.live.osc.command_client import OscClient
    from yehu_server.playing.bind import Bind
    from yehu_server.playing.mapping import Mapping


REFRESHES_PER_SECOND = 5
# The values of a /binding message; `place` is negative where the source was never moved.
BINDING = ("source", "target", "from", "to", "curve", "terms", "place", "value")


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "mappings", __doc__)
    actions = add_actions(parser)
    add_action(actions, "list", _list, "list the shipped mappings and your own")
    show = add_action(actions, "show", _show, "show the binds of a mapping")
    add_options(
        show,
        """
        mapping NAME: a mapping's name, or a file (default: keyboard)
        --live: what moves what in a running server, with positions and values; Ctrl-C ends
        """,
        mapping={"nargs": "?"},
    )
    add_server(show)
    check = add_action(actions, "check", _check, "check files and report all errors")
    check.add_argument("files", nargs="+", type=Path, metavar="FILE", help="mappings of yours")
    convert = add_action(
        actions, "convert", _convert, "write a mapping as a file in today's format"
    )
    add_options(
        convert,
        """
        mapping FILE: the name of a mapping, a file, or a file with what show --json printed
        -o --output OUT: the file to write (default: print it)
        --overwrite: replace OUT if it exists, even if it is FILE
        """,
        output=target,
    )
    for action in (actions.choices["list"], show):
        add_options(action, "--json: print one JSON object")


def _list(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.mapping import shipped_mappings, user_mappings

    own = user_mappings()
    abouts = {name: _about(name) for name in shipped_mappings() if name not in own}
    abouts |= {name: f"yours: {_about(name)}" for name in own}
    if arguments.json:
        print_json(abouts)
    else:
        width = max(map(len, abouts))
        print_result("\n".join(f"{name:{width}}  {about}" for name, about in abouts.items()))
    return 0


def _about(name: str) -> str:
    from yehu_server.playing.mapping import load

    try:
        return load(name, user_first=True).about
    except MappingError as error:  # list the others all the same
        return str(error)


def _show(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.mapping import DEFAULT, load

    if arguments.live:
        return _show_live(arguments)
    mapping = load(arguments.mapping or DEFAULT, user_first=True)
    if arguments.json:
        print_json(_fields(mapping))
    else:
        from yehu_server.cli.report import mapping_report

        mapping_report(mapping)
    return 0


def _show_live(arguments: argparse.Namespace) -> int:
    """Show the binds of a running server: once, or on a terminal as they move."""
    from rich.console import Console
    from rich.live import Live

    from yehu_server.cli.report import bindings_table
    from yehu_server.live.osc.command_client import OscClient

    if arguments.mapping is not None:
        raise ParameterError("--live shows the mapping of the server; name none")
    with OscClient(server_of(arguments)) as client:
        rows = _bindings(client)
        if arguments.json:
            print_json([dict(zip(BINDING, row, strict=True)) for row in rows])
            return 0
        console = Console(markup=False, emoji=False, highlight=False)
        if not sys.stdout.isatty():
            console.print(bindings_table(rows))
            return 0
        with Live(bindings_table(rows), console=console, auto_refresh=False) as live:
            while True:
                time.sleep(1.0 / REFRESHES_PER_SECOND)
                live.update(bindings_table(_bindings(client)), refresh=True)


def _bindings(client: OscClient) -> list[list[Any]]:
    client.send("/bindings")
    rows: list[list[Any]] = []
    for message in client.answers():
        if message.address == "/binding":
            rows.append(list(message.arguments))
        elif message.address == "/bindings":
            return rows
    client.answer("/bindings")  # raises: there was no answer
    return rows


def _check(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.mapping import load

    def read(file: Path) -> tuple[str, tuple[str, ...]]:
        # Always a path: without an ending, `load` would take it as the name of a mapping.
        mapping = load(str(file if file.suffix else Path() / file.absolute()))
        return f"{len(mapping.binds)} binds", ()

    return check_files(arguments.files, read)


def _convert(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.mapping import find_file, with_bases
    from yehu_server.playing.mapping_file import mapping_file_of_json, read_mapping_file, text_of
    from yehu_server.playing.mapping_writer import as_toml, canonical

    path = find_file(arguments.mapping, user_first=True)
    text = text_of(path)
    is_json = text.lstrip().startswith("{")  # no TOML does
    contents = (mapping_file_of_json if is_json else read_mapping_file)(path, text)
    with_bases(path, contents)  # raises where a base is wrong
    if arguments.output is not None and contents.name == path.stem:
        contents = replace(contents, name=arguments.output.stem)
    converted = as_toml(contents) if is_json else canonical(contents, text)
    if arguments.output is None and sys.stdout.isatty():
        print_result(converted.rstrip("\n"))
    elif arguments.output is None:
        print(converted, end="")
    else:
        write_bytes(arguments.output, converted.encode(), overwrite=arguments.overwrite)
    return 0


def _fields(mapping: Mapping) -> dict[str, Any]:
    return {
        "name": mapping.name,
        "about": mapping.about,
        "mpe": mapping.mpe,
        **({} if mapping.key_switches is None else {"key_switches": mapping.key_switches}),
        "start": dict(mapping.start),
        "bind": [_bind_fields(bind) for bind in mapping.binds],
    }


def _bind_fields(bind: Bind) -> dict[str, Any]:
    from yehu_server.playing.sources import is_address

    return {
        "source": bind.source,
        "target": bind.target,
        "from": None if bind.is_by_range else bind.ends[0],
        "to": None if bind.is_by_range else bind.ends[1],
        "span": bind.span,
        "curve": bind.curve.value,
        "invert": bind.invert,
        "smoothing": bind.smoothing_ms,
        "channel": bind.channels or None,
        "part": bind.part or None,
        "soft": bind.is_soft,
        "alone": bind.is_exclusive,
        "global": bind.is_global,
        "learned": bind.is_learned,
        "input": bind.input_range if is_address(bind.source) else None,
        "replaces": [_bind_fields(each) for each in bind.replaces] or None,
    }
