"""Carry out OSC messages: those to a part (``part_calls``), and the calls that are for all.

The protocol is described in docs/osc.md.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Sequence
from collections.abc import Mapping as Values
from functools import cache, partial

from yehu_server.errors import YehuError
from yehu_server.live.osc.answering import Peer
from yehu_server.live.osc.clients import Clients
from yehu_server.live.osc.context import Act, CallContext, ServerServices
from yehu_server.live.osc.fair_queue import FairQueue
from yehu_server.live.osc.osc_addresses import fitting, near, parameter_of, readable
from yehu_server.live.osc.packets import Message, PacketError, answer, pack, steps, unpack
from yehu_server.live.osc.part_calls import PartCalls, port_of, within_an_hour
from yehu_server.live.osc.patterns import is_pattern
from yehu_server.live.osc.request import Request
from yehu_server.live.osc.schedule import AHEAD_S, Schedule, TagClock
from yehu_server.live.osc.status import Counts
from yehu_server.live.osc.subscriptions import own_address, topic_of
from yehu_server.live.part_addresses import (
    FIRST,
    PART,
    PART_PARAMS,
    check_own,
    check_part,
    group,
    part_of,
    split_group,
)
from yehu_server.params.table import BY_ADDRESS, PREFIX, UNIT, read
from yehu_server.playing.live_player import Arrivals, LivePlayer
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.sources import is_own

log = logging.getLogger(__name__)

DUE_AT_ONCE = 1024  # scheduled messages taken up at a time


class OscHandler:
    """Carries out the messages of packets; called by the thread of ``receiving.OscPorts`` only.

    Parameters
    ----------
    players : sequence of LivePlayer
        Those of all parts. The first has addresses without its part, too.
    """

    def __init__(self, players: Sequence[LivePlayer], services: ServerServices) -> None:
        self._players = players
        self._services = services
        self.counts = Counts()
        self.clients = Clients(self._values, PREFIX, self._states)
        self._schedule: Schedule[bytes] = Schedule()
        self._due: FairQueue[bytes] = FairQueue(self._act_on_due)
        self._tags = TagClock(players[0])
        self._arrivals = Arrivals(players[0].frame_of, players[0].instrument.rate)
        told = self._send_error, self._drop_scheduled, self._tree_changed, self._remap
        context = CallContext(self.clients, services, *told)
        self._groups = {FIRST: players[0]}
        self._groups |= {group(part): player for part, player in enumerate(players)}
        self._calls: dict[str, Act] = {
            addressed + address: action
            for addressed, player in self._groups.items()
            for address, action in PartCalls(player, addressed, context).by_address.items()
        }
        self._calls |= {
            "/panic": self._panic,
            "/reset": self._reset,
            "/get": self._get,
            "/unsubscribe": self._unsubscribe,
            "/record/start": self._record_start,
            "/record/stop": self._record_stop,
            "/ping": lambda call: call.peer.send(answer(f"{PREFIX}/pong", call.payload)),
        }
        self._addresses = tuple(PREFIX + call for call in self._calls)
        # Messages of another server that was made to send us its values.
        self._answers: dict[str, Act] = {f"{PREFIX}/error": lambda _call: None}
        for addressed in self._groups:
            self._answers[f"{PREFIX}{addressed}/subscribed"] = self._mute
        self._readable = tuple(readable(self._groups))
        self._is_readable = frozenset(self._readable)

    def _values(self, addressed: str) -> dict[str, float]:
        """The values of the parameters of a group, by address."""
        values = self._groups[addressed].values()
        return (
            {param.address: values[param.address] for param in PART_PARAMS} if addressed else values
        )

    def _states(self, addressed: str) -> Values[str, float | str]:
        """The status values of a group, by name."""
        return (
            self._services.part_status(part_of(addressed)) if addressed else self._services.status()
        )

    @property
    def waiting(self) -> int:
        """Number of messages that wait for their time."""
        return len(self._schedule) + len(self._due)

    # -- packets -----------------------------------------------------------------------------

    def handle(self, packet: bytes, peer: Peer, arrived_ns: int) -> Iterator[None]:
        """Handle a packet in steps, between which others may be handled: a message is a step."""
        now, frame = time.time(), self._arrivals.frame_of(arrived_ns)
        is_late = False
        try:
            for message in steps(packet):
                if message is not None:
                    is_past = message.due_s is not None and message.due_s <= now
                    self.counts.late_bundles += is_past and not is_late
                    is_late |= is_past
                    yield from self._take(message, peer, now, frame)
                yield
        except PacketError as error:
            self.counts.malformed += 1
            self.clients.send_error(peer, "", f"malformed packet: {error}")

    def _take(self, message: Message, peer: Peer, now: float, frame: int) -> Iterator[None]:
        """Carry out a message, or schedule it."""
        self.counts.messages += 1
        if message.due_s is None or message.due_s <= now:
            yield from self._act(message, peer, frame)
            return
        packet = answer(message.address, message.payload)  # smaller than the message unpacked
        if self._schedule.add(message.due_s, packet, peer, len(packet)):
            self.counts.scheduled += 1
        else:
            self._send_error(peer, message.address, "too many messages wait for their time")

    def _act_on_due(self, packet: bytes, peer: Peer, frame: int) -> Iterator[None]:
        (message,) = unpack(packet)
        yield from self._act(message, peer, frame)

    def tick(self) -> None:
        """Do what is due."""
        # Early enough to be there when the device asks for their frames.
        self._schedule.ahead_s = AHEAD_S + self._players[0].delay / self._players[0].instrument.rate
        for due_s, packet, peer in self._schedule.due(DUE_AT_ONCE):
            self._due.add(packet, peer, self._tags.frame_at(due_s), len(packet), always=True)
        self._due.work()
        self.clients.flush()

    def wait_s(self) -> float | None:
        """Seconds until `tick` has something to do; None where it has nothing."""
        if self._due:
            return 0.0
        waits = self._schedule.wait_s(), self.clients.wait_s()
        return min((wait for wait in waits if wait is not None), default=None)

    def _act(self, message: Message, peer: Peer, frame: int) -> Iterator[None]:
        call = Request(message.arguments, message.payload, peer, frame)
        try:
            actions = self._actions(message.address)
        except YehuError as error:
            self._send_error(peer, message.address, str(error))
            return
        if not actions:  # a near address is looked for only where the error is sent
            unknown = partial(near, message.address, len(self._players))
            self._send_error(peer, message.address, unknown)
        for action in actions:  # one refusal does not stop the others that match a pattern
            try:
                action(call)
            except YehuError as error:
                self._send_error(peer, message.address, str(error))
            yield

    def _actions(self, address: str) -> list[Act]:
        """What carries out the calls at an address; none where it is unknown."""
        known = address.removeprefix(PREFIX)
        if address in self._answers:
            return [self._answers[address]]
        if known in self._calls and known != address:
            return [self._calls[known]]
        own = self._own()
        if is_own(address) or split_group(known)[0]:
            own |= self._learn_actions(address, own)
        if address in own:
            return [own[address]]
        if is_pattern(address):
            found = fitting(address, (*self._addresses, *own))
            return [own.get(one) or self._calls[one.removeprefix(PREFIX)] for one in found]
        return []

    def _own(self) -> dict[str, Act]:
        """Actions for addresses that mappings bind; without a part, of the first part that does."""
        own: dict[str, Act] = {}
        for part, player in enumerate(self._players):
            for address in player.addresses:
                act = _mover(player, address)
                own.setdefault(address, act)
                own[PREFIX + group(part) + address] = act
        return own

    def _learn_actions(self, address: str, own: dict[str, Act]) -> dict[str, Act]:
        """The same, where MIDI learn of a part waits for an address to hear."""
        addressed, plain = split_group(address.removeprefix(PREFIX))
        player = self._groups.get(addressed)
        listening = [player] if addressed else self._players
        hearing = [one for one in listening if one is not None and one.listens and is_own(plain)]
        move = own.get(address)

        def hear(call: Request) -> None:
            for player in hearing:
                player.hear(plain, call.numbers(1)[0])
            if move is not None:
                move(call)

        return {address: hear} if hearing else {}

    def _send_error(self, peer: Peer, address: str, reason: str | Callable[[], str]) -> None:
        self.counts.errors += 1
        self.clients.send_error(peer, address, reason)

    def _tree_changed(self, path: str) -> None:
        """Announce that the tree has changed at a path below each group that it has."""
        for addressed in self._groups if len(self._players) > 1 else (FIRST,):
            self._services.tree_changed(PREFIX + addressed + path)

    def _remap(self, player: LivePlayer, mapping: Mapping) -> None:
        """Give a mapping to a player, and to all others that had the same."""
        before = player.mapping
        for one in self._players:
            if one.mapping == before:
                one.remap(mapping, frame=one.frame_of())

    # -- parameters --------------------------------------------------------------------------

    def _get(self, call: Request) -> None:
        wanted = call.word().removeprefix(PREFIX)
        if is_pattern(wanted):
            addresses = fitting(wanted, self._readable)
        elif wanted in self._is_readable:
            addresses = [wanted]
        else:
            addresses = [self._found(wanted)]
        call.check_peer()
        read_topic = cache(self.clients.read)
        for address in addresses:
            topic = topic_of(address)
            value = read(read_topic(topic), own_address(address, topic))
            call.peer.send(pack(PREFIX + address, value))

    def _found(self, address: str) -> str:
        """The address of a parameter; raises ParameterError, with a similar one if there is one."""
        addressed, own = split_group(address)
        check_part(addressed, len(self._players))
        check_own(addressed, own)
        form = UNIT if own.endswith(UNIT) else ""
        return addressed + parameter_of(own.removesuffix(UNIT)) + form

    # -- all parts ---------------------------------------------------------------------------

    def _panic(self, call: Request) -> None:
        self._drop_scheduled(FIRST)
        for player in self._players:
            player.panic(frame=call.frame)

    def _drop_scheduled(self, addressed: str) -> None:
        """Drop the messages of a part that wait for their time; without a part, all."""
        if not addressed:
            self._schedule.clear()
            self._due.clear()
            return
        own, parts = f"{PREFIX}{addressed}/".encode(), f"{PREFIX}{PART}".encode()

        def is_of_part(packet: bytes) -> bool:
            is_plain = not packet.startswith(parts)
            return packet.startswith(own) or (is_plain and part_of(addressed) == 0)

        self._schedule.drop(is_of_part)
        self._due.drop(is_of_part)

    def _reset(self, call: Request) -> None:
        self._drop_scheduled(FIRST)
        for player in self._players:
            player.reset(frame=call.frame)
        self.clients.echo(call.peer, BY_ADDRESS)

    # -- services ----------------------------------------------------------------------------

    def _mute(self, call: Request) -> None:
        self.clients.mute(call.peer, within_an_hour(call.numbers(1)[0]))

    def _unsubscribe(self, call: Request) -> None:
        numbers = call.numbers(0, 1)
        peer = call.peer.at(port_of(numbers[0])) if numbers else call.peer
        self.clients.unsubscribe(peer)
        peer.send(pack(f"{PREFIX}/unsubscribed"))

    def _record_start(self, call: Request) -> None:
        name = self._services.start_recording(call.word())
        call.peer.send(pack(f"{PREFIX}/record/started", name))

    def _record_stop(self, call: Request) -> None:
        name = self._services.stop_recording()
        call.peer.send(pack(f"{PREFIX}/record/stopped", name))


def _mover(player: LivePlayer, address: str) -> Act:
    """Move what the mapping of a player binds to an address of the user's own."""
    return lambda call: player.move(address, call.numbers(1)[0], frame=call.frame)
