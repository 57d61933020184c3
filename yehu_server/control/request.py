"""One OSC message that asks for something, and whom it may ask beside the player."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from yehu_server.control.peers import Peer
from yehu_server.errors import RefusedError


class Desk(Protocol):
    """What the server does beside playing."""

    def status(self) -> Mapping[str, float | str]:
        """How things stand."""

    def start_recording(self, name: str) -> str:
        """Record under a plain name; return the file's. Errors: YehuError."""

    def stop_recording(self) -> str:
        """End the recording; return the file's name. Errors: YehuError."""

    def soon(self, action: Callable[[], None]) -> None:
        """Let the thread that handles packets do something; any thread may call."""

    def tree_changed(self, path: str) -> None:
        """What can be set or called at an address or below is not what it was."""

    def say(self, line: str) -> None:
        """Tell whoever runs the server."""


@dataclass(frozen=True)
class Request:
    """One message to be acted on: its arguments, who sent it, and when it is to be heard."""

    arguments: Sequence[Any]
    payload: bytes
    peer: Peer
    frame: int

    def check_peer(self) -> None:
        """Errors: RefusedError where the peer asks for more than it is answered, or takes."""
        if not self.peer.takes_more:
            raise RefusedError("there are too many answers on their way to you")

    def numbers(self, least: int, most: int | None = None) -> list[float]:
        """The arguments as finite numbers. Errors: RefusedError."""
        most = least if most is None else most
        if least == 0 and list(self.arguments) == [None]:  # how OSCQuery's clients send nothing
            return []
        count = len(self.arguments)
        if not least <= count <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}"
            plural = "" if wanted == "1" else "s"
            raise RefusedError(f"expected {wanted} argument{plural}, got {count}")
        return [_number(argument) for argument in self.arguments]

    def word(self) -> str:
        """The one argument, a string. Errors: RefusedError."""
        if len(self.arguments) != 1 or not isinstance(self.arguments[0], str):
            raise RefusedError("expected one string")
        return self.arguments[0]

    def word_and_flag(self) -> tuple[str, bool]:
        """A string, and after it a number that may be left out: whether it is not 0."""
        (flag,) = replace(self, arguments=self.arguments[1:] or [0]).numbers(1)
        return replace(self, arguments=self.arguments[:1]).word(), flag != 0.0


def _number(argument: Any) -> float:
    """A number as clients send it: float, int, or T and F. Errors: RefusedError."""
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
