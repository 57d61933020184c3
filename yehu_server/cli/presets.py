"""List and show presets; check files of your own.

  yehu-server presets list
  yehu-server presets show flautando
  yehu-server presets check my-sound.toml

docs/parameters.md describes the values.
"""

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import add_action, add_actions, add_command, add_options
from yehu_server.cli.playing_options import add_presets_folder
from yehu_server.cli.terminal import check_files, print_json, print_result, warn
from yehu_server.params.table import find


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "presets", __doc__)
    actions = add_actions(parser)
    listed = add_action(actions, "list", _list, "list the presets")
    show = add_action(actions, "show", _show, "show the values of a preset")
    add_options(show, "preset NAME: the name of a preset, or a file")
    for action in (listed, show):
        add_presets_folder(action)
        add_options(action, "--json: print one JSON object")
    check = add_action(actions, "check", _check, "check files and report all errors")
    check.add_argument("files", nargs="+", type=Path, metavar="FILE", help="presets of yours")


def _list(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.preset_folders import Presets

    presets = Presets(arguments.presets)
    found, errors = presets.all()
    if arguments.json:
        rows = {
            preset.name: {
                "program": preset.program,
                "about": preset.about,
                "own": presets.is_own(preset.name),
            }
            for preset in found
        }
        print_json(rows)
    else:
        width = max((len(preset.name) for preset in found), default=0)
        for title, is_room in (("sounds", False), ("rooms", True)):
            print_result(f"{title}, with their MIDI programs:")
            for each in (one for one in found if one.is_room is is_room):
                about = f"{'your own: ' * presets.is_own(each.name)}{each.about}"
                print_result(f"  {each.name:{width}}  {each.program or '-':>3}  {about}")
    for error in errors:
        warn(str(error))
    return 0


def _show(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.preset_folders import Presets

    preset = Presets(arguments.presets).find(arguments.preset)
    if arguments.json:
        fields = {"name": preset.name, "about": preset.about, "program": preset.program}
        print_json(fields | {"values": preset.values, "unknown": preset.unknown})
        return 0
    print_result(f"{preset.name}: {preset.about}" if preset.about else preset.name)
    if preset.program is not None:
        print_result(f"MIDI program {preset.program}")
    width = max(map(len, preset.values), default=0)
    for address, value in preset.values.items():
        unit = find(address).unit
        print_result(f"{address:{width}}  {value:g}" + ("" if unit == "1" else f" {unit}"))
    for remark in preset.remarks():
        warn(remark)
    return 0


def _check(arguments: argparse.Namespace) -> int:
    from yehu_server.playing.preset_folders import read_preset

    def read(file: Path) -> tuple[str, Iterable[str]]:
        preset = read_preset(file)
        return f"{len(preset.values)} values", preset.remarks()

    return check_files(arguments.files, read)
