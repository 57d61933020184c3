"""The parameter table and the kinds of wishes and events, as the page has them."""

from __future__ import annotations

from dataclasses import fields
from enum import Enum
from typing import Any

from yehu_server.midi.events import EVENTS
from yehu_server.params.spec import Param
from yehu_server.params.table import SLOT, TABLE
from yehu_server.player.rows import ROW
from yehu_server.player.wishes import KINDS


def kinds() -> dict[str, int]:
    """The number of each kind of wish, by its name."""
    return {name.upper(): number for number, name in enumerate(KINDS)}


def events() -> dict[str, int]:
    """The number of each other kind of event, by its name."""
    return {name.upper(): number for number, name in enumerate(EVENTS, len(KINDS))}


def parameters() -> list[dict[str, Any]]:
    """The rows of the parameter table, in its order."""
    return [parameter(param) for param in TABLE]


def parameter(param: Param) -> dict[str, Any]:
    """One row: its fields, and its numbers in the player (`row`) and in the engine (`slot`)."""
    own = {camel(field.name): _plain(getattr(param, field.name)) for field in fields(param)}
    group, *words = param.address.split("/")[1:]
    return own | {
        "group": group,
        "label": " ".join(words).replace("_", " "),
        "row": ROW[param.address],
        "slot": SLOT.get(param.address),
    }


def camel(name: str) -> str:
    """A name as JavaScript writes it: ``smooth_ms`` becomes ``smoothMs``."""
    first, *rest = name.split("_")
    return first + "".join(word.capitalize() for word in rest)


def _plain(value: Any) -> Any:
    return value.value if isinstance(value, Enum) else value
