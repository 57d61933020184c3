"""The OSC calls of MIDI learn, and the one that lists what controllers move."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from yehu_server.control.packets import pack
from yehu_server.control.peers import Peer
from yehu_server.control.request import Desk, Request
from yehu_server.errors import YehuError
from yehu_server.params.table import PREFIX, UNIT
from yehu_server.playing import learned
from yehu_server.playing.learner import Found
from yehu_server.playing.live import LivePlayer
from yehu_server.playing.mapping_entries import free

if TYPE_CHECKING:
    from yehu_server.playing.mapping import Mapping

PATIENCE_S = 60.0  # to wait for something to be moved
NOT_MOVED = -1.0


class LearnCalls:
    """Carries out ``/learn``, ``/unlearn`` and ``/bindings``.

    Parameters
    ----------
    complain : callable
        Sends a peer an error, with the address that it sent to.

    Attributes
    ----------
    by_address : dict
        The function that carries out each call; each raises YehuError where it refuses.
    """

    def __init__(
        self, player: LivePlayer, desk: Desk, complain: Callable[[Peer, str, str], None]
    ) -> None:
        self._player = player
        self._desk = desk
        self._complain = complain
        self._wants = 0  # number of requests, so that what is found for an earlier one is ignored
        self.by_address: dict[str, Callable[[Request], None]] = {
            "/learn": self._learn,
            "/unlearn": self._unlearn,
            "/bindings": self._bindings,
        }

    def _learn(self, call: Request) -> None:
        """``/learn [ADDRESS [SOFT]]``."""
        self._wants += 1
        self._player.listen(None)
        if not call.arguments or list(call.arguments) == [None]:
            call.peer.send(pack(f"{PREFIX}/learning", ""))
            return
        address, soft = call.word_and_flag()
        target = free(_plain(address), "learn one").address
        wants, until = self._wants, time.monotonic() + PATIENCE_S

        def found(source: Found) -> None:
            self._desk.soon(lambda: self._found(call.peer, target, source, soft, wants, until))

        self._player.listen(found)
        call.peer.send(pack(f"{PREFIX}/learning", PREFIX + target))

    def _found(
        self, peer: Peer, target: str, source: Found, soft: bool, wants: int, until: float
    ) -> None:
        if wants != self._wants or time.monotonic() > until:
            return
        try:
            mapping, path = learned.learn(self._player.mapping, target, source, soft=soft)
        except YehuError as error:
            self._complain(peer, f"{PREFIX}/learn", str(error))
            return
        self._take(mapping)
        self._desk.say(f"{source.source} moves {target} from now on ({path})")
        peer.send(pack(f"{PREFIX}/learned", PREFIX + target, source.source, str(path)))

    def _unlearn(self, call: Request) -> None:
        target = free(_plain(call.word()), "forget one").address
        mapping, count = learned.unlearn(self._player.mapping, target)
        if count:
            self._take(mapping)
        call.peer.send(pack(f"{PREFIX}/unlearned", PREFIX + target, count))

    def _take(self, mapping: Mapping) -> None:
        self._player.remap(mapping, frame=self._player.frame_of())
        self._desk.tree_changed("/")

    def _bindings(self, call: Request) -> None:
        call.numbers(0)
        rows = self._player.bindings()
        for bind, place, value in rows:
            at = NOT_MOVED if place is None else place
            ends = bind.output_range
            if bind.is_by_range:
                bend_range = self._player.value("/playing/bend_range")
                ends = (bind.semitones(0.0, bend_range), bind.semitones(1.0, bend_range))
            row = (bind.source, PREFIX + bind.target, *ends, bind.curve_name)
            call.peer.send(pack(f"{PREFIX}/binding", *row, "; ".join(bind.terms), at, value))
        call.peer.send(pack(f"{PREFIX}/bindings", len(rows)))


def _plain(address: str) -> str:
    """An address as the parameter table has it."""
    return address.removeprefix(PREFIX).removesuffix(UNIT)
