"""The OSC calls that play a part: parameters, notes, values and subscriptions."""

import math
from collections.abc import Sequence
from functools import partial

from yehu_server.errors import RefusedError
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.call import MIDI_NOTE, Argument, Request, like, osc_call, port_of
from yehu_server.live.osc.context import GroupCalls
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.status import STATUS_PREFIX, as_argument
from yehu_server.live.part_addresses import PART_PARAMS
from yehu_server.params.articulations import ARTICULATIONS, number_of
from yehu_server.params.spec import TURNED_ON, Param
from yehu_server.params.table import NAMES, PREFIX, TABLE, UNIT, find, named, offered, there_is
from yehu_server.playing.bind import Bind
from yehu_server.playing.part_state import within_midi
from yehu_server.playing.player import Player
from yehu_server.playing.stringing import range_text

SUBSCRIBED_S, LONGEST_SUBSCRIPTION_S = 60.0, 3600.0
CHOSEN = "/playing/articulation"

NOTE = Argument("note", lo=0.0, hi=127.0, unit=MIDI_NOTE)
VELOCITY = Argument("velocity", lo=0.0, hi=127.0)
ARTICULATION = Argument("articulation", "s", choices=tuple(one.name for one in ARTICULATIONS))
plays = partial(osc_call, takes_patterns=True)  # a call that patterns reach
SECONDS = Argument("seconds", lo=0.0, hi=LONGEST_SUBSCRIPTION_S, unit="s")


class PartCalls(GroupCalls):
    """Carries out the calls of a part, and sets its parameters."""

    @property
    def params(self) -> Sequence[Param]:
        """The parameters that the group has."""
        return PART_PARAMS if self._group else TABLE

    @property
    def _players(self) -> Sequence[Player]:
        """Those that a call for all of the group is for."""
        return [self._player] if self._group else self._context.players

    # -- parameters --------------------------------------------------------------------------

    def set(self, call: Request, param: Param) -> None:
        """Set a parameter."""
        address = param.address
        if len(call.arguments) == 1 and isinstance(call.arguments[0], str) and address in NAMES:
            value = named(param, call.arguments[0])
        else:
            (value,) = call.numbers(1, switches=True)
        self._set(call, address, there_is(param, _whole(param, value)))
        self._clients.echo(call.peer, [self._group + address])

    def _set(self, call: Request, address: str, value: float) -> None:
        accepted = self._player.set(address, value, frame=call.frame)
        if accepted != value and self._player.refuses(address):
            raise RefusedError(f"is held at {accepted:g} by --set; {self._prefix}/release frees it")

    def set_unit(self, call: Request, param: Param) -> None:
        """Set a parameter by 0 to 1 of its range."""
        (unit,) = call.numbers(1, switches=True)
        self._set(call, param.address, _whole(param, offered(param).from_unit(unit)))
        self._clients.echo(call.peer, [self._group + param.address + UNIT])

    def move(self, call: Request, bind: Bind) -> None:
        """Move what the mapping binds to an address of the user's own."""
        (value,) = call.numbers(1, switches=True)
        self._player.move(bind.source, value, frame=call.frame)
        lo, hi = sorted(bind.input_range)
        margin = (hi - lo) / 100.0  # faders overshoot by rounding
        if not lo - margin <= value <= hi + margin:
            name = self._player.mapping.name
            what = f"another range needs input = [LOWEST, HIGHEST] in the mapping {name}"
            self._tell_once(
                call.peer, bind.source, f"{value:g} is outside {lo:g} to {hi:g}; {what}"
            )

    @osc_call("/params", "Sends all parameters: value, range, default, unit, meaning.")
    def _send_params(self, call: Request) -> None:
        call.check_peer()
        values = self._player.values()
        for param in self.params:
            value = values[param.address]
            row = (self._prefix + param.address, value, param.lo, param.hi, param.default)
            self._send(call.peer, "/param", *row, param.unit, param.doc)
        self._send(call.peer, "/params", len(self.params))

    # -- playing -----------------------------------------------------------------------------

    @plays("/note", "Begins a note; velocity 0 ends it.", NOTE, VELOCITY)
    def _note(self, call: Request) -> None:
        note, velocity = call.numbers(2)
        if velocity == 0.0:
            self._player.key_off(note, frame=call.frame)
        else:
            self._player.key_on(note, velocity, frame=call.frame)
            if 0.0 < velocity < 1.0:  # a fader's
                what = f"velocity {velocity:g} is nearly silent: it is 1 to 127"
                self._tell_once(call.peer, f"{self._prefix}/note", what, "velocity")
            tuned, played = self._player.pitches(note)
            if played != tuned:
                what = "it does not sound" if played is None else f"it sounds as {played:g}"
                self._tell_moved(call.peer, "/note", note, what)

    def _tell_moved(self, peer: Peer, address: str, note: float, what: str) -> None:
        outside = f"{note:g} is outside {range_text(self._player.notes)}; {what}"
        self._tell_once(peer, self._prefix + address, outside)

    def _tell_once(self, peer: Peer, address: str, what: str, of: str = "") -> None:
        """Send a peer, once for each address, what becomes of a value, or one `of` its values."""
        told = self._context.told
        if (peer, address + of) not in told:
            if len(told) >= limits.PEERS:
                told.clear()
            told.add((peer, address + of))
            self._clients.send(peer, pack(f"{PREFIX}/moved", address, what))

    @plays("/note/off", "Ends a note.", NOTE)
    def _note_off(self, call: Request) -> None:
        self._player.key_off(call.numbers(1, 2)[0], frame=call.frame)

    @plays("/pitch", "Slides the finger to a pitch: the sounding note's, or the next.", NOTE)
    def _pitch(self, call: Request) -> None:
        pitch = within_midi("pitch", call.numbers(1)[0])
        accepted = self._player.slide(pitch, frame=call.frame)
        if accepted != pitch:
            self._tell_moved(call.peer, "/pitch", pitch, f"the finger goes to {accepted:g}")

    @plays(
        "/bow",
        "Draws the bow by hand; no speed and no force lifts it.",
        like("/bow/speed", "speed"),
        like("/bow/force", "force"),
    )
    def _bow(self, call: Request) -> None:
        speed, force = call.numbers(2)
        self._player.draw(speed, force, frame=call.frame)
        self._echo(call.peer, ["/bow/speed", "/bow/force"])

    @plays("/bend", "Slides the finger away from the note.", like("/playing/bend", "semitones"))
    def _bend(self, call: Request) -> None:
        self.set(call, find("/playing/bend"))

    @plays("/press", "How hard the finger presses the string.", like("/playing/press", "newtons"))
    def _press(self, call: Request) -> None:
        self.set(call, find("/playing/press"))

    @plays("/articulation", "Chooses what both hands do in the next notes.", ARTICULATION)
    def _articulation(self, call: Request) -> None:
        if len(call.arguments) == 1 and isinstance(call.arguments[0], int | float):
            raise RefusedError(
                f"expected a name, such as spiccato; numbers are for {PREFIX}{CHOSEN}"
            )
        number = number_of(call.word())
        self._player.set(CHOSEN, number, frame=call.frame)
        self._echo(call.peer, [CHOSEN])

    @plays(
        "/release",
        "Gives the bow and fingers that you moved directly back to the player (no time).",
        is_momentary=True,
    )
    def _release(self, call: Request) -> None:
        self._player.lift(frame=call.frame)  # of a bow that no note draws
        self._player.release(frame=call.frame)

    @osc_call(
        "/panic",
        "Ends all notes and all sound, and drops messages that wait for their time.",
        is_momentary=True,
    )
    def _panic(self, call: Request) -> None:
        self._context.schedule.drop_part(self._group)
        for player in self._players:
            player.panic(frame=call.frame)

    @osc_call("/reset", "The same, and sets every parameter to its default.", is_momentary=True)
    def _reset(self, call: Request) -> None:
        self._context.schedule.drop_part(self._group)
        for player in self._players:
            player.reset(frame=call.frame)
        self._echo(call.peer, [param.address for param in self.params])

    # -- values ------------------------------------------------------------------------------

    @osc_call("/status", "Sends all status values.")
    def _send_status(self, call: Request) -> None:
        call.check_peer()
        for name, value in self._context.status(self._group).items():
            self._send(call.peer, STATUS_PREFIX + name, as_argument(value))

    @osc_call("/subscribe", "Sends all parameters, and for some time every change.", SECONDS)
    def _subscribe(self, call: Request) -> None:
        self._subscribe_to("", call)

    @osc_call("/subscribe/unit", "The same, with values as 0 to 1, at ADDRESS/unit.", SECONDS)
    def _subscribe_unit(self, call: Request) -> None:
        self._subscribe_to(UNIT, call)

    @osc_call(
        "/subscribe/status", "Sends all status values, and for some time every change.", SECONDS
    )
    def _subscribe_status(self, call: Request) -> None:
        self._subscribe_to(STATUS_PREFIX, call)

    def _subscribe_to(self, form: str, call: Request) -> None:
        numbers = call.numbers(0, 2)
        seconds = numbers[0] if numbers else SUBSCRIBED_S
        if seconds > LONGEST_SUBSCRIPTION_S:
            raise RefusedError(
                f"{seconds:g} s is more than an hour; for a port, send seconds first: "
                f"600 {seconds:g}"
            )
        if seconds < 0.0:
            raise RefusedError(f"{seconds:g} s is less than nothing")
        if seconds == 0.0:
            self._end_subscriptions(call.peer, numbers[1:])
            return
        peer = call.peer.at(port_of(numbers[1])) if len(numbers) == 2 else call.peer
        if not self._clients.subscribe(peer, seconds, form, self._group, sender=call.peer):
            raise RefusedError("there are too many subscribers")
        self._send(call.peer, "/subscribed", seconds)


def within_an_hour(seconds: float) -> float:
    """The nearest length of a subscription (s) to one that is asked for."""
    return min(max(seconds, 0.0), LONGEST_SUBSCRIPTION_S)


def _whole(param: Param, value: float) -> float:
    """A value; of a choice what plays: faders of surfaces pass through fractions."""
    return float(math.floor(value + TURNED_ON)) if param.is_choice else value
