"""Subscriptions: who is sent which changes, in small steps between other messages.

Values are looked at once a round, group by group of addresses (``parts``), and then sent. What a
subscriber asks for during a round waits for the next one, so that it is sent what then holds.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from yehu_server.live.osc.limits import TokenBucket
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.status import STATUS_PREFIX, as_argument
from yehu_server.live.part_addresses import split_group
from yehu_server.params.table import UNIT, read

ERRORS_A_SECOND, ERRORS_AT_ONCE = 10.0, 20.0


@dataclass
class Subscriber:
    """A peer and what it is to be sent. Addresses come in groups: see ``parts``."""

    peer: Peer
    # By group of addresses: the end of its subscription (monotonic s), and the form of the
    # addresses it is sent: plain, or ending in UNIT.
    subscribed: dict[str, tuple[float, str]] = field(default_factory=dict)
    status_subscribed: dict[str, float] = field(default_factory=dict)  # the same, of the status
    # Addresses of which it is sent all changes, by group; parameters and status apart.
    listens: dict[str, set[str]] = field(default_factory=dict)
    watches: dict[str, set[str]] = field(default_factory=dict)
    muted_until: float = 0.0  # until then it is not answered (monotonic s)
    # Addresses to send, and their groups: in the next round of sending, and in the present one.
    to_send: dict[str, str] = field(default_factory=dict)
    sending: dict[str, str] = field(default_factory=dict)
    errors: TokenBucket = field(
        default_factory=lambda: TokenBucket(ERRORS_A_SECOND, ERRORS_AT_ONCE)
    )
    last_error: float = field(default_factory=time.monotonic)

    @property
    def until(self) -> float:
        """When its last subscription ends (monotonic s)."""
        ends = [end for end, _ in self.subscribed.values()]
        return max([*ends, *self.status_subscribed.values()], default=0.0)

    def subscribes(self, now: float) -> bool:
        """Whether it has a subscription."""
        return self.until > now

    @property
    def is_idle(self) -> bool:
        """Whether nothing waits to be sent to it, and it listens to no address."""
        return not (self.to_send or self.sending or self.listens or self.watches)

    def among(self, address: str) -> tuple[str, dict[str, set[str]]]:
        """The group of an address, and among which of its addresses it stands."""
        addressed, own = split_group(address)
        return addressed, self.watches if own.startswith(STATUS_PREFIX) else self.listens

    def ignore(self, address: str) -> None:
        """Tell it no more of an address that it listens to."""
        addressed, among = self.among(address)
        addresses = among.get(addressed, set())
        addresses.discard(address)
        if not addresses:
            among.pop(addressed, None)
        self.to_send.pop(address, None)
        self.sending.pop(address, None)

    def form(self, addressed: str, now: float) -> str | None:
        """The form of addresses in which it subscribed to a group's values; None if it has not."""
        end, form = self.subscribed.get(addressed, (0.0, ""))
        return form if end > now else None

    def forms(self, now: float) -> list[str]:
        """The groups whose values it has subscribed to."""
        return [addressed for addressed, (end, _) in self.subscribed.items() if end > now]

    def states(self, now: float) -> set[str]:
        """The groups whose status it has subscribed to."""
        return {addressed for addressed, end in self.status_subscribed.items() if end > now}


Values = Callable[[str], Mapping[str, float]]
Status = Callable[[str], Mapping[str, float | str]]

STATUS_S = 0.25  # between readings of the status
MOST_SENT = 512  # messages of one round


class ChangePublisher:
    """What subscribers were sent last, and the rounds that send them more.

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
        self._last: dict[str, Mapping[str, float]] = {}
        self._last_status: dict[str, dict[str, float | str]] = {}
        self._looked = 0.0  # when the status was last read

    def round(self, subscribers: dict[Peer, Subscriber], now: float) -> Iterator[None]:
        """Find what is to be sent, and send up to MOST_SENT messages, each as a step.

        Subscribers that were sent some are moved behind those that were left out. Others may come
        and go between two steps.
        """
        present = list(subscribers.values())
        for subscriber in present:
            subscriber.sending |= subscriber.to_send
            subscriber.to_send.clear()
        yield from self._look(present, now)
        yield from self._look_at_status(present, now)
        yield from self._send(subscribers)

    def _look(self, subscribers: Sequence[Subscriber], now: float) -> Iterator[None]:
        wanted: dict[str, None] = {}
        for one in subscribers:
            groups = (*one.forms(now), *one.listens, *one.sending.values())
            wanted.update(dict.fromkeys(groups))
        self._last = {group: sent for group, sent in self._last.items() if group in wanted}
        for group in wanted:
            before, values = self._last.get(group, {}), self._values(group)
            self._last[group] = values
            changed = [group + one for one, value in values.items() if before.get(one) != value]
            if changed:
                _mark_values(subscribers, group, changed, now)
            yield

    def _look_at_status(self, subscribers: Sequence[Subscriber], now: float) -> Iterator[None]:
        """Where somebody wants it and it is time."""
        wanted: set[str] = set()
        is_new = False
        for one in subscribers:
            wanted.update(one.states(now), one.watches)
            for address, group in one.sending.items():
                if address.startswith(STATUS_PREFIX, len(group)):
                    wanted.add(group)
                    is_new = is_new or address not in self._last_status.get(group, ())
        if not wanted or (now - self._looked < STATUS_S and not is_new):
            return
        self._looked = now
        before, self._last_status = self._last_status, {}
        for group in sorted(wanted):
            states = {
                group + STATUS_PREFIX + name: as_argument(value)
                for name, value in self._status(group).items()
            }
            self._last_status[group] = states
            sent = before.get(group, {})
            changed = [address for address, value in states.items() if sent.get(address) != value]
            _mark_status(subscribers, group, changed, now)
            yield

    def _send(self, subscribers: dict[Peer, Subscriber]) -> Iterator[None]:
        packets: dict[str, bytes] = {}
        left = MOST_SENT
        for peer, subscriber in list(subscribers.items()):
            if not subscriber.sending:
                continue
            while (
                subscriber.sending
                and left > 0
                and peer.takes_more
                and subscribers.get(peer) is subscriber  # sending may end it
            ):
                address, group = next(iter(subscriber.sending.items()))
                del subscriber.sending[address]
                if address not in packets:
                    packets[address] = pack(self._prefix + address, self._value(address, group))
                peer.send(packets[address])
                left -= 1
                yield
            if subscribers.get(peer) is subscriber:
                subscribers[peer] = subscribers.pop(peer)
            if left <= 0:
                break

    def _value(self, address: str, group: str) -> float | str:
        own = address.removeprefix(group)
        if own.startswith(STATUS_PREFIX):
            return self._last_status[group][address]
        return read(self._last[group], own)


def _mark_values(
    subscribers: Sequence[Subscriber], group: str, changed: Sequence[str], now: float
) -> None:
    """Have the addresses that changed sent to those who want values of their group."""
    found = {address + form for address in changed for form in ("", UNIT)}
    for one in subscribers:
        form = one.form(group, now)
        if form is not None:
            one.sending.update((address + form, group) for address in changed)
        _mark_listened(one, one.listens, group, found)


def _mark_status(
    subscribers: Sequence[Subscriber], group: str, changed: Collection[str], now: float
) -> None:
    """The same, of those who want a group's status."""
    found = set(changed)
    for one in subscribers:
        if group in one.states(now):
            one.sending.update(dict.fromkeys(changed, group))
        _mark_listened(one, one.watches, group, found)


def _mark_listened(
    subscriber: Subscriber, among: Mapping[str, set[str]], group: str, found: set[str]
) -> None:
    if group in among:
        subscriber.sending.update(dict.fromkeys(among[group] & found, group))
