"""The OSC calls of MIDI learn, and the one that lists what controllers move."""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from yehu_server.errors import ParameterError
from yehu_server.live.osc.call import ADDRESS, Request, osc_call
from yehu_server.live.osc.context import GroupCalls
from yehu_server.live.osc.peers import Peer
from yehu_server.live.part_addresses import check_own, part_of, split_group
from yehu_server.params.table import PREFIX, UNIT, full_address
from yehu_server.playing import learn
from yehu_server.playing.learner import LearnedSource
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.mapping_file import settable_param
from yehu_server.playing.sources import is_address
from yehu_server.util.hints import shown_path

PATIENCE_S = 60.0  # to wait for something to be moved
NOT_MOVED = -1.0


class LearnCalls(GroupCalls):
    """Carries out ``/learn``, ``/unlearn``, ``/bindings``, for all parts that use the mapping."""

    @osc_call(
        "/learn",
        "Adds what is moved next to the controllers of a parameter; without one, ends learning.",
        ADDRESS,
    )
    def _learn(self, call: Request) -> None:
        """``/learn [ADDRESS [SOFT [ONLY]]]``."""
        if not call.arguments or list(call.arguments) == [None]:
            self._player.learning.listen(None)
            self._send(call.peer, "/learning", "")
            return
        address, soft, only = call.word_and_flags(2)
        target = self._target(address, "learn one")
        self._check_rate()
        until = time.monotonic() + PATIENCE_S

        def found(source: LearnedSource) -> None:
            if time.monotonic() <= until:
                learned = partial(self._learned, call.peer, target, source, soft, only)
                self._write(call.peer, "/learn", learned)

        self._player.learning.listen(found, partial(self._send, call.peer, "/learning", ""))
        self._send(call.peer, "/learning", self._prefix + target)

    def _learned(
        self, peer: Peer, target: str, found: LearnedSource, soft: bool, only: bool
    ) -> Callable[[], None]:
        before = learn.current(self._player.mapping)
        is_new = before != self._player.mapping
        source = found.source
        if self._group and is_address(source):
            found = replace(found, part=part_of(self._group) + 1)
        mapping, path = learn.learn(before, target, found, soft=soft, only=only)
        kept = ", ".join(learn.others(mapping, target, source))
        lost = self._pairs(before, mapping)

        def take() -> None:
            self._take(mapping)
            self._context.log(f"{learn.added(before, mapping, target, found)} ({shown_path(path)})")
            if is_new:
                self._context.log("what others changed in this file is used from now on, too")
            self._send(peer, "/learned", self._prefix + target, str(found), str(path), kept, *lost)

        return take

    @osc_call("/unlearn", "Forgets what was learned for a parameter.", ADDRESS)
    def _unlearn(self, call: Request) -> None:
        target = self._target(call.word(), "forget one")
        self._check_rate()
        self._write(call.peer, "/unlearn", partial(self._unlearned, call.peer, target))

    def _unlearned(self, peer: Peer, target: str) -> Callable[[], None]:
        before = learn.current(self._player.mapping)
        mapping, count = learn.unlearn(before, target)
        returned = self._pairs(mapping, before)

        def take() -> None:
            if count:
                self._take(mapping)
            self._send(peer, "/unlearned", self._prefix + target, count, *returned)

        return take

    def _pairs(self, before: Mapping, after: Mapping) -> list[str]:
        """Source and target, one after another, of what is in one mapping and not in another."""
        pairs = learn.changes(before, after)
        return [word for source, target in pairs for word in (source, self._prefix + target)]

    def _take(self, mapping: Mapping) -> None:
        self._context.remap(self._player, mapping)
        self._context.tree_changed("/")

    @osc_call("/bindings", "Sends all bindings: source, target, span, curve, place, value.")
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
            self._send(call.peer, "/binding", *row, "; ".join(bind.terms), at, value)
        self._send(call.peer, "/bindings", len(rows))

    def _target(self, address: str, what: str) -> str:
        """An address of the part as the parameter table has it; raises where it is no free one."""
        plain = address.removeprefix(PREFIX)
        group, own = split_group(plain)
        if group not in ("", self._group):
            raise ParameterError(f"{address}: belongs to another part; send {PREFIX}{group}/learn")
        own = full_address(own.removesuffix(UNIT))
        check_own(self._group, own)
        return settable_param(own, what).address
