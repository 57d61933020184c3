"""Write control surfaces, and a page that lists the parameters; they replace older files.

  yehu-server surfaces -o panels
  yehu-server surfaces -o panels --server 192.168.1.5:9000 --only yehu.pd
  yehu-server surfaces -o panels --part 2
  yehu-server surfaces -o mappings --check

docs/surfaces.md says how to open each.
"""

import argparse
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import add_command, add_folder, add_options
from yehu_server.cli.terminal import print_result
from yehu_server.errors import ParameterError
from yehu_server.live.network import OSC_ADDRESS, format_address, parse_address
from yehu_server.util.files import make_folder
from yehu_server.util.hints import command_name


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "surfaces", __doc__, run)
    add_folder(parser)
    add_options(
        parser,
        f"""
        --server HOST:PORT: address that Max, Pd and Open Stage Control send to (default:
            {format_address(*OSC_ADDRESS)}); in TouchOSC it is set by hand
        --part N: for player N of serve --parts: the files send to /yehu/part/N, and have -part-N in
            their names
        --only NAME ...: write only this file, such as yehu.pd; may be repeated
        --check: write nothing; exit with code 1 where a file is not up to date
        """,
        server={"default": format_address(*OSC_ADDRESS)},
        part=int,
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.core.engine.rig import MAX_PARTS
    from yehu_server.surfaces.catalogue import chosen, file_of, is_up_to_date, write
    from yehu_server.surfaces.common_layout import ALL

    folder: Path = arguments.output
    server = parse_address(arguments.server, *OSC_ADDRESS)
    # The host is not looked up here: a single word is more likely a mistake than a host name.
    if arguments.server.isidentifier() and arguments.server != "localhost":
        raise ParameterError(
            f"{arguments.server!r}: expected HOST:PORT, such as {format_address(*OSC_ADDRESS)}"
        )
    part: int = ALL if arguments.part is None else arguments.part
    if arguments.part is not None and not 1 <= part <= MAX_PARTS:
        raise ParameterError(f"--part {part}: a stage has parts 1 to {MAX_PARTS}")
    surfaces = chosen(arguments.only)
    if arguments.check:
        stale = [
            surface for surface in surfaces if not is_up_to_date(surface, folder, server, part)
        ]
        for surface in stale:
            print_result(
                f"{file_of(surface, folder, part)}: stale; "
                f"{command_name()} surfaces -o {folder} writes it"
            )
        return 1 if stale else 0
    make_folder(folder)
    for surface in surfaces:
        print_result(f"{write(surface, folder, server, part)}: for {surface.about}")
    return 0
