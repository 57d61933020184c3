"""Which MIDI input plays which part."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from yehu_server.errors import ParameterError
from yehu_server.live.midi.ports import matches
from yehu_server.live.part_addresses import no_part

CHANNELS = 16
_CHANNEL = re.compile(r"(.*):([0-9]+)", re.DOTALL)


@dataclass(frozen=True)
class Route:
    """An input that plays a part.

    `part` and `channel` count from 0; without `words` of its name it is any input, without
    `channel` all of its channels.
    """

    part: int
    words: str = ""
    channel: int | None = None

    @property
    def text(self) -> str:
        """Its text on the command line, without the part."""
        return self.words if self.channel is None else f"{self.words}:{self.channel + 1}"

    @property
    def names(self) -> frozenset[str]:
        """The words, which may stand in any order and case."""
        return frozenset(self.words.casefold().split())

    def takes(self, port: str, channel: int | None) -> bool:
        """Whether it has a message of a port: of a channel, or (None) of all."""
        is_of_channel = None in (self.channel, channel) or self.channel == channel
        return is_of_channel and matches(port, self.words)


def route_of(part: int, text: str) -> Route:
    """Read ``PORT[:CHANNEL]``, words of a name and a channel from 1; raises ParameterError."""
    found = _CHANNEL.fullmatch(text)
    words, channel = (found[1], int(found[2][:4]) - 1) if found else (text, None)
    if channel is not None and not 0 <= channel < CHANNELS:
        raise ParameterError(f"{text!r}: a MIDI channel is 1 to {CHANNELS}")
    words = " ".join(words.split())
    if not words and channel is None:
        raise ParameterError("expected words of an input's name, a channel (:2), or both (keys:2)")
    return Route(part, words, channel)


def check_routes(routes: Sequence[Route], parts: int) -> None:
    """Refuse (ParameterError) routes to parts that are not there, and inputs named twice."""
    for number, route in enumerate(routes):
        if not 0 <= route.part < parts:
            raise ParameterError(no_part(route.part + 1, parts))
        for other in routes[:number]:
            is_same_port = route.names == other.names
            channels = {route.channel, other.channel}
            if is_same_port and (None in channels or len(channels) == 1):
                raise ParameterError(
                    f"{route.part + 1}={route.text}: this input is named twice ({other.part + 1}="
                    f"{other.text}); parts can share one by its channels"
                )


class Router:
    """Finds the parts that a message of an input is for.

    An input that a route names plays the parts of its routes. Others play the parts that no route
    has, one each in the order in which they came, and the last of them all further ones.
    """

    def __init__(
        self, routes: Sequence[Route], parts: int, others: Mapping[str, int] | None = None
    ) -> None:
        self._routes = tuple(routes)
        routed = {route.part for route in routes}
        self._free = [part for part in range(parts) if part not in routed]
        # Part of each input that no route names, and that came before.
        self._others = dict(others or {})

    @property
    def others(self) -> dict[str, int]:
        """The part of each input that came and that no route names, by name."""
        return dict(self._others)

    @property
    def patterns(self) -> list[str]:
        """Words of the names of inputs that routes ask for."""
        return list(dict.fromkeys(route.words for route in self._routes if route.words))

    @property
    def wants_others(self) -> bool:
        """Whether inputs play that no route names."""
        return bool(self._free) or any(not route.words for route in self._routes)

    def parts_of(self, port: str, channel: int | None = None) -> list[int]:
        """The parts that a channel of an input plays; without a channel, those of all."""
        if any(route.takes(port, None) for route in self._routes):
            taking = [route.part for route in self._routes if route.takes(port, channel)]
            return list(dict.fromkeys(taking))
        if not self._free:
            return []
        last = len(self._free) - 1
        return [self._free[self._others.setdefault(port, min(len(self._others), last))]]
