"""Options of render about the stage: the room, one channel or two, an ensemble and its stems."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_options
from yehu_server.cli.converters import positive, target
from yehu_server.errors import ParameterError

if TYPE_CHECKING:
    from yehu_server.playing.preset_folders import Presets

Values = tuple[tuple[str, float], ...]  # addresses and values

BY_MIDI = Path()  # --ensemble without a file


def add_stage(parser: Any) -> None:
    """Add the options of a stage: room, channels, ensemble, stems."""
    group = parser.add_argument_group("the stage")
    add_room(group)
    add_options(
        group,
        """
        --ensemble FILE.toml: each MIDI channel but 10 a yehu of its own, up to 16; a file tells who
            plays what and sits where
        --by: with --ensemble: whether each channel or each track is a part (default: channel)
        --stems FOLDER: also write what each part, and the room, gives to the mix: 01-NAME.wav ...
            room.wav
        --jobs N: number of cores for an ensemble or a folder (default: all); the sound is the same
        """,
        ensemble={"nargs": "?", "type": _ensemble_file, "const": BY_MIDI},
        by={"choices": ("channel", "track"), "default": "channel"},
        stems=target,
        jobs=positive,
    )


def add_room(group: Any) -> None:
    """Add the options of the room and the channels of the sound."""
    add_options(
        group,
        """
        --dry: no room, and a body that sounds alike to both sides (default: a small, quiet room)
        --mono: write one channel, the mean of both
        --room NAME: the room: a preset of rooms, such as hall, or a file
        """,
    )


def _ensemble_file(text: str) -> Path:
    if not text.endswith(".toml"):
        raise argparse.ArgumentTypeError(
            f"{text} is no ensemble file, which ends in .toml; name MIDI files before --ensemble"
        )
    return Path(text)


def check_stage(arguments: argparse.Namespace) -> None:
    """Refuse options that exclude each other.

    Raises
    ------
    ParameterError
        Where there are some.
    """
    if arguments.dry and arguments.room is not None:
        raise ParameterError("--dry has no room: leave out --room")
    if arguments.by == "track" and arguments.ensemble is None:
        raise ParameterError("--by track is for --ensemble")
    if arguments.by == "track" and arguments.ensemble != BY_MIDI:
        raise ParameterError("--by track: the ensemble file names channels and tracks itself")


def room_of(name: str, presets: Presets) -> Values:
    """The values of a preset of rooms.

    Raises
    ------
    YehuError
        Where there is no such preset, or it is none of a room alone.
    """
    preset = presets.find(name)
    other = [each for each in preset.values if not is_of_room(each)]
    if other or not preset.values:
        what = f"it sets {other[0]}" if other else "it sets nothing"
        raise ParameterError(f"{name}: not a room: {what}")
    return tuple(preset.values.items())


def is_of_room(address: str) -> bool:
    """Whether a parameter is one of the room, or how the body sounds in it."""
    return address.startswith("/room/") or address == "/body/width"
