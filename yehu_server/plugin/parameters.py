"""The parameters that a host sees: those of the table, and choices of preset, mapping and tuning.

A host keeps automation and state by a parameter's number, so numbers are for ever. They come from
the address, which a parameter keeps as long as it is there (a test holds the numbers).
"""

import zlib
from collections.abc import Mapping
from dataclasses import dataclass

from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.params.preset_file import FIRST_LIVE
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import NAMES, TABLE, offered
from yehu_server.plugin.carried import Carried

# A plug-in is a part of one player.
LEFT_OUT = {"/playing/section"}
HANDS = ("bow", "finger", "vibrato", "pluck")
# Numbers below are for controllers of MIDI, where a format has them as parameters.
MIN_NUMBER, NUMBERS = 1 << 30, (1 << 30) - 1
PRESET, ROOM, MAPPING, TUNING = "/preset", "/room", "/mapping", "/tuning"
CHANCE = "/chance"
CHANCES = ("goes on", "begins with the transport")


@dataclass(frozen=True)
class HostParameter:
    """One parameter as a host sees it."""

    address: str
    name: str
    group: str
    unit: str
    lo: float
    hi: float
    default: float
    doc: str
    index: int = -1  # in the parameter table; -1 for a choice of the plug-in's own
    # How many steps there are from the lowest to the highest value; 0: it is continuous.
    steps: int = 0
    is_exponential: bool = False
    choices: tuple[str, ...] = ()  # what each step is called; empty: by its number

    @property
    def number(self) -> int:
        """Its number, for ever."""
        return MIN_NUMBER | zlib.crc32(self.address.encode()) & NUMBERS

    @property
    def symbol(self) -> str:
        """Its name in LV2, for ever."""
        return self.address.strip("/").replace("/", "_")


ARTICULATION = "/playing/articulation"


def parameters(data: Carried) -> list[HostParameter]:
    """List all parameters: the choices first, then those of the table, what one plays by before.

    It begins with the preset and room of live playing, and with the first mapping and tuning.
    """
    presets, rooms, mappings, tunings = data.names
    choices = [
        _choice(
            PRESET,
            "Preset",
            presets,
            "Sets the parameters that the preset names; none, as soon as one of them is changed.",
            default=presets.index(FIRST_LIVE),
        ),
        _choice(
            ROOM,
            "Room",
            rooms,
            "Sets the parameters of a room; custom, as soon as one of them is changed.",
            default=rooms.index(_usual_room(data)),
        ),
        _choice(MAPPING, "Mapping", mappings, "What keys and controllers of MIDI move."),
        _choice(TUNING, "Tuning", tunings, "The pitch of each key."),
        _choice(
            CHANCE,
            "Chance",
            CHANCES,
            "When hands and hair begin anew: a bounce sounds like the last one if they do with "
            "the transport.",
            default=1,
        ),
    ]
    first = data.presets[FIRST_LIVE]
    rows = [_of_table(param, first) for param in TABLE if param.address not in LEFT_OUT]
    return choices + sorted(rows, key=lambda param: param.group != "Playing")


def _usual_room(data: Carried) -> str:
    """The room whose values are those of the table."""
    usual = {param.address: param.default for param in TABLE}
    named = ((name, values) for name, values in data.rooms.items() if values)
    return next(name for name, values in named if values.items() <= usual.items())


def _choice(
    address: str, name: str, choices: tuple[str, ...], doc: str, default: int = 0
) -> HostParameter:
    last = len(choices) - 1
    return HostParameter(
        address, name, "Plug-in", "", 0.0, last, default, doc, steps=last, choices=choices
    )


def _of_table(param: Param, first: Mapping[str, float]) -> HostParameter:
    group, *rest = param.address.strip("/").split("/")
    words = " ".join(rest).replace("_", " ")
    name = words if group == "playing" else f"{group} {words}"
    # What the player moves; whoever moves it takes it over until the next note.
    name += " by hand" if param.player_controlled and group in HANDS else ""
    names = NAMES.get(param.address, {})
    choices = tuple(sorted(names, key=lambda name: names[name]))
    hi = offered(param).hi
    return HostParameter(
        param.address,
        name[0].upper() + name[1:],
        group.capitalize(),
        "" if param.unit == "1" else param.unit,
        param.lo,
        hi,
        first.get(param.address, param.default),
        param.doc,
        index=INDEX[param.address],
        steps=round(hi - param.lo) if param.is_choice else 0,
        is_exponential=param.curve is Curve.EXP,
        choices=choices,
    )
