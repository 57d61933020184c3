"""Compile the instrument ahead of time, so that it plays without Python.

It takes a minute. For a page it needs LLVM's wasm-ld, for a library a C compiler; zig brings both
(pip install ziglang).

  yehu-server build wasm -o page
  yehu-server build library -o lib --rate 48000 96000 --level x86-64-v3
  yehu-server build plugin -o plug-ins
  yehu-server build tables --mapping wind --tuning chaozhou-seven-equal -o wind.tables

build plugin makes a plug-in for music programs (docs/plugin.md). build tables writes a mapping, a
tuning and presets for pages and C programs, as numbers; docs/ahead.md describes how they use them.
"""

import argparse
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import add_command, add_folder, add_options
from yehu_server.cli.converters import positive, target
from yehu_server.cli.playing_options import add_tables, table_options_of
from yehu_server.cli.terminal import print_result
from yehu_server.errors import ParameterError
from yehu_server.plugin.targets import ALL, NAMES, usual
from yehu_server.util.files import write_bytes


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "build", __doc__, run)
    parser.add_argument(
        "what",
        choices=("wasm", "library"),
        metavar="{wasm,library,plugin,tables}",
        help="wasm: a WebAssembly module, for pages; library: a shared library and its header; "
        "plugin: a plug-in for music programs; tables: a mapping, a tuning and presets as numbers "
        "(the last two have options of their own: build plugin --help)",
    )
    add_folder(parser)
    add_options(
        parser,
        """
        --rate HZ: sample rates that it can play at (default: 44100 48000)
        --level NAME: level of processors of a library: x86-64-v3 (with AVX2) or x86-64-v2; aarch64
            (default: the lowest of this kind of machine)
        """,
        rate={"nargs": "+", "type": positive},
        level={},
    )
    tables = parser.add_word(
        "tables",
        write_tables,
        "write a mapping, tuning and presets as numbers, for yehu_use_tables",
    )
    add_tables(tables)
    add_options(
        tables,
        """
        -o --output OUT: the file to write
        --overwrite: replace OUT if it exists
        """,
        output={"required": True, "type": target},
    )
    plugin = parser.add_word("plugin", build_plugin, "make a plug-in for music programs")
    add_folder(plugin)
    add_options(
        plugin,
        "--target: the system it is for (default: this machine's); all: a folder for each",
        target={"choices": (*NAMES, ALL)},
    )


def build_plugin(arguments: argparse.Namespace) -> int:
    """Build the plug-in; return the exit code. Raises YehuError, as where a compiler is missing."""
    from yehu_server.plugin.build import build

    for path in build(arguments.output, arguments.target or usual()):
        print_result(str(path))
    return 0


def write_tables(arguments: argparse.Namespace) -> int:
    """Write tables to a file, and the numbers of named controls; return the exit code."""
    from yehu_server.playing.tables import Controls

    playing, controls = table_options_of(arguments), Controls()
    tables = playing.tables(controls)
    overwrite = arguments.overwrite
    print_result(str(write_bytes(arguments.output, tables.tobytes(), overwrite=overwrite)))
    for address in playing.mapping.addresses:
        print_result(f"control {controls.number(address)}: {address}")
    return 0


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.ahead.build import RATES, build

    folder: Path = arguments.output
    if arguments.what == "wasm" and arguments.level:
        raise ParameterError("--level is for libraries: a page has no processor of its own")
    rates, level = arguments.rate or RATES, arguments.level
    for path in build(arguments.what, folder, rates=rates, level=level):
        print_result(str(path))
    return 0
