"""Options of serve for several parts: how many, who plays them, and how each is played."""

from __future__ import annotations

import argparse
import copy
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_instrument, add_options
from yehu_server.cli.converters import whole_within
from yehu_server.cli.playing_options import mapping_of, playing_options_of
from yehu_server.cli.sound_options import add_room, check_room, in_room
from yehu_server.cli.terminal import warn
from yehu_server.errors import ParameterError, YehuError
from yehu_server.live.part_addresses import check_own, group_of, no_part
from yehu_server.params.table import find

if TYPE_CHECKING:
    from collections.abc import Sequence

    from yehu_server.live.midi.routes import Route
    from yehu_server.live.options import PartOptions
    from yehu_server.playing.options import PlayingOptions

MAX = 16  # engine.rig.MAX_PARTS, which takes a second to import


def add_parts(group: Any) -> None:
    """Add the options to a group of a parser."""
    add_instrument(group)
    add_options(
        group,
        f"""
        --parts N: number of players on the stage, each with an instrument, 1 to {MAX} (default: 1)
        --part N=PORT[:CHANNEL] ...: which MIDI inputs play part N, by words of their name, or which
            channel of them; may be repeated (default: the first input plays part 1, the second
            part 2, ...)
        --part-mapping N=FILE ...: mapping of part N (default: that of --mapping); may be repeated
        --part-instrument N=FILE ...: instrument of part N (default: that of --instrument); may be
            repeated
        --part-preset N=NAME ...: sound that part N starts with (default: that of --preset); may be
            repeated
        --part-set N=ADDRESS=VALUE ...: hold a parameter of part N, such as 2=/room/pan=-0.5; may be
            repeated
        """,
        parts={"type": whole_within(1, MAX, f"parts: a stage has 1 to {MAX}"), "default": 1},
        part=_numbered,
        part_mapping=_numbered,
        part_instrument=_numbered,
        part_preset=_numbered,
        part_set=_numbered,
    )
    add_room(group)


def part_options(arguments: argparse.Namespace) -> list[PartOptions]:
    """The options of all parts; raises YehuError where one is wrong, or a part is not there."""
    from yehu_server.live.options import PartOptions
    from yehu_server.playing.parts import number_of_instruments

    for option in ("part_mapping", "part_instrument", "part_preset", "part_set"):
        for number, text in getattr(arguments, option):
            if not 1 <= number <= arguments.parts:
                name = f"--{option.replace('_', '-')} {number}={text}"
                raise ParameterError(f"{name}: {no_part(number, arguments.parts)}")
    check_room(arguments)
    usual = in_room(playing_options_of(arguments, is_live=True), arguments)
    options = []
    for number in range(1, arguments.parts + 1):
        own = _own(arguments, number)
        playing = usual if own is None else _options_of(own, number)
        reread = partial(mapping_of, own or arguments, is_live=True) if arguments.watch else None
        options.append(PartOptions(playing, reread))
    number_of_instruments([part.playing for part in options])
    return options


def routes_of(arguments: argparse.Namespace, parts: Sequence[PartOptions]) -> list[Route]:
    """The MIDI inputs that parts are played from, by --part; raises ParameterError."""
    from yehu_server.live.midi.routes import check_routes, route_of

    routes = []
    for number, text in arguments.part:
        try:
            routes.append(route_of(number - 1, text))
            check_routes(routes, len(parts))
        except ParameterError as error:
            raise ParameterError(f"--part {number}={text}: {error}") from error
        if routes[-1].channel is not None and parts[number - 1].playing.mapping.mpe:
            raise ParameterError(f"--part {number}={text}: MPE takes all channels of its input")
    return routes


def _own(arguments: argparse.Namespace, number: int) -> argparse.Namespace | None:
    """The arguments of a part; None where it has none of its own."""
    given = {
        option: [text for part, text in getattr(arguments, f"part_{option}") if part == number]
        for option in ("mapping", "instrument", "preset", "set")
    }
    if not any(given.values()):
        return None
    own = copy.copy(arguments)
    own.set = [*arguments.set, *given.pop("set")]
    own.preset = given.pop("preset") or arguments.preset
    own.mpe = arguments.mpe and not given["mapping"]
    for option, texts in given.items():
        if len(texts) > 1:
            raise ParameterError(f"--part-{option}: part {number} has two, {', '.join(texts)}")
        if texts:
            setattr(own, option, Path(texts[0]) if option == "instrument" else texts[0])
    return own


def _options_of(own: argparse.Namespace, number: int) -> PlayingOptions:
    """The options of a part with arguments of its own."""
    from yehu_server.params.table import assignment

    try:
        playing = playing_options_of(own, is_live=True)
        for part, text in own.part_set:
            if part == number:
                check_own(group_of(part - 1), assignment(text)[0])
    except YehuError as error:
        raise type(error)(f"part {number}: {error}") from error
    shared = [address for address, _ in playing.start if find(address).is_shared]
    if shared and number > 1 and own.part_preset:
        warn(f"part {number}: {shared[0]} of its preset is one for all parts, and left out")
    return in_room(playing, own)


# ---------------------------------------------------------------- converters


def _numbered(text: str) -> tuple[int, str]:
    """``N=TEXT``."""
    number, equals, rest = text.partition("=")
    if not equals or not rest.strip() or not number.strip().isdecimal() or len(number) > 9:
        raise argparse.ArgumentTypeError(f"{text!r}: expected N=..., N the number of a part")
    return int(number), rest.strip()
