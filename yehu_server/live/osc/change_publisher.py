"""Publish changes of values: who is sent which, in small steps between other messages.

Values are read once a round, topic by topic, and then sent. What a subscriber asks for during a
round waits for the next one, so that it is sent the values of then.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import islice
from typing import Any

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.status import STATUS_PREFIX, as_argument
from yehu_server.live.part_addresses import split_group
from yehu_server.params.table import UNIT, read
from yehu_server.util.token_bucket import TokenBucket


@cache
def topic_of(address: str) -> str:
    """The topic of an address (without the prefix): its group, or the status of its group."""
    group, own = split_group(address)
    return group + STATUS_PREFIX if own.startswith(STATUS_PREFIX) else group


@dataclass
class Subscriber:
    """A peer and what it is to be sent."""

    peer: Peer
    # By topic: the end of its subscription (monotonic s), and the form of the addresses it is
    # sent: plain, or ending in UNIT.
    subscribed: dict[str, tuple[float, str]] = field(default_factory=dict)
    # By topic: addresses of which it is sent all changes.
    listens: dict[str, set[str]] = field(default_factory=dict)
    muted_until: float = 0.0  # until then it is not answered (monotonic s)
    # Addresses to send, in order: in the next round of sending, and in the present one.
    to_send: dict[str, None] = field(default_factory=dict)
    sending: dict[str, None] = field(default_factory=dict)
    errors: TokenBucket = field(
        default_factory=lambda: TokenBucket(limits.ERRORS_A_SECOND, limits.ERRORS_AT_ONCE)
    )
    last_error: float = field(default_factory=time.monotonic)

    @property
    def until(self) -> float:
        """When its last subscription ends (monotonic s)."""
        return max((end for end, _ in self.subscribed.values()), default=0.0)

    def subscribes(self, now: float) -> bool:
        """Whether it has a subscription."""
        return self.until > now

    def is_watching(self, now: float) -> bool:
        """Whether it is sent changes of values."""
        return bool(self.listens) or self.subscribes(now)

    @property
    def is_idle(self) -> bool:
        """Whether nothing waits to be sent to it, and it listens to no address."""
        return not (self.to_send or self.sending or self.listens)

    def listen(self, address: str) -> None:
        """Send it the value at an address, and its changes."""
        self.to_send[address] = None
        self.listens.setdefault(topic_of(address), set()).add(address)

    def ignore(self, address: str) -> None:
        """End what `listen` began."""
        topic = topic_of(address)
        if left := self.listens.pop(topic, set()) - {address}:
            self.listens[topic] = left
        self.to_send.pop(address, None)
        self.sending.pop(address, None)

    def topics(self, now: float) -> Iterator[str]:
        """The topics of which it is to be sent something."""
        yield from (topic for topic, (end, _) in self.subscribed.items() if end > now)
        yield from self.listens
        yield from map(topic_of, self.sending)

    def mark(self, topic: str, changed: Sequence[str], found: set[str], now: float) -> None:
        """Mark what it wants of changed addresses to be sent (`found` has all their forms)."""
        end, form = self.subscribed.get(topic, (0.0, ""))
        if end > now:
            self.sending.update(dict.fromkeys(address + form for address in changed))
        self.sending.update(dict.fromkeys(self.listens.get(topic, set()) & found))


Values = Callable[[str], Mapping[str, float]]
Status = Callable[[str], Mapping[str, float | str]]

STATUS_S = 0.25  # between readings of the status
MESSAGES_A_STEP = 4


class ChangePublisher:
    """What subscribers were sent last, and the rounds that send more; see ``clients.Clients``."""

    def __init__(self, values: Values, status: Status, prefix: str) -> None:
        self._values = values
        self._status = status
        self._prefix = prefix
        self._last: dict[str, Mapping[str, Any]] = {}  # by topic: what was found last
        self._status_read = 0.0  # monotonic s

    def read(self, topic: str) -> Mapping[str, Any]:
        """The values of a topic, by address after the group."""
        if not topic.endswith(STATUS_PREFIX):
            return self._values(topic)
        status = self._status(topic.removesuffix(STATUS_PREFIX))
        return {STATUS_PREFIX + name: as_argument(value) for name, value in status.items()}

    def round(self, subscribers: dict[Peer, Subscriber], now: float) -> Iterator[None]:
        """Find what is to be sent, and send up to CHANGES_AT_ONCE messages, some in each step.

        Subscribers that were sent some are moved behind those that were left out. Others may come
        and go between two steps.
        """
        present = list(subscribers.values())
        for subscriber in present:
            subscriber.sending |= subscriber.to_send
            subscriber.to_send.clear()
        yield from self._find(present, now)
        yield from self._send(subscribers)

    def _find(self, subscribers: Sequence[Subscriber], now: float) -> Iterator[None]:
        """Find what has changed; of the status where it is time, or some was never read."""
        wanted = dict.fromkeys(topic for one in subscribers for topic in one.topics(now))
        status = {topic for topic in wanted if topic.endswith(STATUS_PREFIX)}
        is_due = now - self._status_read >= STATUS_S or any(
            own_address(address) not in self._last.get(topic_of(address), ())
            for one in subscribers
            for address in one.sending
            if topic_of(address) in status
        )
        if status and is_due:
            self._status_read = now
        # What was read of the status is kept, so that who comes and goes has it read no sooner.
        self._last = {
            topic: last
            for topic, last in self._last.items()
            if topic in wanted or topic.endswith(STATUS_PREFIX)
        }
        for topic in wanted:
            if topic in status and not is_due:
                continue
            before, values = self._last.get(topic, {}), self.read(topic)
            self._last[topic] = values
            group = topic.removesuffix(STATUS_PREFIX)
            changed = [group + one for one, value in values.items() if before.get(one) != value]
            found = {address + form for address in changed for form in ("", UNIT)}
            for subscriber in subscribers if changed else ():
                subscriber.mark(topic, changed, found, now)
            yield

    def _send(self, subscribers: dict[Peer, Subscriber]) -> Iterator[None]:
        packets: dict[str, bytes] = {}
        left = limits.CHANGES_AT_ONCE
        for peer, subscriber in list(subscribers.items()):
            if not subscriber.sending:
                continue
            while (
                subscriber.sending
                and left > 0
                and peer.takes_more
                and subscribers.get(peer) is subscriber  # sending may end it
            ):
                addresses = list(islice(subscriber.sending, min(left, MESSAGES_A_STEP)))
                for address in addresses:
                    del subscriber.sending[address]
                    if address not in packets:
                        value = read(self._last[topic_of(address)], own_address(address))
                        packets[address] = pack(self._prefix + address, value)
                peer.send(*map(packets.__getitem__, addresses))
                left -= len(addresses)
                yield
            if subscribers.get(peer) is subscriber:
                subscribers[peer] = subscribers.pop(peer)
            if left <= 0:
                break


def own_address(address: str) -> str:
    """An address after its group."""
    return split_group(address)[1]
