"""The OSC calls of MIDI learn, and the one that lists what controllers move."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

from yehu_server.errors import ParameterError, YehuError
from yehu_server.live.osc.context import CallContext
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.request import Request
from yehu_server.live.part_addresses import check_own, split_group
from yehu_server.params.table import PREFIX, UNIT
from yehu_server.playing import learn
from yehu_server.playing.learn import LearnedSource
from yehu_server.playing.live_player import LivePlayer
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.mapping_entries import settable_param

PATIENCE_S = 60.0  # to wait for something to be moved
NOT_MOVED = -1.0


class LearnCalls:
    """Carries out ``/learn``, ``/unlearn`` and ``/bindings``, at a group of addresses.

    What is learned is learned by the mapping: all parts that use it have it.

    Attributes
    ----------
    by_address : dict
        The function that carries out each call; each raises YehuError where it refuses.
    """

    def __init__(self, player: LivePlayer, addressed: str, context: CallContext) -> None:
        self._player = player
        self._addressed = addressed
        self._prefix = PREFIX + addressed
        self._services = context.services
        self._send_error = context.send_error
        self._remap = context.remap
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
            call.peer.send(pack(f"{self._prefix}/learning", ""))
            return
        address, soft = call.word_and_flag()
        target = self._target(address, "learn one")
        wants, until = self._wants, time.monotonic() + PATIENCE_S

        def found(source: LearnedSource) -> None:
            if wants == self._wants and time.monotonic() <= until:
                learn_it = partial(self._found, call.peer, target, source, soft=soft)
                self._services.run_in_background(learn_it)

        self._player.listen(found)
        call.peer.send(pack(f"{self._prefix}/learning", self._prefix + target))

    def _found(self, peer: Peer, target: str, source: LearnedSource, *, soft: bool) -> None:
        """Write what was found to the user's file; aside, as a disk may be slow."""
        try:
            mapping, path = learn.learn(self._player.mapping, target, source, soft=soft)
        except YehuError as error:
            reason = str(error)
            self._services.call_soon(
                lambda: self._send_error(peer, f"{self._prefix}/learn", reason)
            )
            return
        learnt = (self._prefix + target, source.source, str(path))

        def take() -> None:
            self._take(mapping)
            self._services.log(f"{source.source} moves {target} from now on ({path})")
            peer.send(pack(f"{self._prefix}/learned", *learnt))

        self._services.call_soon(take)

    def _unlearn(self, call: Request) -> None:
        target = self._target(call.word(), "forget one")
        self._services.run_in_background(lambda: self._forget(call.peer, target))

    def _forget(self, peer: Peer, target: str) -> None:
        """Remove what moves a target from the user's file; aside, as a disk may be slow."""
        try:
            mapping, count = learn.unlearn(self._player.mapping, target)
        except YehuError as error:
            reason = str(error)
            self._services.call_soon(
                lambda: self._send_error(peer, f"{self._prefix}/unlearn", reason)
            )
            return

        def take() -> None:
            if count:
                self._take(mapping)
            peer.send(pack(f"{self._prefix}/unlearned", self._prefix + target, count))

        self._services.call_soon(take)

    def _take(self, mapping: Mapping) -> None:
        self._remap(self._player, mapping)
        self._services.tree_changed("/")

    def _bindings(self, call: Request) -> None:
        call.numbers(0)
        rows = self._player.bindings()
        for bind, place, value in rows:
            at = NOT_MOVED if place is None else place
            ends = bind.output_range
            if bind.is_by_range:
                bend_range = self._player.value("/playing/bend_range")
                ends = (bind.semitones(0.0, bend_range), bind.semitones(1.0, bend_range))
            row = (bind.source, self._prefix + bind.target, *ends, bind.curve_name)
            call.peer.send(pack(f"{self._prefix}/binding", *row, "; ".join(bind.terms), at, value))
        call.peer.send(pack(f"{self._prefix}/bindings", len(rows)))

    def _target(self, address: str, what: str) -> str:
        """An address of the part as the parameter table has it; raises where it is no free one."""
        plain = address.removeprefix(PREFIX)
        addressed, own = split_group(plain)
        if addressed not in ("", self._addressed):
            raise ParameterError(f"{address}: is of another part; see {PREFIX}{addressed}/learn")
        own = own.removesuffix(UNIT)
        check_own(self._addressed, own)
        return settable_param(own, what).address
