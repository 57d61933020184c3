"""A received OSC message, and the services that calls need beside the player."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from yehu_server.errors import RefusedError
from yehu_server.live.osc.peers import Peer


class Desk(Protocol):
    """The services of the server that OSC calls need beside the player."""

    def status(self) -> Mapping[str, float | str]:
        """The status values, by name."""

    def part_status(self, part: int) -> Mapping[str, float]:
        """The status values of a part, counted from 0, by name."""

    def start_recording(self, name: str) -> str:
        """Record to a file of a plain name; return the file's name. Raises YehuError."""

    def stop_recording(self) -> str:
        """End the recording; return the file's name. Raises YehuError."""

    def soon(self, action: Callable[[], None]) -> None:
        """Call a function in the thread that handles packets; any thread may call."""

    def aside(self, action: Callable[[], None]) -> None:
        """Call a function that may take long, such as one that writes a file, in another thread.

        Those that are given one after another are called in this order.
        """

    def tree_changed(self, path: str) -> None:
        """Announce that the tree of addresses has changed at a path or below."""

    def say(self, line: str) -> None:
        """Print or log a line for whoever runs the server."""


@dataclass(frozen=True)
class Request:
    """A message to carry out: its arguments, its sender, and the frame at which it is heard."""

    arguments: Sequence[Any]
    payload: bytes
    peer: Peer
    frame: int

    def check_peer(self) -> None:
        """Refuse more answers to a peer that has reached its limit.

        Raises
        ------
        RefusedError
            Where it has.
        """
        if not self.peer.takes_more:
            raise RefusedError("too many answers to you are waiting")

    def numbers(self, least: int, most: int | None = None) -> list[float]:
        """The arguments as finite numbers.

        Raises
        ------
        RefusedError
            Where their count is not within `least` to `most` (by default `least`), or one is none.
        """
        most = least if most is None else most
        if least == 0 and list(self.arguments) == [None]:  # so OSCQuery clients send none
            return []
        count = len(self.arguments)
        if not least <= count <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}"
            plural = "" if wanted == "1" else "s"
            raise RefusedError(f"expected {wanted} argument{plural}, got {count}")
        return [_number(argument) for argument in self.arguments]

    def word(self) -> str:
        """The only argument, a string.

        Raises
        ------
        RefusedError
            Where there is anything else.
        """
        if len(self.arguments) != 1 or not isinstance(self.arguments[0], str):
            raise RefusedError("expected one string")
        return self.arguments[0]

    def word_and_flag(self) -> tuple[str, bool]:
        """A string, and whether an optional number after it is not 0.

        Raises
        ------
        RefusedError
            Where there is anything else.
        """
        (flag,) = replace(self, arguments=self.arguments[1:] or [0]).numbers(1)
        return replace(self, arguments=self.arguments[:1]).word(), flag != 0.0


def _number(argument: Any) -> float:
    """A number from a float, an int, T or F; raises RefusedError."""
    if not isinstance(argument, int | float):
        raise RefusedError(f"expected a number, got {_kind(argument)}")
    try:
        number = float(argument)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise RefusedError(f"{number} is not finite")
    return number


def _kind(argument: Any) -> str:
    kinds = {str: "a string", bytes: "a blob", type(None): "nil", list: "an array"}
    return kinds.get(type(argument), f"a {type(argument).__name__}")
