"""Compile the instrument ahead of time, so that it plays without Python.

It takes a minute. For a page it needs LLVM's wasm-ld, for a library a C compiler; zig brings both
(pip install ziglang).

  yehu-server build wasm -o page
  yehu-server build library -o lib --rate 48000 96000 --level x86-64-v3
  yehu-server build plugin -o plug-ins
  yehu-server build tables --mapping wind --preset flautando -o wind.tables

docs/plugin.md is about plug-ins, docs/ahead.md about modules, libraries and tables.
"""

import argparse
from typing import Any

from yehu_server.cli.arguments import (
    add_action,
    add_actions,
    add_command,
    add_folder,
    add_options,
)
from yehu_server.cli.converters import positive, target
from yehu_server.cli.playing_options import add_controllers, add_tables, table_options_of
from yehu_server.cli.terminal import print_result
from yehu_server.plugin.targets import ALL, NAMES, usual
from yehu_server.util.files import write_bytes


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    actions = add_actions(add_command(commands, "build", __doc__))
    wasm = add_action(actions, "wasm", _ahead, "make a WebAssembly module, for pages")
    library = add_action(actions, "library", _ahead, "make a shared library and its header")
    for what in (wasm, library):
        add_folder(what)
        rates = "--rate HZ: sample rates that it can play at (default: 44100 48000)"
        add_options(what, rates, rate={"nargs": "+", "type": positive})
    add_options(
        library,
        """
        --level NAME: processors that it runs on: x86-64-v3 (with AVX2) or x86-64-v2; aarch64
            (default: x86-64-v2 or aarch64, as this machine)
        """,
        level={},
    )
    wasm.set_defaults(what="wasm", level=None)
    library.set_defaults(what="library")
    plugin = add_action(actions, "plugin", _plugin, "make a plug-in for DAWs")
    add_folder(plugin)
    add_options(
        plugin,
        "--target: the system it is for (default: this machine's); all: a folder for each",
        target={"choices": (*NAMES, ALL)},
    )
    text = "write mapping, tuning and presets to a binary file, for the C function yehu_use_tables"
    tables = add_action(actions, "tables", _tables, text)
    add_controllers(tables)
    add_tables(tables)
    add_options(
        tables,
        """
        -o --output OUT: the file to write
        --overwrite: replace OUT if it exists
        """,
        output={"required": True, "type": target},
    )


def _plugin(arguments: argparse.Namespace) -> int:
    from yehu_server.plugin.build import build

    for path in build(arguments.output, arguments.target or usual()):
        print_result(str(path))
    return 0


def _tables(arguments: argparse.Namespace) -> int:
    """Write tables to a file, and the numbers of named controls; return the exit code."""
    from yehu_server.playing.tables import Controls

    playing, controls = table_options_of(arguments), Controls()
    tables = playing.tables(controls)
    overwrite = arguments.overwrite
    print_result(str(write_bytes(arguments.output, tables.tobytes(), overwrite=overwrite)))
    for address in playing.mapping.addresses:
        print_result(f"control {controls.number(address)}: {address}")
    return 0


def _ahead(arguments: argparse.Namespace) -> int:
    from yehu_server.ahead.build import RATES, build

    rates, level = arguments.rate or RATES, arguments.level
    for path in build(arguments.what, arguments.output, rates=rates, level=level):
        print_result(str(path))
    return 0
