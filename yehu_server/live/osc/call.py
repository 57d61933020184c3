"""What an OSC call is: an address, words, arguments, and the method that carries it out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from yehu_server.live.osc.request import Request
from yehu_server.params.table import find


@dataclass(frozen=True)
class Argument:
    """An argument of a call: a number (``f``) in a range, or a string (``s``), maybe of `choices`.

    `kind` is its OSC type tag; `choices`, where there are any, are all that it may be.
    """

    name: str
    kind: str = "f"
    lo: float | None = None
    hi: float | None = None
    unit: str = "1"
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Call:
    """A call.

    `address`: after the prefix.
    `doc`: what it does, for OSCQuery and the surfaces.
    `act`: carries it out for a group of addresses; raises YehuError where it refuses.
    `is_for_all`: whether no part has one of its own.
    """

    address: str
    doc: str
    arguments: tuple[Argument, ...]
    act: Callable[[Any, Request], None]
    is_for_all: bool = False


def osc_call(
    address: str, doc: str, *arguments: Argument, is_for_all: bool = False
) -> Callable[[Callable[[Any, Request], None]], Call]:
    """Make a call of the method that carries it out; see `Call`."""
    return lambda act: Call(address, doc, arguments, act, is_for_all)


def like(address: str, name: str) -> Argument:
    """An argument with the range of a parameter."""
    param = find(address)
    return Argument(name, lo=param.lo, hi=param.hi, unit=param.unit)


ADDRESS, NAME = Argument("address", "s"), Argument("name", "s")
