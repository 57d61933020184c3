"""Carry out OSC messages: setting parameters, and the calls.

The protocol is described in docs/osc.md.
"""

from __future__ import annotations

import difflib
import logging
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from yehu_server.control.backlog import Backlog
from yehu_server.control.calls import LONGEST_SUBSCRIPTION_S
from yehu_server.control.clients import Clients
from yehu_server.control.learn_calls import LearnCalls
from yehu_server.control.packets import Message, PacketError, answer, pack, steps, unpack
from yehu_server.control.patterns import PatternError, is_pattern, matches
from yehu_server.control.peers import Peer
from yehu_server.control.preset_calls import PresetCalls
from yehu_server.control.request import Desk, Request
from yehu_server.control.schedule import AHEAD_S, Schedule, TagClock
from yehu_server.control.status import PLACE, STATUS, STATUS_ADDRESSES, as_argument
from yehu_server.errors import ParameterError, RefusedError, YehuError
from yehu_server.params.spec import Param
from yehu_server.params.table import BY_ADDRESS, PREFIX, TABLE, UNIT, find, read
from yehu_server.playing.live import Arrivals, LivePlayer
from yehu_server.playing.sources import is_own

log = logging.getLogger(__name__)

Act = Callable[[Request], None]

LONGEST_PATTERN = 256
DUE_AT_ONCE = 1024  # scheduled messages taken up at a time
SUBSCRIBED_S = 60.0


class UnknownError(Exception):
    """An unknown address; a near one is looked for only where the error is sent."""


@dataclass
class Counts:
    """Numbers of messages since the start."""

    messages: int = 0
    malformed: int = 0
    errors: int = 0  # wrong types, unknown addresses, refused calls
    late_bundles: int = 0
    scheduled: int = 0


class OscHandler:
    """Carries out the messages of packets; called by the thread of ``sockets.OscPorts`` only."""

    def __init__(self, player: LivePlayer, desk: Desk) -> None:
        self._player = player
        self._desk = desk
        self.counts = Counts()
        self.clients = Clients(player.values, PREFIX, desk.status)
        self._schedule: Schedule[bytes, Peer] = Schedule()
        self._due: Backlog[bytes] = Backlog(self._act_on_due, lambda _peer: None)
        self._tags = TagClock(player)
        self._arrivals = Arrivals(player)
        self._calls: dict[str, Act] = {
            "/note": self._note,
            "/note/off": self._note_off,
            "/pitch": self._pitch,
            "/bend": lambda call: self._set(call, "/playing/bend"),
            "/press": lambda call: self._set(call, "/playing/press"),
            "/bow": self._bow,
            "/release": self._release,
            "/panic": self._panic,
            "/reset": self._reset,
            "/get": self._get,
            "/params": self._params,
            "/status": self._status,
            "/subscribe": self._subscribe,
            "/subscribe/unit": lambda call: self._subscribe(call, UNIT),
            "/subscribe/status": lambda call: self._subscribe(call, PLACE),
            "/unsubscribe": self._unsubscribe,
            "/record/start": self._record_start,
            "/record/stop": self._record_stop,
            "/ping": lambda call: call.peer.send(answer(f"{PREFIX}/pong", call.payload)),
        }
        self._calls |= PresetCalls(player, self.clients, self._complain, desk).by_address
        self._calls |= LearnCalls(player, desk, self._complain).by_address
        # Messages of another server that was made to send us its values.
        self._answers: dict[str, Act] = {
            f"{PREFIX}/subscribed": self._hush,
            f"{PREFIX}/error": lambda _call: None,
        }
        for param in TABLE:
            self._calls[param.address] = self._setter(param.address)
            self._calls[param.address + UNIT] = self._unit_setter(param)

    @property
    def waiting(self) -> int:
        """Number of messages that wait for their time."""
        return len(self._schedule) + len(self._due)

    # -- packets -----------------------------------------------------------------------------

    def handle(self, packet: bytes, peer: Peer, arrived_ns: int) -> Iterator[None]:
        """See `sockets.Handler`: a message is a step."""
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
            self.clients.complain(peer, "", f"malformed packet: {error}")

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
            self._complain(peer, message.address, "too many messages wait for their time")

    def _act_on_due(self, packet: bytes, peer: Peer, frame: int) -> Iterator[None]:
        (message,) = unpack(packet)
        return self._act(message, peer, frame)

    def tick(self) -> None:
        """See `sockets.Handler`."""
        # Early enough to be there when the device asks for their frames.
        self._schedule.ahead_s = AHEAD_S + self._player.delay / self._player.instrument.rate
        for due_s, packet, peer in self._schedule.due(DUE_AT_ONCE):
            self._due.add(packet, peer, self._tags.frame_at(due_s), len(packet), is_due=True)
        self._due.work()
        self.clients.flush()

    def wait_s(self) -> float | None:
        """See `sockets.Handler`."""
        if self._due:
            return 0.0
        waits = [
            wait for wait in (self._schedule.wait_s(), self.clients.wait_s()) if wait is not None
        ]
        return min(waits, default=None)

    def hears(self, peer: Peer) -> bool:
        """See `sockets.Handler`."""
        return self.clients.hears(peer)

    def gone(self, peer: Peer) -> None:
        """See `sockets.Handler`."""
        self.clients.forget(peer)

    def _act(self, message: Message, peer: Peer, frame: int) -> Iterator[None]:
        call = Request(message.arguments, message.payload, peer, frame)
        try:
            actions = self._actions(message.address)
        except UnknownError:
            self._complain(peer, message.address, lambda: _near(message.address))
            return
        except YehuError as error:
            self._complain(peer, message.address, str(error))
            return
        for action in actions:  # one refusal does not stop the others that match a pattern
            try:
                action(call)
            except YehuError as error:
                self._complain(peer, message.address, str(error))
            yield

    def _actions(self, address: str) -> list[Act]:
        known = address.removeprefix(PREFIX)
        if address in self._answers:
            return [self._answers[address]]
        if known in self._calls and known != address:
            return [self._calls[known]]
        own = {address: self._mover(address) for address in self._player.addresses}
        if self._player.listens and is_own(address):
            own.setdefault(address, lambda _call: None)
            own[address] = self._hearing(address, own[address])
        if address in own:
            return [own[address]]
        if is_pattern(address):
            calls = {PREFIX + call: action for call, action in self._calls.items()} | own
            return [calls[one] for one in fitting(address, calls)]
        raise UnknownError

    def _complain(self, peer: Peer, address: str, reason: str | Callable[[], str]) -> None:
        self.counts.errors += 1
        self.clients.complain(peer, address, reason)

    def _mover(self, address: str) -> Act:
        """Move what the mapping binds to an address of the user's own."""
        return lambda call: self._player.move(address, call.numbers(1)[0], frame=call.frame)

    def _hearing(self, address: str, action: Act) -> Act:
        """The same, and let MIDI learn hear the value."""

        def hear(call: Request) -> None:
            self._player.hear(address, call.numbers(1)[0])
            action(call)

        return hear

    # -- parameters --------------------------------------------------------------------------

    def _setter(self, address: str) -> Act:
        return lambda call: self._set(call, address)

    def _set(self, call: Request, address: str) -> None:
        (value,) = call.numbers(1)
        self._player.write(address, value, frame=call.frame)
        self.clients.echo(call.peer, [address])

    def _unit_setter(self, param: Param) -> Act:
        def set_unit(call: Request) -> None:
            (unit,) = call.numbers(1)
            self._player.write(param.address, param.from_unit(unit), frame=call.frame)
            self.clients.echo(call.peer, [param.address + UNIT])

        return set_unit

    def _get(self, call: Request) -> None:
        wanted = call.word().removeprefix(PREFIX)
        if is_pattern(wanted):
            known = (*BY_ADDRESS, *(address + UNIT for address in BY_ADDRESS))
            addresses = fitting(wanted, (*known, *STATUS_ADDRESSES))
        elif wanted in STATUS_ADDRESSES:
            addresses = [wanted]
        else:
            addresses = [_parameter(wanted.removesuffix(UNIT)).address + _form(wanted)]
        call.check_peer()
        values = self._player.values()
        asks_status = any(address in STATUS_ADDRESSES for address in addresses)
        status = self._desk.status() if asks_status else {}
        for address in addresses:
            if address in STATUS_ADDRESSES:
                value = as_argument(status[address.removeprefix(PLACE)])
            else:
                value = read(values, address)
            call.peer.send(pack(PREFIX + address, value))

    def _params(self, call: Request) -> None:
        call.check_peer()
        values = self._player.values()
        for param in TABLE:
            value = values[param.address]
            row = (PREFIX + param.address, value, param.lo, param.hi, param.default)
            call.peer.send(pack(f"{PREFIX}/param", *row, param.unit, param.doc))
        call.peer.send(pack(f"{PREFIX}/params", len(TABLE)))

    # -- playing -----------------------------------------------------------------------------

    def _note(self, call: Request) -> None:
        note, velocity = call.numbers(2)
        if velocity == 0.0:
            self._player.note_off(note, frame=call.frame)
        else:
            self._player.note_on(note, velocity, frame=call.frame)

    def _note_off(self, call: Request) -> None:
        self._player.note_off(call.numbers(1, 2)[0], frame=call.frame)

    def _pitch(self, call: Request) -> None:
        self._player.slide(call.numbers(1)[0], frame=call.frame)

    def _bow(self, call: Request) -> None:
        speed, force = call.numbers(2)
        self._player.draw(speed, force, frame=call.frame)
        self.clients.echo(call.peer, ["/bow/speed", "/bow/force"])

    def _release(self, call: Request) -> None:
        self._player.release(frame=call.frame)

    def _panic(self, call: Request) -> None:
        self._forget_waiting()
        self._player.panic(frame=call.frame)

    def _forget_waiting(self) -> None:
        self._schedule.clear()
        self._due.clear()

    def _reset(self, call: Request) -> None:
        self._forget_waiting()
        self._player.reset(frame=call.frame)
        self.clients.echo(call.peer, BY_ADDRESS)

    # -- services ----------------------------------------------------------------------------

    def _status(self, call: Request) -> None:
        call.check_peer()
        for name, value in self._desk.status().items():
            call.peer.send(pack(PREFIX + PLACE + name, as_argument(value)))

    def _subscribe(self, call: Request, form: str = "") -> None:
        numbers = call.numbers(0, 2)
        seconds = _within_an_hour(numbers[0] if numbers else SUBSCRIBED_S)
        peer = call.peer.at(_port(numbers[1])) if len(numbers) == 2 else call.peer
        if not self.clients.subscribe(peer, seconds, form):
            raise RefusedError("there are too many subscribers")
        peer.send(pack(f"{PREFIX}/subscribed", seconds))

    def _hush(self, call: Request) -> None:
        self.clients.hush(call.peer, _within_an_hour(call.numbers(1)[0]))

    def _unsubscribe(self, call: Request) -> None:
        numbers = call.numbers(0, 1)
        peer = call.peer.at(_port(numbers[0])) if numbers else call.peer
        self.clients.unsubscribe(peer)
        peer.send(pack(f"{PREFIX}/unsubscribed"))

    def _record_start(self, call: Request) -> None:
        name = self._desk.start_recording(call.word())
        call.peer.send(pack(f"{PREFIX}/record/started", name))

    def _record_stop(self, call: Request) -> None:
        name = self._desk.stop_recording()
        call.peer.send(pack(f"{PREFIX}/record/stopped", name))


def _form(address: str) -> str:
    """The part of an address after the parameter's own."""
    return UNIT if address.endswith(UNIT) else ""


def _parameter(address: str) -> Param:
    """Find a parameter; raise ParameterError, with a similar address if there is one."""
    if address in STATUS_ADDRESSES:
        raise ParameterError(f"the status cannot be set; ask for it by {PREFIX}/get")
    if address.startswith(PLACE):
        names = [status.name for status in STATUS]
        near = difflib.get_close_matches(address.removeprefix(PLACE), names, n=1)
        hint = f"; did you mean {PLACE}{near[0]}?" if near else ""
        raise ParameterError(f"unknown status value {address!r}{hint}")
    return find(address)


def _near(address: str) -> str:
    """The reason for an unknown address, with a similar one if there is one."""
    if not address.startswith(PREFIX + "/"):
        return f"unknown address (all begin with {PREFIX}/)"
    try:
        _parameter(address.removeprefix(PREFIX)[:LONGEST_PATTERN].removesuffix(UNIT))
    except YehuError as error:
        return str(error)
    return "unknown address"


def _within_an_hour(seconds: float) -> float:
    return min(max(seconds, 0.0), LONGEST_SUBSCRIPTION_S)


def _port(number: float) -> int:
    if not 0 < number <= 65535 or number != int(number):
        raise RefusedError(f"{number:g} is not a port")
    return int(number)


def fitting(pattern: str, addresses: Iterable[str], prefix: str = "") -> list[str]:
    """The addresses that a pattern matches.

    Raises
    ------
    RefusedError
        Where the pattern is wrong or matches none.
    """
    if len(pattern) > LONGEST_PATTERN:
        raise RefusedError("the pattern is too long")
    try:
        found = [address for address in addresses if matches(pattern, prefix + address)]
    except PatternError as error:
        raise RefusedError(str(error)) from error
    if not found:
        raise RefusedError("the pattern matches no address")
    return found
