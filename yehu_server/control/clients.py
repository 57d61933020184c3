"""What OSC clients are told: values they set, changes they subscribed to, and errors.

All is sent from the listening port, each message by itself: Pure Data does not read bundles.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from yehu_server.control.allowance import Allowance
from yehu_server.control.packets import pack
from yehu_server.control.peers import Peer
from yehu_server.control.status import PLACE, as_argument
from yehu_server.lines import shortened
from yehu_server.params.table import UNIT, read

FLUSH_S = 1.0 / 60.0
STATUS_S = 0.25  # between readings of the status
SWEEP_S = 1.0
MOST_SUBSCRIBERS, MOST_OF_A_HOST = 64, 32
MOST_KNOWN, MOST_CROWDED = 1024, 8192
MOST_TOLD = 512  # messages of one `flush`
ERRORS_A_SECOND, ERRORS_AT_ONCE = 10.0, 20.0
FORGIVEN_S = ERRORS_AT_ONCE / ERRORS_A_SECOND


@dataclass
class Client:
    """A peer and what it is to be told."""

    peer: Peer
    until: float = 0.0  # end of its subscription (monotonic s)
    form: str = ""  # of addresses it is told: plain, or ending in UNIT
    status_until: float = 0.0  # end of its subscription to the status (monotonic s)
    listens: set[str] = field(default_factory=set)  # addresses of which it is told all changes
    hushed_until: float = 0.0  # until then it is not answered (monotonic s)
    to_tell: dict[str, None] = field(default_factory=dict)  # addresses to send, in order
    errors: Allowance = field(default_factory=lambda: Allowance(ERRORS_A_SECOND, ERRORS_AT_ONCE))
    complained: float = field(default_factory=time.monotonic)

    def subscribes(self, now: float) -> bool:
        """Whether it has a subscription."""
        return max(self.until, self.status_until) > now


class Clients:
    """The peers that are sent values and errors.

    Parameters
    ----------
    values : callable
        Returns all parameters' values, by address.
    prefix : str
        Put before addresses.
    status : callable, optional
        Returns the status values, by name; their addresses are PLACE and the name.
    """

    def __init__(
        self,
        values: Callable[[], dict[str, float]],
        prefix: str,
        status: Callable[[], Mapping[str, float | str]] = dict,
    ) -> None:
        self._values = values
        self.prefix = prefix
        self._status = status
        self._clients: dict[Peer, Client] = {}
        self._told: dict[str, float] = {}  # values at the last flush
        self._told_status: dict[str, float | str] = {}
        self._looked = 0.0  # when the status was last read
        self._flushed = 0.0
        self._swept = 0.0
        self._is_waiting = False
        self._crowded = MOST_KNOWN  # number of clients at which idle ones are dropped
        self.errors_sent = 0
        self.errors_withheld = 0

    @property
    def subscribers(self) -> int:
        """Number of clients with a subscription."""
        now = time.monotonic()
        return sum(client.subscribes(now) for client in list(self._clients.values()))  # any thread

    def _client(self, peer: Peer) -> Client:
        client = self._clients.get(peer)
        if client is None:
            if len(self._clients) >= self._crowded:
                self._forget_idle()
                self._crowded = max(MOST_KNOWN, 2 * len(self._clients))
            client = self._clients[peer] = Client(peer)
        return client

    def _forget_idle(self, *, forgiven_s: float = 0.0) -> None:
        """Drop clients with nothing to be sent, some time after their last error."""
        now = time.monotonic()
        self._clients = {
            peer: client
            for peer, client in self._clients.items()
            if max(
                client.until,
                client.status_until,
                client.hushed_until,
                client.complained + forgiven_s,
            )
            > now
            or client.to_tell
            or client.listens
        }

    # -- what clients are sent ---------------------------------------------------------------

    def echo(self, peer: Peer, addresses: Iterable[str]) -> None:
        """Send a peer the values that it has set, with the next flush."""
        if len(self._clients) >= MOST_CROWDED and peer not in self._clients:
            return
        client = self._client(peer)
        if client.hushed_until <= time.monotonic():
            client.to_tell.update(dict.fromkeys(addresses))
            self._is_waiting = True

    def hush(self, peer: Peer, seconds: float) -> None:
        """Do not answer a peer for some time: another server that sends us its own values.

        Two servers that answer each other would go on for ever.
        """
        self._client(peer).hushed_until = time.monotonic() + seconds

    def subscribe(self, peer: Peer, seconds: float, form: str = "") -> bool:
        """Send a peer every change for some time; return whether there was room for one more.

        `form` is empty for plain values, UNIT for values as 0 to 1, or PLACE for the status.
        """
        client, now = self._client(peer), time.monotonic()
        if not client.subscribes(now):
            hosts = [one.peer.host for one in self._clients.values() if one.subscribes(now)]
            if len(hosts) >= MOST_SUBSCRIBERS or hosts.count(peer.host) >= MOST_OF_A_HOST:
                return False
        self._is_waiting = True
        if form == PLACE:
            client.status_until = now + seconds
            client.to_tell.update(dict.fromkeys(PLACE + name for name in self._status()))
            return True
        client.until = now + seconds
        client.form = form
        client.to_tell.update(dict.fromkeys(address + form for address in self._values()))
        return True

    def unsubscribe(self, peer: Peer) -> None:
        """End a peer's subscriptions."""
        client = self._client(peer)
        client.until = client.status_until = 0.0

    def listen(self, peer: Peer, address: str) -> None:
        """Send a peer the value at an address (without the prefix) now, and whenever it changes."""
        client = self._client(peer)
        client.listens.add(address)
        client.to_tell[address] = None
        self._is_waiting = True

    def ignore(self, peer: Peer, address: str) -> None:
        """End what `listen` began."""
        client = self._client(peer)
        client.listens.discard(address)
        client.to_tell.pop(address, None)

    def hears(self, peer: Peer) -> bool:
        """Whether a peer is sent changes of values."""
        client = self._clients.get(peer)
        return client is not None and (client.until > time.monotonic() or bool(client.listens))

    def forget(self, peer: Peer) -> None:
        """Drop a peer that has hung up."""
        self._clients.pop(peer, None)

    def complain(self, peer: Peer, address: str, reason: str | Callable[[], str]) -> None:
        """Send a peer an error, unless it has been sent many of late.

        A callable `reason` is called only where the error is sent.
        """
        client = self._client(peer)
        now = time.monotonic()
        if client.hushed_until > now:
            return
        client.complained = now
        if not client.errors.takes(now):
            self.errors_withheld += 1
            return
        self.errors_sent += 1
        reason = reason if isinstance(reason, str) else reason()
        peer.send(pack(f"{self.prefix}/error", shortened(address), shortened(reason)))

    # -- flushing ----------------------------------------------------------------------------

    @property
    def _is_watched(self) -> bool:
        now = time.monotonic()
        return any(client.subscribes(now) or client.listens for client in self._clients.values())

    def wait_s(self) -> float | None:
        """Seconds until the next flush; None where there is nothing to send."""
        if not self._is_waiting and not self._is_watched:
            return None
        return max(0.0, self._flushed + FLUSH_S - time.monotonic())

    def flush(self) -> None:
        """Send what is due, at most 60 times a second."""
        now = time.monotonic()
        if now - self._swept > SWEEP_S:
            self._swept = now
            self._forget_idle(forgiven_s=FORGIVEN_S)
        if now - self._flushed < FLUSH_S or not (self._is_waiting or self._is_watched):
            return
        self._flushed = now
        self._is_waiting = False
        values = self._values()
        changed = {address: None for address, v in values.items() if self._told.get(address) != v}
        self._told = values
        heard = {address + form for address in changed for form in ("", UNIT)}
        changed_status = self._changed_status(now)
        heard |= changed_status
        for client in self._clients.values():
            if client.until > now:
                client.to_tell.update({address + client.form: None for address in changed})
            if client.status_until > now:
                client.to_tell.update(dict.fromkeys(changed_status))
            client.to_tell.update(dict.fromkeys(client.listens & heard))
        self._tell()

    def _tell(self) -> None:
        """Send up to MOST_TOLD messages; clients that are left out come first the next time."""
        packets: dict[str, bytes] = {}
        left = MOST_TOLD
        for peer, client in list(self._clients.items()):  # sending may end one
            if not client.to_tell:
                continue
            if left <= 0:
                self._is_waiting = True
                break
            while client.to_tell and left > 0 and client.peer.takes_more:
                address = next(iter(client.to_tell))
                del client.to_tell[address]
                if address not in packets:
                    packets[address] = pack(self.prefix + address, self._value(address))
                client.peer.send(packets[address])
                left -= 1
            if client.to_tell:
                self._is_waiting = True
            if peer in self._clients:
                self._clients[peer] = self._clients.pop(peer)  # to the end of the row

    def _value(self, address: str) -> float | str:
        if address.startswith(PLACE):
            return self._told_status[address]
        return read(self._told, address)

    def _changed_status(self, now: float) -> set[str]:
        """Addresses of status values that changed, where a client wants them and it is time."""
        asked = {
            address
            for client in self._clients.values()
            for address in (*client.listens, *client.to_tell)
            if address.startswith(PLACE)
        }
        is_new = not asked <= self._told_status.keys()
        is_asked = asked or any(client.status_until > now for client in self._clients.values())
        if not is_asked or (now - self._looked < STATUS_S and not is_new):
            return set()
        self._looked = now
        told = self._told_status
        status = {PLACE + name: as_argument(value) for name, value in self._status().items()}
        self._told_status = status
        return {address for address, value in status.items() if told.get(address) != value}
