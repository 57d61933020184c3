"""Carry out what OSC messages ask of one part: its parameters, its notes, its services."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from yehu_server.errors import RefusedError
from yehu_server.live.osc.answering import Peer
from yehu_server.live.osc.call_table import LONGEST_SUBSCRIPTION_S
from yehu_server.live.osc.context import CallContext, PlayerCalls
from yehu_server.live.osc.learn_calls import LearnCalls
from yehu_server.live.osc.preset_calls import PresetCalls
from yehu_server.live.osc.request import Request
from yehu_server.live.osc.status import STATUS_PREFIX, as_argument
from yehu_server.live.part_addresses import PART_PARAMS, part_of
from yehu_server.params.articulations import number_of
from yehu_server.params.spec import Param
from yehu_server.params.table import TABLE, UNIT
from yehu_server.playing.live_player import LivePlayer

SUBSCRIBED_S = 60.0
ARTICULATION = "/playing/articulation"


class PartCalls(PlayerCalls):
    """Carries out the calls of a part, and sets its parameters."""

    def __init__(self, player: LivePlayer, addressed: str, context: CallContext) -> None:
        super().__init__(player, addressed, context)
        self._params = PART_PARAMS if addressed else TABLE
        self.by_address = {
            "/note": self._note,
            "/note/off": self._note_off,
            "/pitch": self._pitch,
            "/bend": partial(self._set, address="/playing/bend"),
            "/press": partial(self._set, address="/playing/press"),
            "/articulation": self._articulation,
            "/bow": self._bow,
            "/release": self._release,
            "/panic": self._panic,
            "/reset": self._reset,
            "/params": self._send_params,
            "/status": self._status,
            "/subscribe": self._subscribe,
            "/subscribe/unit": partial(self._subscribe, form=UNIT),
            "/subscribe/status": partial(self._subscribe, form=STATUS_PREFIX),
        }
        self.by_address |= PresetCalls(player, addressed, context).by_address
        self.by_address |= LearnCalls(player, addressed, context).by_address
        for param in self._params:
            self.by_address[param.address] = partial(self._set, address=param.address)
            self.by_address[param.address + UNIT] = partial(self._set_unit, param=param)

    def _echo(self, peer: Peer, addresses: Iterable[str]) -> None:
        """Send a peer the values that it has set, of those that the part has."""
        own = {param.address for param in self._params}
        told = [self._addressed + one for one in addresses if one.removesuffix(UNIT) in own]
        self._clients.echo(peer, told)

    # -- parameters --------------------------------------------------------------------------

    def _set(self, call: Request, address: str) -> None:
        (value,) = call.numbers(1)
        self._player.write(address, value, frame=call.frame)
        self._clients.echo(call.peer, [self._addressed + address])

    def _set_unit(self, call: Request, param: Param) -> None:
        (unit,) = call.numbers(1)
        self._player.write(param.address, param.from_unit(unit), frame=call.frame)
        self._clients.echo(call.peer, [self._addressed + param.address + UNIT])

    def _send_params(self, call: Request) -> None:
        call.check_peer()
        values = self._player.values()
        for param in self._params:
            value = values[param.address]
            row = (self._prefix + param.address, value, param.lo, param.hi, param.default)
            self._send(call.peer, "/param", *row, param.unit, param.doc)
        self._send(call.peer, "/params", len(self._params))

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
        self._echo(call.peer, ["/bow/speed", "/bow/force"])

    def _articulation(self, call: Request) -> None:
        number = number_of(call.word())
        self._player.write(ARTICULATION, number, frame=call.frame)
        self._clients.echo(call.peer, [self._addressed + ARTICULATION])

    def _release(self, call: Request) -> None:
        self._player.release(frame=call.frame)

    def _panic(self, call: Request) -> None:
        self._context.drop_scheduled(self._addressed)
        self._player.panic(frame=call.frame)

    def _reset(self, call: Request) -> None:
        self._context.drop_scheduled(self._addressed)
        self._player.reset(frame=call.frame)
        self._echo(call.peer, [param.address for param in self._params])

    # -- services ----------------------------------------------------------------------------

    def _status(self, call: Request) -> None:
        call.check_peer()
        services = self._services
        status = (
            services.part_status(part_of(self._addressed)) if self._addressed else services.status()
        )
        for name, value in status.items():
            self._send(call.peer, STATUS_PREFIX + name, as_argument(value))

    def _subscribe(self, call: Request, form: str = "") -> None:
        numbers = call.numbers(0, 2)
        seconds = within_an_hour(numbers[0] if numbers else SUBSCRIBED_S)
        peer = call.peer.at(port_of(numbers[1])) if len(numbers) == 2 else call.peer
        if not self._clients.subscribe(peer, seconds, form, self._addressed):
            raise RefusedError("there are too many subscribers")
        self._send(peer, "/subscribed", seconds)


def within_an_hour(seconds: float) -> float:
    """The nearest length of a subscription (s) to one that is asked for."""
    return min(max(seconds, 0.0), LONGEST_SUBSCRIPTION_S)


def port_of(number: float) -> int:
    """The port of an argument.

    Raises
    ------
    RefusedError
        Where it is none.
    """
    if not 0 < number <= 65535 or number != int(number):
        raise RefusedError(f"{number:g} is not a port")
    return int(number)
