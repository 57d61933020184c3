"""Presets: values of parameters by address, read from a text, and morphed.

The format is described in presets/README.md.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from yehu_server.errors import ParameterError, PresetError
from yehu_server.params.table import BY_ADDRESS, TABLE
from yehu_server.util.documents import parse_toml

VERSION = 1
ENTRIES = ("version", "about", "program", "values")
PROGRAMS = range(1, 129)  # MIDI programs, counted from 1
MOST_REMARKS = 10
# A preset may have all parameters except those that the player moves as notes sound.
POSSIBLE = {param.address: param for param in TABLE if not param.owned}
# The present state of controllers, the seed, and who sits where are no part of a sound and are not
# saved; a file may have them all the same.
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

    def remarks(self) -> list[str]:
        """Warnings about the unknown addresses of a file, a line each."""
        lines = []
        for address in self.unknown[:MOST_REMARKS]:
            near = difflib.get_close_matches(address[:100], POSSIBLE, n=1, cutoff=0.6)
            hint = f"; did you mean {near[0]}?" if near else ""
            lines.append(f"{self.name}: unknown parameter {address!r}, left out{hint}")
        if len(self.unknown) > MOST_REMARKS:
            lines.append(f"{self.name}: and {len(self.unknown) - MOST_REMARKS} more")
        return lines


def parse(text: str, name: str) -> Preset:
    """Read the text of a preset file.

    Raises
    ------
    PresetError
        Where it is no preset, is of a newer version, or has wrong values; it names all of them.
    """
    try:
        data = parse_toml(text)
    except ValueError as error:
        raise PresetError(f"not a preset file ({error})") from error
    _check_version(data)
    wrong = [
        f"unknown entry {entry!r} (known: {', '.join(ENTRIES)})"
        for entry in data
        if entry not in ENTRIES
    ]
    about = data.get("about", "")
    if not isinstance(about, str):
        wrong.append(f"about: expected a line of text, got {about!r}")
    program = data.get("program")
    if program is not None and (type(program) is not int or program not in PROGRAMS):
        wrong.append(f"program: expected a MIDI program, 1 to 128, got {program!r}")
    entries = data.get("values", {})
    if not isinstance(entries, dict):
        wrong.append("values: expected a table of addresses and values")
        entries = {}
    values = {}
    for address in filter(_has, entries):
        try:
            values[address] = _value(address, entries[address])
        except PresetError as error:
            wrong.append(str(error))
    if wrong:
        raise PresetError(*wrong)
    unknown = tuple(address for address in entries if not _has(address))
    return Preset(name, values, " ".join(about.split()), program, unknown)


def _check_version(data: Mapping[str, Any]) -> None:
    version = data.get("version")
    if type(version) is not int or version < 1:
        raise PresetError(f"not a preset file: it has no line version = {VERSION}")
    if version > VERSION:
        reason = f"version {version} is newer than this program, which reads up to {VERSION}"
        raise PresetError(reason)


def _has(address: str) -> bool:
    return address in BY_ADDRESS


def _value(address: str, value: Any) -> float:
    if address not in POSSIBLE:
        raise PresetError(f"{address} is moved by the player as notes sound; no preset may have it")
    param = POSSIBLE[address]
    try:
        accepted = param.accept(value)
    except ParameterError as error:
        raise PresetError(str(error)) from error
    if accepted != value:
        raise PresetError(f"{address}: {value} is not within {param.range_text}")
    return accepted


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
    return param.accept(param.from_unit(low + (high - low) * amount))
