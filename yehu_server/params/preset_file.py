"""Read presets (presets/README.md), values by address, and interpolate between two."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from yehu_server.errors import ParameterError, PresetError, near_address
from yehu_server.params.table import BY_ADDRESS, TABLE
from yehu_server.util.documents import MAX_ERRORS, Document
from yehu_server.util.values import whole, words

VERSION = 1
# The preset of live playing where nothing is said. Compared in phrases (docs/playing.md).
FIRST_LIVE = "vibrato"
PROGRAMS = 128  # of MIDI, counted from 1
MAX_REMARKS = 10
# A preset may have all parameters except those that the player moves as notes sound.
POSSIBLE = {param.address: param for param in TABLE if not param.player_controlled}
# Not saved, since they are no part of a sound: the state of controllers, the seed, and places on
# the stage. A file may have them all the same, as those of rooms have the distance.
NOT_SAVED = {
    *("/playing/bend", "/playing/dynamics", "/playing/expression", "/engine/seed"),
    *("/playing/section", "/room/pan", "/room/distance"),
}
SAVED = tuple(address for address in POSSIBLE if address not in NOT_SAVED)


@dataclass(frozen=True)
class Preset:
    """A sound: values of some parameters, by address.

    `program` is the MIDI program, 1 to 128, that selects it; `unknown` are addresses in the
    file that the parameter table does not have.
    """

    name: str
    values: Mapping[str, float] = field(default_factory=dict)
    about: str = ""
    program: int | None = None
    unknown: tuple[str, ...] = ()

    @property
    def is_room(self) -> bool:
        """Whether it is a place, and no sound of the instrument."""
        return bool(self.values) and all(map(is_of_room, self.values))

    def remarks(self) -> list[str]:
        """Warnings about the unknown addresses of a file, a line each."""
        lines = []
        for address in self.unknown[:MAX_REMARKS]:
            hint = near_address(address, POSSIBLE)
            lines.append(f"{self.name}: unknown parameter {address!r}, left out{hint}")
        if len(self.unknown) > MAX_REMARKS:
            lines.append(f"{self.name}: and {len(self.unknown) - MAX_REMARKS} more")
        return lines


def is_of_room(address: str) -> bool:
    """Whether a parameter is one of the room, or how the body sounds in it."""
    return address.startswith("/room/") or address in ("/body/width", "/body/gain")


def document_of(name: Path | str, text: str = "") -> Document:
    """A preset file as a document; its text may be read later."""
    return Document(name, "a preset file", PresetError, text=text, most_errors=MAX_ERRORS)


def preset_from(document: Document, name: str) -> Preset:
    """Check and convert the entries of a preset file.

    Raises PresetError where it is not a preset, is of a newer version, or has wrong values: all of
    them are named.
    """
    table = document.toml()
    version = table.data.get("version")
    if type(version) is not int or version < 1:
        table.add_error("version", f"not a preset file: it has no line version = {VERSION}")
    elif version > VERSION:
        reason = f"{version} is newer than this program, which reads up to {VERSION}"
        table.add_error("version", reason)
    document.raise_errors()
    about = table.read("about", words, "")
    program = table.read("program", whole, None, 1, PROGRAMS)
    found = table.table("values").each(_value)
    table.refuse_others("version")
    document.raise_errors()
    values = {address: value for address, value in found.items() if value is not None}
    unknown = tuple(address for address in found if address not in values)
    return Preset(name, values, about, program, unknown)


def _value(address: str, value: Any) -> float | None:
    """A value of a parameter; None for one that the table does not have."""
    if address not in BY_ADDRESS:
        return None
    if address not in POSSIBLE:
        raise ParameterError("is moved by the player as notes sound; no preset may have it")
    return POSSIBLE[address].within(value)


def morph(one: Preset, other: Preset, amount: float) -> dict[str, float]:
    """Interpolate between two presets, each value along its parameter's curve.

    `amount` is 0 for `one` and 1 for `other`, and is clamped. Choices, such as switches, change
    at a half. A parameter that only one of them has is interpolated with its default.
    """
    amount = min(max(amount, 0.0), 1.0)
    return {
        address: _between(
            address,
            one.values.get(address, param.default),
            other.values.get(address, param.default),
            amount,
        )
        for address, param in POSSIBLE.items()
        if address in one.values or address in other.values
    }


def _between(address: str, start: float, end: float, amount: float) -> float:
    param = POSSIBLE[address]
    if start == end or amount == 0.0:
        return start
    if amount == 1.0:
        return end
    if param.is_choice:
        return end if amount >= 0.5 else start
    low, high = param.to_unit(start), param.to_unit(end)
    return param.clamped(param.from_unit(low + (high - low) * amount))
