"""Receives OSC by UDP and TCP at one address, in one thread.

The UDP socket is emptied before packets are parsed, so that memory holds a burst and not the
kernel's small buffer. A sender that has too many waiting is muted until they are handled: what it
sends is dropped, on Linux by the kernel, before it takes room that others need. A connection is not
read again before its last packets are handled, so that its sender waits. On Linux the kernel stamps
packets on arrival and counts those it drops: a message has its true time however busy Python is.
"""

from __future__ import annotations

import contextlib
import logging
import math
import selectors
import socket
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from functools import lru_cache

from yehu_server.live.network import Address, Allowed, is_here
from yehu_server.live.osc.answering import (
    TO_A_HOST,
    TO_ALL_HOSTS,
    FramingError,
    Peer,
    TcpPeer,
    Traffic,
    UdpPeer,
    answer_bucket,
)
from yehu_server.live.osc.fair_queue import FairQueue
from yehu_server.live.osc.handler import OscHandler
from yehu_server.live.osc.open_sockets import DATAGRAM_BYTES, datagrams, mute, open_both, widen

log = logging.getLogger(__name__)

STREAM_BYTES = 1 << 16  # of a connection, read at a time
BEHIND_BYTES = 1 << 16  # waiting of one WebSocket, before it has to wait
MOST_ASKED = 64
READ_FOR_NS = 4_000_000  # before packets are handled in between
# A sender of datagrams is muted that has so much waiting, and with all of its host added so much or
# no more room. So a burst of some 7,000 short messages of one sender is taken.
MUTED_FROM_BYTES, MUTED_FROM_BOTH_BYTES = 256 << 10, 4 << 20
MOST_PEERS = 1024  # UDP peers that are kept, and hosts
ACCEPT_AGAIN_S = 1.0
MOST_CONNECTIONS, MOST_OF_A_HOST = 64, 32
# Where there are too many connections, a new one replaces one that has sent nothing for the first
# time, or never sent a packet in the second, unless it is sent changes of values.
QUIET_S, SPEAKS_WITHIN_S = 60.0, 10.0
WARN_AGAIN_S = 1.0
LONGEST_WAIT_S = 0.5


class OscPorts:
    """A UDP and a TCP port, and their thread; raises DeviceError where they cannot be opened."""

    def __init__(self, host: str, port: int, allowed: Allowed, handler: OscHandler) -> None:
        self.traffic = Traffic()
        self._allowed = allowed
        self._handler = handler
        self._queue: FairQueue[bytes | None] = FairQueue(self._handle)  # None: it hung up
        self._muted: set[UdpPeer] = set()  # not heard until nothing of them waits
        self._has_more = False  # whether the UDP socket was not emptied
        self._handled_ns = 0
        self._accept_from = math.inf  # monotonic s
        self._warned = 0.0  # monotonic s
        self._peer = lru_cache(MOST_PEERS)(self._new_peer)
        self._to_all = answer_bucket(TO_ALL_HOSTS)
        self._to_host = lru_cache(MOST_PEERS)(lambda _host: answer_bucket(TO_A_HOST))
        self._streams: set[TcpPeer] = set()
        self._selector = selectors.DefaultSelector()
        self._udp, self._tcp = open_both(host, port)
        self.port = int(self._udp.getsockname()[1])
        self.host = str(self._udp.getsockname()[0])
        self.traffic.buffer_bytes = widen(self._udp)
        self._datagrams = datagrams(self._udp)
        self._wake_here, self._wake_there = socket.socketpair()
        self._wake_there.setblocking(False)
        self._calls: deque[Callable[[], object]] = deque()
        for readable in (self._udp, self._tcp, self._wake_here):
            readable.setblocking(False)
            self._selector.register(readable, selectors.EVENT_READ)
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="OSC", daemon=True)

    def start(self) -> None:
        """Start to serve."""
        self._thread.start()

    def stop(self) -> None:
        """Stop serving and close all sockets."""
        self._ending = True
        self._wake_there.send(b"!")
        if self._thread.is_alive():
            self._thread.join()
        for peer in list(self._streams):
            peer.socket.close()
        for key in list(self._selector.get_map().values()):
            with contextlib.suppress(AttributeError):
                key.fileobj.close()  # type: ignore[union-attr]
        self._wake_there.close()
        self._selector.close()

    def receive(self, packet: bytes, peer: Peer) -> None:
        """Take a packet that a WebSocket received; any thread may call."""
        arrived_ns = time.monotonic_ns()

        def take_in() -> None:
            self.traffic.packets += 1
            self._queue.add(packet, peer, arrived_ns, len(packet), always=True)

        self.call_soon(take_in)

    def leave(self, peer: Peer) -> None:
        """Drop a WebSocket's peer once its packets are handled; any thread may call."""
        self.call_soon(lambda: self._queue.add(None, peer, 0, always=True))

    def call_soon(self, action: Callable[[], object]) -> None:
        """Call a function in the thread that serves; any thread may call."""
        self._calls.append(action)
        self._wake()

    def _wake(self) -> None:
        with contextlib.suppress(OSError):  # full: the thread will wake anyway
            self._wake_there.send(b"!")

    def _run(self) -> None:
        while not self._ending:
            try:
                self._turn()
            except Exception:  # a defect of the server must not end the thread
                self.traffic.failures += 1
                log.exception("OSC: a message could not be handled")

    def _turn(self) -> None:
        """Read the sockets, handle packets for a while, and do what is due."""
        handler_wait_s = self._handler.wait_s()
        wait = LONGEST_WAIT_S if handler_wait_s is None else min(handler_wait_s, LONGEST_WAIT_S)
        self._has_more = False
        for key, events in self._selector.select(0.0 if self._queue else wait):
            self._serve(key, events)
        now_ns = time.monotonic_ns()
        # Empty the socket's small buffer first: the queue has more room.
        if not self._has_more or now_ns - self._handled_ns > READ_FOR_NS:
            self._queue.work()
            self._handled_ns = time.monotonic_ns()
        self._mute({peer for peer in self._muted if self._queue.bytes_of(peer)})
        self._handler.tick()
        now = time.monotonic()
        if now > self._accept_from:
            self._accept_from = math.inf
            self._selector.register(self._tcp, selectors.EVENT_READ)

    def is_behind(self, peer: Peer) -> bool:
        """Whether a WebSocket's peer should wait before it sends more; any thread may call."""
        return len(self._calls) >= MOST_ASKED or self._queue.bytes_of(peer) >= BEHIND_BYTES

    def _handle(self, data: bytes | None, peer: Peer, arrived_ns: int) -> Iterator[None]:
        """The steps that handle a packet, or a part of a stream, or that its peer hung up."""
        if data is None:
            return self._end(peer)
        if isinstance(peer, TcpPeer):
            return self._handle_stream(data, peer, arrived_ns)
        return self._handler.handle(data, peer, arrived_ns)

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
            self._warn(f"{peer.name}: {error}; connection closed")
            self.drain_and_close(peer)
        finally:
            peer.has_pending_packets = False

    def _warn(self, what: str) -> None:
        """Log what a peer did wrong, as a warning once a second at most."""
        now = time.monotonic()
        level = logging.WARNING if now > self._warned + WARN_AGAIN_S else logging.DEBUG
        log.log(level, "OSC: %s", what)
        self._warned = now

    def _end(self, peer: Peer) -> Iterator[None]:
        """Drop a peer that hung up, once all of its packets are handled."""
        if isinstance(peer, TcpPeer):
            peer.finish()
        self._handler.clients.forget(peer)
        yield

    def _serve(self, key: selectors.SelectorKey, events: int) -> None:
        if key.fileobj is self._udp:
            self._read_datagrams()
        elif key.fileobj is self._tcp:
            self._accept()
        elif key.fileobj is self._wake_here:
            self._run_calls()
        elif isinstance(key.data, TcpPeer):
            if events & selectors.EVENT_WRITE:
                key.data.flush()
            if events & selectors.EVENT_READ and key.data.reads:
                self._read_stream(key.data)

    def _run_calls(self) -> None:
        with contextlib.suppress(BlockingIOError):
            self._wake_here.recv(STREAM_BYTES)
        for _ in range(len(self._calls)):  # what is added meanwhile waits for the next turn
            self._calls.popleft()()
        if self._calls:
            self._wake()

    def _read_datagrams(self) -> None:
        """Read some of the waiting datagrams."""
        found, self._has_more = self._datagrams.read()
        self.traffic.kernel_drops = self._datagrams.dropped
        muted = set(self._muted)
        for packet, address, arrived_ns in found:
            is_own = address[1] == self.port and is_here(address[0])  # subscribed to itself
            if is_own or address[0] not in self._allowed:
                self.traffic.refused += 1
                continue
            self.traffic.packets += 1
            peer, size = self._peer(address), len(packet)
            has_much = self._queue.bytes_of(peer) > MUTED_FROM_BYTES
            is_too_much = has_much and self._queue.bytes_of_both(peer) > MUTED_FROM_BOTH_BYTES
            is_heard = size <= DATAGRAM_BYTES and not is_too_much and peer not in muted
            if not (is_heard and self._queue.add(packet, peer, arrived_ns, size)):
                self.traffic.excess += 1
                if has_much:
                    muted.add(peer)
        self._mute(muted)

    def _mute(self, peers: set[UdpPeer]) -> None:
        """Drop the datagrams of some peers, and of no others."""
        if peers != self._muted:
            mute(self._udp, (peer.address for peer in peers))
            self._muted = peers

    def _new_peer(self, address: Address) -> UdpPeer:
        host = address[0]
        buckets = [answer_bucket()] if is_here(host) else [self._to_host(host), self._to_all]
        return UdpPeer(self._udp, address, self.traffic, buckets)

    # -- TCP -----------------------------------------------------------------------------------

    def _accept(self) -> None:
        try:
            connection, address = self._tcp.accept()
        except OSError:  # too many open files: try again later
            self._selector.unregister(self._tcp)
            self._accept_from = time.monotonic() + ACCEPT_AGAIN_S
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
        self._selector.register(connection, selectors.EVENT_READ, peer)

    def _has_place(self, host: str) -> bool:
        """Whether there is room for one more connection; ends a silent one for it."""
        among = [peer for peer in self._streams if not peer.is_finished]
        of_host = [peer for peer in among if peer.host == host]
        if len(of_host) >= MOST_OF_A_HOST:
            among = of_host
        elif len(among) < MOST_CONNECTIONS:
            return True
        those = filter(self._is_silent, among)
        silent = min(those, key=lambda one: one.last_packet_s, default=None)
        if silent is not None:
            self._warn(f"{silent.name}: closed for another connection, as it was silent for long")
            silent.cut_off()
        return silent is not None

    def _is_silent(self, peer: TcpPeer) -> bool:
        """Whether a connection has sent nothing for too long."""
        longest_s = QUIET_S if peer.has_sent_packet else SPEAKS_WITHIN_S
        quiet_s = time.monotonic() - peer.last_packet_s
        is_quiet = quiet_s > longest_s and not peer.has_pending_packets
        return is_quiet and not self._handler.clients.is_subscribed(peer)

    def _read_stream(self, peer: TcpPeer) -> None:
        if peer.has_pending_packets:  # the sender waits; nothing is lost
            return
        try:
            data = peer.socket.recv(STREAM_BYTES)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if data:
            peer.has_pending_packets = True
            self._queue.add(data, peer, time.monotonic_ns(), len(data), always=True)
        else:
            self.drain_and_close(peer)

    def drain_and_close(self, peer: TcpPeer) -> None:
        """Read no more from a peer; its packets are still handled and answered."""
        peer.reads = False
        self.watch(peer)
        self._queue.add(None, peer, 0, always=True)

    def watch(self, peer: TcpPeer) -> None:
        """Let the selector wait for the peer's events; close the connection if it has none."""
        with contextlib.suppress(KeyError, ValueError):
            self._selector.unregister(peer.socket)
        if peer.events:
            self._selector.register(peer.socket, peer.events, peer)
        elif peer.is_finished and peer.socket.fileno() >= 0:
            peer.socket.close()
            self._streams.discard(peer)
            self.traffic.connections -= 1
