"""``yehu-server build``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import add_command, add_folder
from yehu_server.cli.converters import positive
from yehu_server.cli.terminal import tell

EXAMPLES = """\
examples:
  yehu-server build wasm -o page
  yehu-server build library -o lib --rate 48000 96000 --cpu native

docs/ahead.md tells how pages and C programs use them.
"""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "build",
        run=run,
        help="compile the instrument for web pages, or as a library for C programs",
        description="Compile the instrument ahead of time, so that it plays without Python. "
        "It takes a minute. For a page it needs LLVM's wasm-ld, for a library a C compiler.",
        epilog=EXAMPLES,
    )
    parser.add_argument(
        "what",
        choices=("wasm", "library"),
        help="wasm: a WebAssembly module, for pages; library: a shared library and its header",
    )
    add_folder(parser)
    parser.add_argument(
        "--rate",
        nargs="+",
        type=positive,
        metavar="HZ",
        help="sample rates that it can play at (default: 44100 48000)",
    )
    parser.add_argument(
        "--cpu",
        default="generic",
        metavar="NAME",
        help="processor of a library, by LLVM's name, such as x86-64-v3; "
        "native: this one (default: any of its kind)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from llvmlite import binding

    from yehu_server.ahead.build import RATES, build
    from yehu_server.errors import ParameterError

    folder: Path = arguments.output
    cpu = binding.get_host_cpu_name() if arguments.cpu == "native" else arguments.cpu
    if arguments.what == "wasm" and cpu != "generic":
        raise ParameterError("--cpu is for libraries: a page has no processor of its own")
    for path in build(arguments.what, folder, rates=arguments.rate or RATES, cpu=cpu):
        tell(str(path))
    return 0
