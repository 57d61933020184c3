"""Subscriptions: who is sent which changes, in small steps between other messages.

Values are looked at once a round, group by group of addresses (``parts``), and then sent. What a
listener asks for during a round waits for the next one, so that it is told what then holds.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from yehu_server.live.osc.limits import Allowance
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.status import PLACE, as_argument
from yehu_server.live.part_addresses import divided
from yehu_server.params.table import UNIT, read

ERRORS_A_SECOND, ERRORS_AT_ONCE = 10.0, 20.0


@dataclass
class Listener:
    """A peer and what it is to be told. Addresses come in groups: see ``parts``."""

    peer: Peer
    # By group of addresses: the end of its subscription (monotonic s), and the form of the
    # addresses it is told: plain, or ending in UNIT.
    subscribed: dict[str, tuple[float, str]] = field(default_factory=dict)
    asked_status: dict[str, float] = field(default_factory=dict)  # the same, of the status
    # Addresses of which it is told all changes, by group; parameters and status apart.
    listens: dict[str, set[str]] = field(default_factory=dict)
    watches: dict[str, set[str]] = field(default_factory=dict)
    hushed_until: float = 0.0  # until then it is not answered (monotonic s)
    # Addresses to send, and their groups: in the next round of telling, and in the present one.
    to_tell: dict[str, str] = field(default_factory=dict)
    telling: dict[str, str] = field(default_factory=dict)
    errors: Allowance = field(default_factory=lambda: Allowance(ERRORS_A_SECOND, ERRORS_AT_ONCE))
    complained: float = field(default_factory=time.monotonic)

    @property
    def until(self) -> float:
        """When its last subscription ends (monotonic s)."""
        ends = [end for end, _ in self.subscribed.values()]
        return max([*ends, *self.asked_status.values()], default=0.0)

    def subscribes(self, now: float) -> bool:
        """Whether it has a subscription."""
        return self.until > now

    @property
    def is_idle(self) -> bool:
        """Whether nothing waits to be sent to it, and it listens to no address."""
        return not (self.to_tell or self.telling or self.listens or self.watches)

    def among(self, address: str) -> tuple[str, dict[str, set[str]]]:
        """The group of an address, and among which of its addresses it stands."""
        addressed, own = divided(address)
        return addressed, self.watches if own.startswith(PLACE) else self.listens

    def ignore(self, address: str) -> None:
        """Tell it no more of an address that it listens to."""
        addressed, among = self.among(address)
        addresses = among.get(addressed, set())
        addresses.discard(address)
        if not addresses:
            among.pop(addressed, None)
        self.to_tell.pop(address, None)
        self.telling.pop(address, None)

    def form(self, addressed: str, now: float) -> str | None:
        """The form of addresses in which it subscribed to a group's values; None if it has not."""
        end, form = self.subscribed.get(addressed, (0.0, ""))
        return form if end > now else None

    def forms(self, now: float) -> list[str]:
        """The groups whose values it has subscribed to."""
        return [addressed for addressed, (end, _) in self.subscribed.items() if end > now]

    def states(self, now: float) -> set[str]:
        """The groups whose status it has subscribed to."""
        return {addressed for addressed, end in self.asked_status.items() if end > now}


Values = Callable[[str], Mapping[str, float]]
Status = Callable[[str], Mapping[str, float | str]]

STATUS_S = 0.25  # between readings of the status
MOST_TOLD = 512  # messages of one round


class Telling:
    """What listeners were told last, and the rounds that tell them more.

    Parameters
    ----------
    values, status, prefix
        See ``clients.Clients``.
    """

    def __init__(self, values: Values, status: Status, prefix: str) -> None:
        self._values = values
        self._status = status
        self._prefix = prefix
        # By group: what the last round found.
        self._told: dict[str, Mapping[str, float]] = {}
        self._told_status: dict[str, dict[str, float | str]] = {}
        self._looked = 0.0  # when the status was last read

    def round(self, listeners: dict[Peer, Listener], now: float) -> Iterator[None]:
        """Find what is to be told, and send up to MOST_TOLD messages, each as a step.

        Listeners that were sent some are moved behind those that were left out. Others may come
        and go between two steps.
        """
        present = list(listeners.values())
        for listener in present:
            listener.telling |= listener.to_tell
            listener.to_tell.clear()
        yield from self._look(present, now)
        yield from self._look_at_status(present, now)
        yield from self._send(listeners)

    def _look(self, listeners: Sequence[Listener], now: float) -> Iterator[None]:
        wanted: dict[str, None] = {}
        for one in listeners:
            groups = (*one.forms(now), *one.listens, *one.telling.values())
            wanted.update(dict.fromkeys(groups))
        self._told = {group: told for group, told in self._told.items() if group in wanted}
        for group in wanted:
            before, values = self._told.get(group, {}), self._values(group)
            self._told[group] = values
            changed = [group + one for one, value in values.items() if before.get(one) != value]
            if changed:
                _mark_values(listeners, group, changed, now)
            yield

    def _look_at_status(self, listeners: Sequence[Listener], now: float) -> Iterator[None]:
        """Where somebody wants it and it is time."""
        wanted: set[str] = set()
        is_new = False
        for one in listeners:
            wanted.update(one.states(now), one.watches)
            for address, group in one.telling.items():
                if address.startswith(PLACE, len(group)):
                    wanted.add(group)
                    is_new = is_new or address not in self._told_status.get(group, ())
        if not wanted or (now - self._looked < STATUS_S and not is_new):
            return
        self._looked = now
        before, self._told_status = self._told_status, {}
        for group in sorted(wanted):
            states = {
                group + PLACE + name: as_argument(value)
                for name, value in self._status(group).items()
            }
            self._told_status[group] = states
            told = before.get(group, {})
            changed = [address for address, value in states.items() if told.get(address) != value]
            _mark_status(listeners, group, changed, now)
            yield

    def _send(self, listeners: dict[Peer, Listener]) -> Iterator[None]:
        packets: dict[str, bytes] = {}
        left = MOST_TOLD
        for peer, listener in list(listeners.items()):
            if not listener.telling:
                continue
            while (
                listener.telling
                and left > 0
                and peer.takes_more
                and listeners.get(peer) is listener  # sending may end it
            ):
                address, group = next(iter(listener.telling.items()))
                del listener.telling[address]
                if address not in packets:
                    packets[address] = pack(self._prefix + address, self._value(address, group))
                peer.send(packets[address])
                left -= 1
                yield
            if listeners.get(peer) is listener:
                listeners[peer] = listeners.pop(peer)
            if left <= 0:
                break

    def _value(self, address: str, group: str) -> float | str:
        own = address.removeprefix(group)
        if own.startswith(PLACE):
            return self._told_status[group][address]
        return read(self._told[group], own)


def _mark_values(
    listeners: Sequence[Listener], group: str, changed: Sequence[str], now: float
) -> None:
    """Have those who want a group's values told of the addresses that changed."""
    heard = {address + form for address in changed for form in ("", UNIT)}
    for one in listeners:
        form = one.form(group, now)
        if form is not None:
            one.telling.update((address + form, group) for address in changed)
        _mark_heard(one, one.listens, group, heard)


def _mark_status(
    listeners: Sequence[Listener], group: str, changed: Collection[str], now: float
) -> None:
    """The same, of those who want a group's status."""
    heard = set(changed)
    for one in listeners:
        if group in one.states(now):
            one.telling.update(dict.fromkeys(changed, group))
        _mark_heard(one, one.watches, group, heard)


def _mark_heard(
    listener: Listener, among: Mapping[str, set[str]], group: str, heard: set[str]
) -> None:
    if group in among:
        listener.telling.update(dict.fromkeys(among[group] & heard, group))
