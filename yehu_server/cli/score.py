"""``yehu-server score``."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_action, add_actions, add_command, add_options
from yehu_server.cli.converters import positive, target
from yehu_server.cli.terminal import print_result, warn

if TYPE_CHECKING:
    from yehu_server.scores.written.notated import Written

EXAMPLES = """\
examples:
  yehu-server score show tune.musicxml
  yehu-server score show tune.jianpu --json
  yehu-server score show tune.mxl --export-midi tune.mid

The marks that are understood are listed in docs/scores.md.
"""


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "score",
        help="show what is understood of a written score: MusicXML, ABC or jianpu",
        description="Show what is understood of a written score, and what will be played.",
        epilog=EXAMPLES,
    )
    actions = add_actions(parser)
    show = add_action(actions, "show", _show, "show the notes of a score, and its marks")
    add_options(
        show,
        """
        score FILE: a file of MusicXML, ABC or jianpu
        --song N: the N-th tune of a file of ABC (default: the first)
        --json: print one JSON object
        --export-midi OUT.mid: write what is played as a MIDI file, and say what that cannot hold
        --overwrite: replace OUT.mid if it exists
        """,
        score=Path,
        song=positive,
        export_midi=target,
    )


def _show(arguments: argparse.Namespace) -> int:
    from yehu_server.scores.reading import read_written
    from yehu_server.scores.written.text import fields_of, lines_of

    written = read_written(arguments.score, arguments.song)
    if arguments.export_midi is not None:
        _export(arguments, written)
    if arguments.json:
        print(json.dumps(fields_of(written)))
    else:
        for line in lines_of(written):
            print_result(line)
    return 0


def _export(arguments: argparse.Namespace, written: Written) -> None:
    from yehu_server.scores.midi_export import midi_file
    from yehu_server.scores.score import naming
    from yehu_server.scores.written.performed import performed
    from yehu_server.util.files import anything, check_distinct, nothing, replacing

    output = arguments.export_midi
    check_distinct({"--export-midi": output}, [arguments.score])
    with naming(arguments.score):
        score = performed(written)
    data, lost = midi_file(written, score)
    with replacing(output, anything if arguments.overwrite else nothing) as partial:
        partial.write_bytes(data)
    if lost:
        told = ", ".join(f"{address} ({count})" for address, count in sorted(lost.items()))
        warn(f"{output}: MIDI has no controllers for {told}")
