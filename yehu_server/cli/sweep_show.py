"""``yehu-server sweep show``: draw the result of a sweep."""

from __future__ import annotations

import argparse
from pathlib import Path

from yehu_server.cli.arguments import Parser, add_options, add_reporting
from yehu_server.cli.converters import target
from yehu_server.cli.terminal import print_report

DEFAULT = "regime"


def add_show(command: Parser) -> None:
    """Add `sweep show` to the parser of `sweep`."""
    parser = command.add_word("show", show, "draw the result of a sweep")
    add_options(
        parser,
        """
        result FILE: the result of a sweep
        -o --output OUT: a picture, .png, or a page to browse, .html (default: FILE with .png)
        --column NAME: what a picture shows, such as helmholtz_s or pitch_hz (default: regime)
        --overwrite: replace OUT, whatever it is; pictures are replaced anyway
        """,
        result=Path,
        output=target,
        column={"default": DEFAULT},
    )
    add_reporting(parser)


def show(arguments: argparse.Namespace) -> int:
    """Draw a result; return the exit code.

    Raises ParameterError where the call is wrong.
    """
    from yehu_server.errors import ParameterError
    from yehu_server.lab.plot.png import check_picture
    from yehu_server.lab.plot.study import write_picture
    from yehu_server.lab.plot.study_page import write_page
    from yehu_server.lab.sweeps.result import Result
    from yehu_server.util.files import anything, check_free, check_target, nothing

    output = arguments.output or arguments.result.with_suffix(".png")
    if output.suffix not in {".png", ".html"}:
        raise ParameterError(f"{output}: name a picture .png, or a page .html")
    if output.suffix == ".png":
        check_picture(output, "a picture", overwrite=arguments.overwrite)
    else:
        check_target(output)
        check_free(output, anything if arguments.overwrite else nothing)
    result = Result.load(arguments.result)
    if output.suffix == ".png":
        write_picture(result, output, arguments.column, overwrite=arguments.overwrite)
    else:
        write_page(result, output)
    fields = {"strokes": len(result), "shape": result.shape, "output": str(output)}
    print_report(arguments, fields, f"{output}: {len(result)} strokes")
    return 0
