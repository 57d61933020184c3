"""``yehu-server mappings``."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich_argparse import RawDescriptionRichHelpFormatter

if TYPE_CHECKING:
    from yehu_server.playing.mapping import Mapping

EXAMPLES = """\
examples:
  yehu-server mappings list
  yehu-server mappings show wind
  yehu-server mappings check my-pedals.toml
"""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "mappings",
        help="what controllers move: mappings that come along, and files of your own",
        description="List the mappings, show what one moves, or check files of your own.",
        epilog=EXAMPLES,
        formatter_class=RawDescriptionRichHelpFormatter,
        allow_abbrev=False,
    )
    actions = parser.add_subparsers(title="actions", metavar="ACTION", required=True)
    for name, run, text in (
        ("list", _list, "the mappings that come along"),
        ("show", _show, "what controllers move in one"),
        ("check", _check, "whether files are right"),
    ):
        action = actions.add_parser(
            name,
            help=text,
            description=f"Tell {text}.",
            formatter_class=RawDescriptionRichHelpFormatter,
            allow_abbrev=False,
        )
        action.set_defaults(run=run)
        if name == "show":
            action.add_argument("mapping", metavar="NAME", help="a mapping's name, or a file")
        if name == "check":
            action.add_argument("files", nargs="+", type=Path, metavar="FILE")
        else:
            action.add_argument("--json", action="store_true", help="print one JSON object")


def _list(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.mapping import load, shipped_mappings

    mappings = {name: load(name).about for name in shipped_mappings()}
    if arguments.json:
        print(json.dumps(mappings))
    else:
        width = max(map(len, mappings))
        print("\n".join(f"{name:{width}}  {about}" for name, about in mappings.items()))
    return 0


def _show(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.mapping import load

    mapping = load(arguments.mapping)
    if arguments.json:
        print(json.dumps(_fields(mapping)))
    else:
        from yehu_server.report import mapping_report

        mapping_report(mapping)
    return 0


def _check(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.mapping import load

    for file in arguments.files:
        # A path, also where it has no ending: a mapping's name would be no file.
        mapping = load(str(file if file.suffix else Path() / file.absolute()))
        print(f"{file}: right, {len(mapping.binds)} binds")
    return 0


def _fields(mapping: Mapping) -> dict[str, Any]:
    binds = [
        {
            "source": bind.source,
            "target": bind.target,
            "from": None if bind.is_by_range else bind.ends[0],
            "to": None if bind.is_by_range else bind.ends[1],
            "curve": bind.curve.value,
        }
        for bind in mapping.binds
    ]
    start = dict(mapping.start)
    return {"name": mapping.name, "about": mapping.about, "mpe": mapping.mpe, "start": start} | {
        "bind": binds
    }
