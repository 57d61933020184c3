"""Carry out OSC messages, by the table of calls (``all_calls``), at once or when they are due.

The protocol is described in docs/osc.md.
"""

import logging
from collections.abc import Iterator
from functools import partial

from yehu_server.errors import RefusedError, YehuError
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.all_calls import NAMED_IN_FULL, acts, own_calls, owners
from yehu_server.live.osc.call import Request
from yehu_server.live.osc.context import Act, CallContext
from yehu_server.live.osc.osc_addresses import fitting, is_pattern, unknown
from yehu_server.live.osc.packets import Message, PacketError, answer, steps
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.playing_calls import PartCalls, within_an_hour
from yehu_server.live.osc.schedule import AHEAD_S, TagClock
from yehu_server.live.osc.sender_queues import SenderQueues
from yehu_server.live.part_addresses import part_of, split_group
from yehu_server.params.table import PREFIX
from yehu_server.playing.delay import Arrivals
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.player import SENDER
from yehu_server.playing.sources import is_own
from yehu_server.system import clocks

log = logging.getLogger(__name__)

DUE_AT_ONCE = 512  # scheduled messages, which then take turns with others
LONGEST_WAIT_S = 0.5
FAR_S, LONGEST_AHEAD_S = 60.0, 3600.0  # a time tag so far ahead is told, or refused
MAX_FAR = 64  # hosts that are told of, each once
IGNORED = (f"{PREFIX}/error", f"{PREFIX}/moved")


class OscHandler:
    """Carries out packets at `addresses` of parameters and calls, in ``receiving.OscPorts``."""

    def __init__(self, context: CallContext) -> None:
        self.context = context
        self.counts, self.clients = context.counts, context.clients
        self._players, self._groups = context.players, context.groups
        self._schedule = context.schedule
        self._tags = TagClock(self._players[0])
        self._arrivals = Arrivals(self._players[0].frame_of, self._players[0].instrument.rate)
        self._queues = SenderQueues([player.instrument for player in self._players])
        self._far: set[str] = set()  # hosts that were told of
        found: dict[str, Act] = {}
        for group in self._groups:
            found |= acts(group, context)
        self._named_in_full = {
            PREFIX + one for one in found if split_group(one)[1] in NAMED_IN_FULL
        }
        acts_at = {PREFIX + address: act for address, act in found.items()}
        self.addresses = context.addresses = tuple(acts_at)
        # Messages of another server that was made to send us its values.
        acts_at |= dict.fromkeys(IGNORED, lambda _call: None)
        acts_at |= {f"{PREFIX}{group}/subscribed": self._mute for group in self._groups}
        self._known = {address: {address: act} for address, act in acts_at.items()}
        self._mappings: list[Mapping] = []
        self._own: dict[str, Act] = {}

    @property
    def waiting(self) -> int:
        """Number of messages that wait for their time."""
        return len(self._schedule)

    # -- packets -----------------------------------------------------------------------------

    def handle(
        self, packet: bytes, peer: Peer, arrived_ns: int = 0, *, frame: int | None = None
    ) -> Iterator[None]:
        """Handle a packet in steps, between which others may be handled: a message is a step.

        `frame`: of one message that waited for its time; without it, the packet takes effect as
        it arrived, and its bundles at their times.
        """
        now, is_late, is_due = clocks.now_s(), False, frame is not None
        frame = self._arrivals.frame_of(arrived_ns) if frame is None else frame
        try:
            for number, message in enumerate(steps(packet)):
                if number:  # between two, so that one alone is a single step
                    yield
                if message is None:
                    continue
                self.counts.messages += not is_due
                address = message.address
                actions = self._known.get(address) or self._actions(address, peer)
                if message.due_s is not None and message.due_s > now:
                    if actions:
                        self._keep(message, peer)
                    continue
                self.counts.late_bundles += message.due_s is not None and not is_late
                is_late |= message.due_s is not None
                call = Request(message.arguments, message.payload, peer, frame)
                for turn, (address, action) in enumerate(actions.items()):
                    if turn:
                        yield
                    self._carry_out(action, call, address)
        except PacketError as error:
            self.counts.malformed += 1
            self.context.report_error(peer, "", f"malformed packet: {error}")

    def _carry_out(self, action: Act, call: Request, address: str) -> None:
        """Carry out a call; one refusal does not stop the others that match a pattern."""
        sender = SENDER.set(self._queues.queue_of(call.peer, call.frame))
        try:
            action(call)
        except YehuError as error:
            self.context.send_error(call.peer, address, str(error))
        finally:
            SENDER.reset(sender)

    def refuse_long(self, peer: Peer) -> None:
        """Refuse a datagram that is too long to be received whole."""
        reason = f"a datagram has at most {limits.DATAGRAM} bytes; send longer packets by TCP"
        self.context.report_error(peer, "", reason)

    def _keep(self, message: Message, peer: Peer) -> None:
        """Keep a message until its time; tell of a sender whose clock is far from this one."""
        ahead_s = (message.due_s or 0.0) - clocks.now_s()
        if ahead_s > LONGEST_AHEAD_S:
            reason = f"its time is {ahead_s:.0f} s ahead, more than an hour: is the clock right?"
            self.context.send_error(peer, message.address, reason)
            return
        if ahead_s > FAR_S and peer.host not in self._far and len(self._far) < MAX_FAR:
            self._far.add(peer.host)
            log.warning(
                "OSC: time tags of %s are %.0f s ahead: is its clock right?", peer.host, ahead_s
            )
        packet = answer(message.address, message.payload)  # smaller than the message unpacked
        if not self._schedule.add(message.due_s or 0.0, packet, peer):
            self.context.send_error(peer, message.address, "too many messages wait for their time")

    def due(self) -> Iterator[tuple[Iterator[None], Peer, int]]:
        """What is to be done for messages whose time has come: steps, sender and size of each."""
        self.context.count_errors()
        # Early enough to be there when the device asks for their frames.
        self._schedule.ahead_s = AHEAD_S + self._players[0].delay / self._players[0].instrument.rate
        for _ in range(DUE_AT_ONCE):
            due = self._schedule.due()
            if due is None:
                break
            due_s, packet, peer = due
            yield self.handle(packet, peer, frame=self._tags.frame_at(due_s)), peer, len(packet)

    def wait_s(self) -> float:
        """Seconds until something is due or to be sent, or has to be checked again."""
        waits = self._schedule.wait_s(), self.clients.wait_s(), LONGEST_WAIT_S
        return min(wait for wait in waits if wait is not None)

    def _actions(self, address: str, peer: Peer) -> dict[str, Act]:
        """What carries out the calls at an address or pattern; sends an error where none does."""
        try:
            actions = self._found(address)
        except YehuError as error:
            self.context.send_error(peer, address, str(error))
            return {}
        if not actions:  # a near address is searched for only where the error is sent
            known = (*self._own_acts(), *self.addresses)
            reason = partial(unknown, address, len(self._players), known)
            self.context.send_error(peer, address, reason)
        return actions

    def _found(self, address: str) -> dict[str, Act]:
        """By address, what carries out calls of the user's own, or at a pattern; else none."""
        own = self._own_acts()
        if is_own(address) or split_group(address.removeprefix(PREFIX))[0]:
            own = own | self._learn_acts(address, own)
        if address in own:
            return {address: own[address]}
        if is_pattern(address):
            found = fitting(address, (*self.addresses, *own))
            reached = [one for one in found if one not in self._named_in_full]
            if not reached:
                raise RefusedError(f"{found[0]} takes no pattern: send its whole address")
            return {one: own.get(one) or self._known[one][one] for one in reached}
        return {}

    def _mute(self, call: Request) -> None:
        self.clients.mute(call.peer, within_an_hour(call.numbers(1)[0]))

    def _own_acts(self) -> dict[str, Act]:
        """For addresses that mappings bind; without a part, those of `owners`."""
        mappings = [player.mapping for player in self._players]
        if list(map(id, mappings)) != list(map(id, self._mappings)):
            self._mappings, self._own = mappings, {}
            parts = owners(mappings)
            for group, mapping in zip(self._groups[1:], mappings, strict=True):
                part = PartCalls(group, self.context)
                for call in own_calls(mapping, group):
                    act = self._own[PREFIX + group + call.address] = partial(call.act, part)
                    if parts[call.address] == part_of(group):
                        self._own[call.address] = act
        return self._own

    def _learn_acts(self, address: str, own: dict[str, Act]) -> dict[str, Act]:
        """The same, where MIDI learn of a part waits for an address to hear."""
        group, plain = split_group(address.removeprefix(PREFIX))
        players = self._players
        if group:
            players = players[part_of(group) :][:1] if group in self._groups else ()
        hearing = [player for player in players if is_own(plain) and player.learning.expects(plain)]
        move = own.get(address)

        def hear(call: Request) -> None:
            for player in hearing:
                player.learning.hear_address(plain, call.numbers(1, switches=True)[0])
            if move is not None:
                move(call)

        return {address: hear} if hearing else {}
