"""Options of how something sounds in a file: rate, level and room; of render, also the stage."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_options, chosen
from yehu_server.cli.converters import number_within, positive, target, whole
from yehu_server.errors import ParameterError, did_you_mean

if TYPE_CHECKING:
    from yehu_server.playing.options import PlayingOptions
    from yehu_server.playing.preset_folders import Presets
    from yehu_server.rendering.options import Options

Values = tuple[tuple[str, float], ...]  # addresses and values

PLOTTED_BLOCK = 512  # frames between two readings of the pitch that is asked for

BY_MIDI = Path()  # --ensemble without a file


def add_sound(group: Any) -> None:
    """Add the options of rate and level."""
    add_options(
        group,
        """
        --rate HZ: sample rate (default: 44100)
        --tail SECONDS: how long the sound goes on after the last note, up to 600 (default: until it
            has faded to -80 dBFS, at most 5 s)
        --gain-db DB: gain before the limiter, -60 to 24 (default: 0, or that of --preset)
        --normalize: scale the result to a true peak of -1 dBFS
        --loudness LUFS: scale the result to an integrated loudness, such as -16 or -23, or to a
            true peak of -1 dBFS if that is quieter
        """,
        rate={"type": whole, "default": 44100},
        tail={"type": number_within(0.0, 600.0, "s"), "dest": "tail_s"},
        gain_db=number_within(-60.0, 24.0, "dB"),
        loudness={"type": number_within(-60.0, 0.0, "LUFS"), "dest": "loudness_lufs"},
    )


def add_room(group: Any) -> None:
    """Add the options of the room; see `in_room`."""
    add_options(
        group,
        """
        --room NAME: the room: one of the presets of rooms, such as hall, or a file
        --dry: no room: left and right are the same (default: a chamber)
        """,
        dry={"dest": "is_dry"},
    )


def add_space(group: Any) -> None:
    """Add the options of the room and of the channels of a sound file."""
    add_room(group)
    add_options(
        group,
        "--mono: write one channel, the mean of left and right",
        mono={"dest": "is_mono"},
    )


def add_stage(parser: Any) -> None:
    """Add the options of a stage: room, channels, ensemble, stems."""
    group = parser.add_argument_group("the stage")
    add_space(group)
    add_options(
        group,
        """
        --ensemble FILE.toml: play each MIDI channel but 10, or each part of a score, on a yehu of
            its own, up to 16; FILE.toml says who plays what, and where they sit
        --by: with --ensemble: what is a part, each channel or each track (default: channel; track,
            where tracks that sound together share a channel)
        --stems FOLDER: also write a file for each part, and one for the room: 01-NAME.wav ...
            room.wav; --normalize and --loudness keep their balance
        --jobs N: number of cores to use for an ensemble or a folder (default: all); the sound is
            the same
        """,
        ensemble={"nargs": "?", "type": _ensemble_file, "const": BY_MIDI},
        by={"choices": ("channel", "track")},
        stems=target,
        jobs=positive,
    )


def _ensemble_file(text: str) -> Path:
    if not text.endswith(".toml"):
        raise argparse.ArgumentTypeError(
            f"{text} is not an ensemble file, which ends in .toml; "
            "name MIDI files before --ensemble"
        )
    return Path(text)


def check_sound(arguments: argparse.Namespace) -> None:
    """Refuse a rate that no instrument has, two levels, or as `check_room`; ParameterError."""
    from yehu_server.core.physics.grid import check_rate

    check_rate(arguments.rate)
    if arguments.normalize and arguments.loudness_lufs is not None:
        raise ParameterError("--normalize and --loudness both say how loud: leave out one")
    check_room(arguments)


def check_room(arguments: argparse.Namespace) -> None:
    """Refuse a room without a room: raises ParameterError."""
    if arguments.is_dry and arguments.room is not None:
        raise ParameterError("--dry means no room: leave out --room")


def check_stage(arguments: argparse.Namespace) -> None:
    """Refuse (ParameterError) options that exclude each other, or as `check_sound` does."""
    check_sound(arguments)
    if arguments.by == "track" and arguments.ensemble is None:
        raise ParameterError("--by track is for --ensemble")
    if arguments.by == "track" and arguments.ensemble != BY_MIDI:
        raise ParameterError("--by track: the ensemble file names channels and tracks itself")


def in_room(playing: PlayingOptions, arguments: argparse.Namespace) -> PlayingOptions:
    """How to play, in the room that is asked for; raises YehuError where there is none such."""
    if arguments.room is None:
        return playing
    room = room_of(arguments.room, playing.presets)
    return replace(playing, start=(*playing.start, *room))


def sound_options_of(arguments: argparse.Namespace, form: str) -> Options:
    """The sound that these options ask for; raises OutputError where a file cannot hold it."""
    from yehu_server.rendering.options import Options
    from yehu_server.util.sound_file import check_format

    subtype = arguments.subtype or ("float" if form == "raw" else "24")
    check_format(form, subtype)
    return replace(Options(**chosen(Options, arguments)), format_name=form, subtype=subtype)


def room_of(name: str, presets: Presets) -> Values:
    """The values of a preset of rooms; raises YehuError where it is none."""
    from yehu_server.params.preset_file import is_of_room
    from yehu_server.playing.preset_folders import MINE, is_name

    is_known = not is_name(name) or name.removeprefix(MINE) in presets.names()
    preset = presets.find(name) if is_known else None
    if preset is not None and preset.is_room:
        return tuple(preset.values.items())
    other = [each for each in preset.values if not is_of_room(each)] if preset else []
    what = f"{name}: not a room (it sets {other[0]}; " if other else f"no room {name!r} ("
    rooms = [each.name for each in presets.all()[0] if each.is_room]
    near = did_you_mean(name, rooms)
    raise ParameterError(f"{what}there are: {', '.join(rooms)}){near}")
