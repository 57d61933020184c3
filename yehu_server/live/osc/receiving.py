"""Receives OSC by UDP and TCP at one address, in one thread.

Datagrams are read before they are parsed, so that memory holds a burst and not the kernel's small
buffer; one whose sender has too much waiting is dropped. A connection is not read again before its
last packets are handled, so that its sender waits. On Linux the kernel stamps packets on arrival
and counts those it drops: a message has its true time however busy Python is.
"""

import contextlib
import logging
import selectors
import socket
import threading
import time
from collections.abc import Iterator, Sequence
from functools import lru_cache, partial
from weakref import WeakValueDictionary

from yehu_server.live import traffic_limits as limits
from yehu_server.live.network import Address, Allowed, is_here
from yehu_server.live.osc.handler import OscHandler
from yehu_server.live.osc.listening_sockets import open_both
from yehu_server.live.osc.peers import FramingError, Peer, TcpPeer, Traffic, UdpPeer, answer_bucket
from yehu_server.live.osc.work_queue import DONE, SLICE_NS, Calls, WorkQueue
from yehu_server.system import clocks
from yehu_server.system.sockets import prepare, receive
from yehu_server.util.token_bucket import TokenBucket

log = logging.getLogger(__name__)

AT_ONCE = 512  # datagrams that are read before others are handled
ACCEPT_AGAIN_S = 1.0


class OscPorts:
    """A UDP and a TCP port, and their thread; raises DeviceError where they cannot be opened."""

    def __init__(
        self,
        host: str,
        port: int,
        allowed: Allowed,
        handler: OscHandler,
        calls: Calls | None = None,
    ) -> None:
        self._udp, self._tcp = open_both(host, port)
        self.traffic = Traffic()
        self._allowed = allowed
        self._handler = handler
        self._queue = WorkQueue()
        self._calls = Calls() if calls is None else calls
        self.call_soon = self._calls.soon
        self._accepts_again: float | None = None  # monotonic s; None: it accepts
        self._peers: WeakValueDictionary[Address, UdpPeer] = WeakValueDictionary()
        self._peer = lru_cache(limits.PEERS)(self._peer_of)
        self._to_all = answer_bucket(limits.ANSWERED_TO_ALL_HOSTS)
        self._to_host = lru_cache(limits.PEERS)(
            lambda _host: answer_bucket(limits.ANSWERED_TO_A_HOST)
        )
        self._streams: set[TcpPeer] = set()
        self._selector = selectors.DefaultSelector()
        self.port = int(self._udp.getsockname()[1])
        self.host = str(self._udp.getsockname()[0])
        self.traffic.buffer_bytes = prepare(self._udp, limits.SOCKET_BUFFER)
        for opened, read in ((self._udp, self._read_datagrams), (self._tcp, self._accept)):
            opened.setblocking(False)
            self._selector.register(opened, selectors.EVENT_READ, read)
        self._selector.register(self._calls, selectors.EVENT_READ, lambda _: self._calls.run())
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="OSC", daemon=True)

    def start(self) -> None:
        """Start to serve."""
        self._thread.start()

    def stop(self) -> None:
        """Stop serving and close all sockets."""
        self._ending = True
        self._calls.wake()
        if self._thread.is_alive():
            self._thread.join()
        for opened in (self._udp, self._tcp, self._calls, self._selector):
            opened.close()
        for peer in self._streams:
            peer.socket.close()

    def receive(self, packet: bytes, peer: Peer) -> None:
        """Take a packet that a WebSocket received; any thread may call."""
        arrived_ns = clocks.monotonic_ns()

        def take_in() -> None:
            self.traffic.packets += 1
            steps = self._handler.handle(packet, peer, arrived_ns)
            self._queue.add(steps, peer, len(packet), always=True)

        self.call_soon(take_in)

    def leave(self, peer: Peer) -> None:
        """Drop a WebSocket's peer once its packets are handled; any thread may call."""
        self.call_soon(lambda: self._queue.add(self._end(peer), peer, always=True))

    def is_behind(self, peer: Peer) -> bool:
        """Whether a WebSocket's peer should wait before it sends more; any thread may call."""
        too_many = len(self._calls) >= limits.CALLS_WAITING
        return too_many or self._queue.held(peer) >= limits.WEB_SOCKET_WAITING

    def _run(self) -> None:
        """Read the sockets, handle packets for a while, and do what is due, until the end."""
        while not self._ending:
            try:
                wait_s = 0.0 if self._queue else self._handler.wait_s()
                for key, events in self._selector.select(wait_s):
                    key.data(events)
                for steps, peer, size in self._handler.due():
                    self._queue.add(steps, peer, size, always=True)
                self._queue.work()
                self._handler.clients.flush()
                self._accept_again()
            except Exception:  # a defect of the server must not end the thread
                self.traffic.failures += 1
                log.exception("OSC: a message could not be handled")

    def _end(self, peer: Peer) -> Iterator[None]:
        """Drop a peer that hung up, once all of its packets are handled."""
        if isinstance(peer, TcpPeer):
            peer.finish()
        self._handler.clients.forget(peer)
        yield

    # -- UDP -----------------------------------------------------------------------------------

    def _read_datagrams(self, _events: int) -> None:
        """Read some of the waiting datagrams; handle them while nobody's wait, else queue them."""
        until_ns = clocks.monotonic_ns() + SLICE_NS
        to_monotonic_ns = clocks.monotonic_ns() - time.time_ns()
        for _ in range(AT_ONCE):
            try:
                datagram = receive(self._udp, limits.DATAGRAM)
            except BlockingIOError:
                return
            except OSError as error:  # an earlier answer was refused at its port
                log.debug("OSC: %s", error)
                continue
            now_ns, (packet, address) = clocks.monotonic_ns(), datagram[:2]
            arrived_ns = now_ns
            if datagram.stamp_ns:
                arrived_ns = min(datagram.stamp_ns + to_monotonic_ns, now_ns)
            self.traffic.kernel_drops = datagram.drops or self.traffic.kernel_drops
            peer = self._peer(address)
            if peer is None:
                self.traffic.refused += 1
                continue
            self.traffic.packets += 1
            if not datagram.is_whole:
                self.traffic.excess += 1
                self._handler.refuse_long(peer)
                continue
            steps = self._handler.handle(packet, peer, arrived_ns)
            is_next = not self._queue and now_ns < until_ns
            if is_next and next(steps, DONE) is DONE:
                continue
            if not self._queue.add(steps, peer, len(packet)):
                self.traffic.excess += 1

    def _peer_of(self, address: Address) -> UdpPeer | None:
        """The peer of an address; None where it may not send, or is this port itself."""
        host, port = address[:2]
        is_own = port == self.port and is_here(host)  # subscribed to itself
        if is_own or host not in self._allowed:
            return None
        buckets = [answer_bucket()] if is_here(host) else [self._to_host(host), self._to_all]
        return self._peer_at(address, buckets)

    def _peer_at(self, address: Address, buckets: Sequence[TokenBucket]) -> UdpPeer:
        """The peer of an address, as long as anything holds it; else a new one."""
        new = UdpPeer(self._udp, address, self.traffic, buckets, self._peer_at)
        return self._peers.setdefault(address, new)

    # -- TCP -----------------------------------------------------------------------------------

    def _accept(self, _events: int) -> None:
        try:
            connection, address = self._tcp.accept()
        except OSError:  # too many open files: try again later
            self._selector.unregister(self._tcp)
            self._accepts_again = time.monotonic() + ACCEPT_AGAIN_S
            return
        if address[0] not in self._allowed or not self._has_place(address[0]):
            self.traffic.refused += 1
            connection.close()
            return
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.traffic.connections += 1
        peer = TcpPeer(connection, address, self.traffic, self.watch, self.drain_and_close)
        self._streams.add(peer)
        self.watch(peer)

    def _accept_again(self) -> None:
        if self._accepts_again is not None and time.monotonic() > self._accepts_again:
            self._accepts_again = None
            self._selector.register(self._tcp, selectors.EVENT_READ, self._accept)

    def _has_place(self, host: str) -> bool:
        """Whether there is room for one more connection; ends a silent one for it."""
        among = [peer for peer in self._streams if not peer.is_finished]
        of_host = [peer for peer in among if peer.host == host]
        if len(of_host) >= limits.CONNECTIONS_A_HOST:
            among = of_host
        elif len(among) < limits.CONNECTIONS:
            return True
        those = filter(self._is_silent, among)
        silent = min(those, key=lambda one: one.last_packet_s, default=None)
        if silent is not None:
            log.warning(
                "OSC: %s: closed for another connection, being silent for long", silent.name
            )
            silent.cut_off()
        return silent is not None

    def _is_silent(self, peer: TcpPeer) -> bool:
        """Whether a connection has sent nothing for too long."""
        longest_s = limits.QUIET_S if peer.has_sent_packet else limits.FIRST_PACKET_S
        is_quiet = time.monotonic() - peer.last_packet_s > longest_s
        is_idle = is_quiet and not self._queue.held(peer)
        return is_idle and not self._handler.clients.is_subscribed(peer)

    def _serve_stream(self, peer: TcpPeer, events: int) -> None:
        if events & selectors.EVENT_WRITE:
            peer.flush()
        is_waiting = not peer.reads or self._queue.held(peer)  # the sender waits; nothing is lost
        if is_waiting or not events & selectors.EVENT_READ:
            return
        try:
            data = peer.socket.recv(limits.STREAM_READ)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if data:
            steps = self._handle_stream(data, peer, clocks.monotonic_ns())
            self._queue.add(steps, peer, len(data), always=True)
        else:
            self.drain_and_close(peer)

    def _handle_stream(self, data: bytes, peer: TcpPeer, arrived_ns: int) -> Iterator[None]:
        try:
            for packet in peer.framing.packets(data):
                self.traffic.packets += 1
                peer.has_sent_packet = True
                peer.last_packet_s = time.monotonic()
                try:
                    yield from self._handler.handle(packet, peer, arrived_ns)
                except Exception:  # a defect of the server; later packets are handled
                    self.traffic.failures += 1
                    log.exception("OSC: a message could not be handled")
                yield
        except FramingError as error:
            self.traffic.refused += 1
            log.warning("OSC: %s: %s; connection closed", peer.name, error)
            self.drain_and_close(peer)

    def drain_and_close(self, peer: TcpPeer) -> None:
        """Read no more from a peer; its packets are still handled and answered."""
        peer.reads = False
        self.watch(peer)
        self._queue.add(self._end(peer), peer, always=True)

    def watch(self, peer: TcpPeer) -> None:
        """Let the selector wait for the peer's events; close the connection if it has none."""
        with contextlib.suppress(KeyError, ValueError):
            self._selector.unregister(peer.socket)
        if peer.events:
            serve = partial(self._serve_stream, peer)
            self._selector.register(peer.socket, peer.events, serve)
        elif peer.is_finished and peer.socket.fileno() >= 0:
            peer.socket.close()
            self._streams.discard(peer)
            self.traffic.connections -= 1
