"""What an OSC call is, and a request for one: a received message with its arguments, checked."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from yehu_server.errors import RefusedError
from yehu_server.live.osc.peers import Peer
from yehu_server.params.table import find


class CountError(RefusedError):
    """Another number of arguments than a call has."""


class KindError(RefusedError):
    """An argument at a place, from 0, that is no number."""

    def __init__(self, place: int, given: str) -> None:
        super().__init__(f"expected a number, got {given}")
        self.place, self.given = place, given


@dataclass
class Request:
    """A message to carry out: its arguments, its sender, and the frame at which it takes effect."""

    arguments: Sequence[Any]
    payload: bytes
    peer: Peer
    frame: int

    def check_peer(self) -> None:
        """Refuse (RefusedError) more answers to a peer that has reached its limit."""
        if not self.peer.takes_more:
            raise RefusedError("too many answers to you are waiting")

    def numbers(
        self, least: int, most: int | None = None, *, after: int = 0, switches: bool = False
    ) -> list[float]:
        """The arguments `after` so many as finite numbers; with `switches` T and F are 1 and 0.

        Raises CountError where their count is not within `least` to `most` (by default `least`),
        KindError where one is no number, RefusedError where one is not finite.
        """
        most = least if most is None else most
        if least == 0 and list(self.arguments) == [None]:  # so OSCQuery clients send none
            return []
        count = len(self.arguments) - after
        if not least <= count <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}"
            plural = "" if wanted == "1" else "s"
            raise CountError(f"expected {wanted} argument{plural}, got {count}")
        numbers = []
        for place, one in enumerate(self.arguments[after:], after):
            is_switch = isinstance(one, bool)
            if not isinstance(one, float | int) or (is_switch and not switches):
                raise KindError(place, _kind(one))
            if not math.isfinite(one):
                raise RefusedError(f"{one} is not finite")
            numbers.append(float(one))
        return numbers

    @property
    def is_let_go(self) -> bool:
        """Whether it has what a momentary button sends as it is let go: 0 or F; see `numbers`."""
        return self.numbers(0, 1, switches=True) == [0.0]

    def word(self) -> str:
        """The only argument, a string; raises CountError where there is anything else."""
        if len(self.arguments) != 1 or not isinstance(self.arguments[0], str):
            raise CountError("expected one string")
        return self.arguments[0]

    def word_and_flags(self, most: int) -> list[Any]:
        """A string, and which of `most` optional numbers after it are not 0.

        Raises RefusedError where there is anything else.
        """
        word = replace(self, arguments=self.arguments[:1]).word()
        given = self.numbers(0, most, after=1, switches=True)
        return [word, *(number != 0.0 for number in given), *[False] * (most - len(given))]


def _kind(argument: Any) -> str:
    if isinstance(argument, bool):
        return "T" if argument else "F"
    kinds = {str: "a string", bytes: "bytes", type(None): "nil", list: "an array"}
    return kinds.get(type(argument), f"a {type(argument).__name__}")


MIDI_NOTE = "MIDI note"


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

    @property
    def wanted(self) -> str:
        """What it has to be, for an error."""
        return f"expected a {self.unit} number" if self.unit == MIDI_NOTE else "expected a number"


@dataclass(frozen=True)
class Call:
    """A call."""

    address: str  # after the prefix
    doc: str  # what it does, for OSCQuery and the surfaces
    arguments: tuple[Argument, ...]
    # Carries it out for a group of addresses; raises YehuError where it refuses.
    act: Callable[[Any, Request], None]
    is_for_all: bool = False  # whether no part has one of its own
    is_momentary: bool = False  # whether a button may send it, and then 0 or F as it is let go
    takes_patterns: bool = False  # whether a pattern reaches it: what plays, and loses nothing
    reads_files: bool = False  # whether it waits for files that are being written


def osc_call(
    address: str, doc: str, *arguments: Argument, **settings: bool
) -> Callable[[Callable[[Any, Request], None]], Call]:
    """Make a call of the method that carries it out; see `Call`, also for `settings`."""
    return lambda act: Call(address, doc, arguments, act, **settings)


def like(address: str, name: str) -> Argument:
    """An argument with the range of a parameter."""
    param = find(address)
    return Argument(name, lo=param.lo, hi=param.hi, unit=param.unit)


ADDRESS, NAME = Argument("address", "s"), Argument("name", "s")


def port_of(number: float) -> int:
    """The port of an argument; raises RefusedError where it is none."""
    if not 0 < number <= 65535 or number != int(number):
        raise RefusedError(f"{number:g} is not a port")
    return int(number)
