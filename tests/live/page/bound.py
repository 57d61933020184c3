"""Binds as pages have them, to be compared with those of mapping files."""

from typing import Any

from yehu_server.live.page import facts
from yehu_server.playing.mapping import Mapping


def rows_of(mapping: Mapping) -> list[dict[str, Any]]:
    """The binds of a mapping, as the page has them."""
    return [placeless(bind) for bind in facts.mapping(mapping)["binds"]]


def placeless(bind: dict[str, Any]) -> dict[str, Any]:
    """A bind of a page, wherever its points lie: those of binds that were overridden stay."""
    row = {name: value for name, value in bind["row"].items() if name != "first_point" and value}
    return bind | {"row": row}
