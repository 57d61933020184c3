"""What OSC clients are sent: values they set, changes they subscribed to, and errors.

All is sent from the listening port, each message by itself: Pure Data does not read bundles.
"""

import time
from collections.abc import Callable, Iterator, Sequence

from yehu_server.errors import shortened
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.change_publisher import ChangePublisher, Status, Subscriber, Values
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.status import STATUS_PREFIX
from yehu_server.live.part_addresses import FIRST

FLUSH_S = 1.0 / 60.0  # between rounds of sending
SLICE_S = 0.0002  # of a round, after which other messages are handled
SWEEP_S = 1.0
FORGIVEN_S = limits.ERRORS_AT_ONCE / limits.ERRORS_A_SECOND


class Clients:
    """The peers that are sent values and errors.

    Addresses come in groups: those of a part have its group before them, which is
    left out of what `values` and `status` return.

    `values`: returns the values of all parameters of a group, by address.
    `prefix`: put before addresses.
    `status`: returns the status values of a group, by name; STATUS_PREFIX makes addresses of names.
    """

    def __init__(self, values: Values, prefix: str, status: Status = lambda _group: {}) -> None:
        self.prefix = prefix
        self._clients: dict[Peer, Subscriber] = {}
        self._named: dict[Peer, Peer] = {}  # subscribers at ports of their own: who named them last
        self._publisher = ChangePublisher(values, status, prefix)
        self.read = self._publisher.read
        self._round: Iterator[None] | None = None  # what is left of a round
        self._flushed = 0.0  # when it began
        self._swept = 0.0
        self._is_waiting = False
        self._crowded = limits.PEERS  # number of clients at which idle ones are dropped

    @property
    def subscribers(self) -> int:
        """Number of clients with a subscription."""
        now = time.monotonic()
        return sum(client.subscribes(now) for client in list(self._clients.values()))  # any thread

    def _client(self, peer: Peer) -> Subscriber:
        client = self._clients.get(peer)
        if client is None:
            if len(self._clients) >= self._crowded:
                self._forget_idle()
                self._crowded = max(limits.PEERS, 2 * len(self._clients))
            client = self._clients[peer] = Subscriber(peer)
        return client

    def _forget_idle(self, *, forgiven_s: float = 0.0) -> None:
        """Drop clients with nothing to be sent, some time after their last error."""
        now = time.monotonic()
        for peer, client in list(self._clients.items()):
            until = max(client.until, client.muted_until, client.last_error + forgiven_s)
            if until <= now and client.is_idle:
                self.forget(peer)

    # -- what clients are sent ---------------------------------------------------------------

    def answered(self, peer: Peer) -> list[Peer]:
        """Return whom answers to a peer are sent to: itself, and those who listen for it.

        These are the subscribers at ports that it named. For one that does not subscribe, such as a
        command of a shell, it is the only one that its host named. So Max hears the answers, whose
        senders and receivers have different ports.
        """
        if not self._named:
            return [peer]
        named = self._listeners(peer)
        own = [listener for listener, sender in named.items() if sender == peer]
        if not own and len(named) == 1 and not self.is_subscribed(peer):
            own = list(named)
        return [peer, *own]

    def _listeners(self, peer: Peer) -> dict[Peer, Peer]:
        """The subscribers at ports that a peer's host named, and who named each."""
        now = time.monotonic()
        return {
            listener: sender
            for listener, sender in self._named.items()
            if listener.host == peer.host
            and type(listener) is type(peer)
            and self._clients[listener].subscribes(now)
        }

    def send(self, peer: Peer, packet: bytes) -> None:
        """Send a peer an answer."""
        for one in self.answered(peer):
            one.send(packet)

    def echo(self, peer: Peer, addresses: Sequence[str]) -> None:
        """Send a peer the values that it has set, with the next flush."""
        for one in self.answered(peer):
            if len(self._clients) >= limits.CLIENTS_ECHOED and one not in self._clients:
                continue
            client = self._client(one)
            if client.muted_until <= time.monotonic():
                client.to_send.update(dict.fromkeys(addresses))
                self._is_waiting = True

    def mute(self, peer: Peer, seconds: float) -> None:
        """Do not answer a peer for some time: two servers would answer each other for ever."""
        self._client(peer).muted_until = time.monotonic() + seconds

    def subscribe(
        self,
        peer: Peer,
        seconds: float,
        form: str = "",
        group: str = FIRST,
        *,
        sender: Peer | None = None,
    ) -> bool:
        """Send a peer every change for some time; return whether there was room for one more.

        `sender` is who asked, where that is another port.
        `form` is empty for plain values, UNIT for values as 0 to 1, STATUS_PREFIX for the status;
        `group` is the group of addresses.
        """
        client, now = self._client(peer), time.monotonic()
        if not client.subscribes(now):
            hosts = [one.peer.host for one in self._clients.values() if one.subscribes(now)]
            if (
                len(hosts) >= limits.SUBSCRIBERS
                or hosts.count(peer.host) >= limits.SUBSCRIBERS_A_HOST
            ):
                return False
        self._is_waiting = True
        topic = group
        if form == STATUS_PREFIX:
            topic, form = group + STATUS_PREFIX, ""
        client.subscribed[topic] = now + seconds, form
        sent = (group + address + form for address in self.read(topic))
        client.to_send.update(dict.fromkeys(sent))
        if sender is not None and sender != peer:
            self._named[peer] = sender
        return True

    def unsubscribe(self, peer: Peer, at: Peer | None = None) -> list[Peer]:
        """End subscriptions: `at` one peer, or a peer's own and those at ports that it named.

        Returns whose they were.
        """
        named = [one for one, sender in self._listeners(peer).items() if sender == peer]
        those = [peer, *named] if at is None else [at]
        now = time.monotonic()
        ended = [
            one for one in those if one in self._clients and self._clients[one].subscribes(now)
        ]
        for one in ended:
            self._clients[one].subscribed.clear()
        return ended

    def listen(self, peer: Peer, address: str) -> None:
        """Send a peer the value at an address (without the prefix) now, and whenever it changes."""
        self._client(peer).listen(address)
        self._is_waiting = True

    def ignore(self, peer: Peer, address: str) -> None:
        """End what `listen` began."""
        self._client(peer).ignore(address)

    def is_subscribed(self, peer: Peer) -> bool:
        """Whether a peer is sent changes of values."""
        client = self._clients.get(peer)
        return client is not None and client.is_watching(time.monotonic())

    def forget(self, peer: Peer) -> None:
        """Drop a peer that has hung up."""
        self._clients.pop(peer, None)
        self._named.pop(peer, None)

    def send_error(self, peer: Peer, address: str, reason: str | Callable[[], str]) -> None:
        """Send a peer an error, unless it was sent many; `reason` may be called for it."""
        client = self._client(peer)
        now = time.monotonic()
        if client.muted_until > now:
            return
        client.last_error = now
        if client.errors.takes(now):
            reason = reason if isinstance(reason, str) else reason()
            error = pack(f"{self.prefix}/error", shortened(address), shortened(reason))
            self.send(peer, error)

    # -- flushing ----------------------------------------------------------------------------

    @property
    def _is_watched(self) -> bool:
        now = time.monotonic()
        return any(client.is_watching(now) for client in self._clients.values())

    def wait_s(self) -> float | None:
        """Seconds until the next flush; None where there is nothing to send."""
        if self._round is not None:
            return 0.0
        if not self._is_waiting and not self._is_watched:
            return None
        return max(0.0, self._flushed + FLUSH_S - time.monotonic())

    def flush(self) -> None:
        """Send what is due, at most 60 times a second; go on with it for up to SLICE_S."""
        now = time.monotonic()
        if now - self._swept > SWEEP_S:
            self._swept = now
            self._forget_idle(forgiven_s=FORGIVEN_S)
        if self._round is None:
            if now - self._flushed < FLUSH_S or not (self._is_waiting or self._is_watched):
                return
            self._flushed = now
            self._is_waiting = False
            self._round = self._publisher.round(self._clients, now)
        steps, self._round = self._round, None  # an error ends a round
        for _ in steps:
            if time.monotonic() > now + SLICE_S:
                self._round = steps
                return
        self._is_waiting |= any(client.sending for client in self._clients.values())
