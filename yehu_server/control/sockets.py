"""Sockets for OSC: UDP and TCP at one address, read by one thread, fast, and parsed later.

The UDP socket is emptied before anything is parsed, so that a burst is kept by memory and not by
the kernel's small buffer; of a sender who finds no room in memory what is over is dropped, and
counted. A connection is not read again before what it said is handled: its sender waits. On Linux
the kernel stamps what arrives, and tells what it dropped: a message is as early as it truly was,
however busy Python is.
"""

from __future__ import annotations

import contextlib
import logging
import math
import selectors
import socket
import struct
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from typing import Protocol

from yehu_server.control.addresses import Address, Allowed, is_here
from yehu_server.control.backlog import Backlog
from yehu_server.control.framing import FramingError
from yehu_server.control.listening import (
    DATAGRAM_BYTES,
    SO_RXQ_OVFL,
    SO_TIMESTAMPNS,
    open_both,
    widen,
)
from yehu_server.control.peers import Peer, TcpPeer, Traffic, UdpPeer

log = logging.getLogger(__name__)

STREAM_BYTES = 1 << 16  # read at a time
BEHIND_BYTES = 1 << 16  # of a peer that came another way, before it waits
MOST_ASKED = 64
READ_AT_ONCE = 128  # datagrams, before we look for what is due
READ_FOR_NS = 4_000_000  # before we handle some of it
MOST_PEERS = 1024  # whose addresses we keep
ACCEPT_AGAIN_S = 1.0
MOST_CONNECTIONS, MOST_OF_A_HOST = 64, 32
# A connection that has said nothing for so long, or nothing since it was made, gives its place to
# who comes where all are taken, unless it is still told of changes.
QUIET_S, SPEAKS_WITHIN_S = 60.0, 10.0
WARN_AGAIN_S = 1.0
LONGEST_WAIT_S = 0.5


class Handler(Protocol):
    """What is done with packets; called from the socket's thread."""

    def handle(self, packet: bytes, peer: Peer, arrived_ns: int) -> Iterator[None]:
        """Act on one packet, in steps between which others may be handled."""

    def tick(self) -> None:
        """Do what is due."""

    def wait_s(self) -> float | None:
        """Seconds until `tick` has something to do."""

    def hears(self, peer: Peer) -> bool:
        """Whether a peer is still to be told of changes."""

    def gone(self, peer: Peer) -> None:
        """A peer has hung up."""


class OscPorts:
    """One UDP and one TCP port, and the thread that serves them.

    Errors: DeviceError where the address is taken or not this machine's.
    """

    def __init__(self, host: str, port: int, allowed: Allowed, handler: Handler) -> None:
        self.traffic = Traffic()
        self._allowed = allowed
        self._handler = handler
        self._backlog: Backlog[bytes] = Backlog(self._handle, self._end)
        self._has_more = False  # in the socket, as far as we know
        self._handled_ns = 0
        self._accept_from = math.inf  # monotonic s
        self._warned = 0.0  # monotonic s
        self._peers: dict[Address, UdpPeer] = {}
        self._streams: set[TcpPeer] = set()
        self._selector = selectors.DefaultSelector()
        self._udp, self._tcp = open_both(host, port)
        self.port = int(self._udp.getsockname()[1])
        self.host = str(self._udp.getsockname()[0])
        self.traffic.buffer_bytes = widen(self._udp)
        self._wake_here, self._wake_there = socket.socketpair()
        self._wake_there.setblocking(False)
        self._asked: deque[Callable[[], object]] = deque()
        for readable in (self._udp, self._tcp, self._wake_here):
            readable.setblocking(False)
            self._selector.register(readable, selectors.EVENT_READ)
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="OSC", daemon=True)

    def start(self) -> None:
        """Begin to serve."""
        self._thread.start()

    def stop(self) -> None:
        """Stop serving and close."""
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
        """Take in a packet that came another way; any thread may call."""
        arrived_ns = time.monotonic_ns()

        def take_in() -> None:
            self.traffic.packets += 1
            self._backlog.add(packet, peer, arrived_ns, len(packet), is_due=True)

        self.call_soon(take_in)

    def leave(self, peer: Peer) -> None:
        """A peer who came another way is gone, once what it said is done; any thread may call."""
        self.call_soon(lambda: self._backlog.add(None, peer, 0))

    def call_soon(self, action: Callable[[], object]) -> None:
        """Let the thread that serves do something; any thread may call."""
        self._asked.append(action)
        self._wake()

    def _wake(self) -> None:
        with contextlib.suppress(OSError):  # it is full, so that the thread will wake anyway
            self._wake_there.send(b"!")

    def _run(self) -> None:
        while not self._ending:
            try:
                self._turn()
            except Exception:  # a defect of ours must not silence the instrument's only ear
                self.traffic.failures += 1
                log.exception("OSC: a message could not be handled")

    def _turn(self) -> None:
        """Read what has come, handle for a while, and do what is due."""
        asked = self._handler.wait_s()
        wait = LONGEST_WAIT_S if asked is None else min(asked, LONGEST_WAIT_S)
        self._has_more = False
        for key, events in self._selector.select(0.0 if self._backlog else wait):
            self._serve(key, events)
        now_ns = time.monotonic_ns()
        # First the socket's small buffer, then the backlog's large one.
        if not self._has_more or now_ns - self._handled_ns > READ_FOR_NS:
            self._backlog.work()
            self._handled_ns = time.monotonic_ns()
        self._handler.tick()
        now = time.monotonic()
        if now > self._accept_from:
            self._accept_from = math.inf
            self._selector.register(self._tcp, selectors.EVENT_READ)

    def is_behind(self, peer: Peer) -> bool:
        """Whether a peer that comes another way has to wait; any thread may ask."""
        return len(self._asked) >= MOST_ASKED or self._backlog.bytes_of(peer) >= BEHIND_BYTES

    def _handle(self, data: bytes, peer: Peer, arrived_ns: int) -> Iterator[None]:
        """The steps of a packet, or of a part of a stream."""
        if isinstance(peer, TcpPeer):
            return self._handle_stream(data, peer, arrived_ns)
        return self._handler.handle(data, peer, arrived_ns)

    def _handle_stream(self, data: bytes, peer: TcpPeer, arrived_ns: int) -> Iterator[None]:
        try:
            for packet in peer.framing.packets(data):
                self.traffic.packets += 1
                peer.has_spoken = True
                peer.heard_s = time.monotonic()
                try:
                    yield from self._handler.handle(packet, peer, arrived_ns)
                except Exception:  # of ours: what comes after it is heard
                    self.traffic.failures += 1
                    log.exception("OSC: a message could not be handled")
                yield
        except FramingError as error:
            self.traffic.refused += 1
            self._warn(f"{peer.name}: {error}; connection closed")
            self.hear_out(peer)
        finally:
            peer.is_being_heard = False

    def _warn(self, what: str) -> None:
        """Say what strangers do; those who do it often do not fill the log."""
        now = time.monotonic()
        log.log(
            logging.WARNING if now > self._warned + WARN_AGAIN_S else logging.DEBUG, "OSC: %s", what
        )
        self._warned = now

    def _end(self, peer: Peer) -> None:
        """A peer has hung up, and all it said is done."""
        if isinstance(peer, TcpPeer):
            peer.finish()
        self._handler.gone(peer)

    def _serve(self, key: selectors.SelectorKey, events: int) -> None:
        if key.fileobj is self._udp:
            self._read_datagrams()
        elif key.fileobj is self._tcp:
            self._accept()
        elif key.fileobj is self._wake_here:
            self._do_asked()
        elif isinstance(key.data, TcpPeer):
            if events & selectors.EVENT_WRITE:
                key.data.flush()
            if events & selectors.EVENT_READ and key.data.reads:
                self._read_stream(key.data)

    def _do_asked(self) -> None:
        with contextlib.suppress(BlockingIOError):
            self._wake_here.recv(STREAM_BYTES)
        for _ in range(len(self._asked)):  # of what is asked meanwhile the next turn hears
            self._asked.popleft()()
        if self._asked:
            self._wake()

    def _read_datagrams(self) -> None:
        """Empty the socket, as far as one turn goes."""
        offset_ns = time.time_ns() - time.monotonic_ns()
        for _ in range(READ_AT_ONCE):
            try:
                packet, extras, _, address = self._udp.recvmsg(DATAGRAM_BYTES + 1, 128)
            except BlockingIOError:
                return
            except OSError as error:  # of an earlier answer that nobody took
                log.debug("OSC: %s", error)
                continue
            arrived_ns = time.monotonic_ns() if not extras else 0
            for _, kind, data in extras:
                if kind == SO_TIMESTAMPNS:
                    seconds, ns = struct.unpack("qq", data[:16])
                    arrived_ns = min(seconds * 10**9 + ns - offset_ns, time.monotonic_ns())
                elif kind == SO_RXQ_OVFL:
                    self.traffic.kernel_drops = struct.unpack("I", data[:4])[0]
            if address[1] == self.port and is_here(address[0]):
                self.traffic.refused += 1  # our own word, by way of a subscription to ourselves
            elif address[0] in self._allowed:
                self._enqueue(packet, self._peer(address), arrived_ns)
            else:
                self.traffic.refused += 1
        self._has_more = True

    def _peer(self, address: Address) -> UdpPeer:
        peer = self._peers.get(address)
        if peer is None:
            if len(self._peers) >= MOST_PEERS:
                del self._peers[next(iter(self._peers))]
            peer = self._peers[address] = UdpPeer(self._udp, address, self.traffic)
        return peer

    def _enqueue(self, packet: bytes, peer: Peer, arrived_ns: int) -> None:
        self.traffic.packets += 1
        is_short = len(packet) <= DATAGRAM_BYTES  # where the kernel did not see to it
        if not (is_short and self._backlog.add(packet, peer, arrived_ns, len(packet))):
            self.traffic.excess += 1

    # -- TCP -----------------------------------------------------------------------------------

    def _accept(self) -> None:
        try:
            connection, address = self._tcp.accept()
        except OSError:  # too many open files: try again when some may be closed
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
        peer = TcpPeer(connection, address, self.traffic, self.watch, self.hear_out)
        self._streams.add(peer)
        self._selector.register(connection, selectors.EVENT_READ, peer)

    def _has_place(self, host: str) -> bool:
        """Whether there is room for one more connection, if need be in place of a silent one."""
        open_ = [peer for peer in self._streams if not peer.is_finished]
        of_host = [peer for peer in open_ if peer.host == host]
        if len(of_host) >= MOST_OF_A_HOST:
            silent = self._longest_silent(of_host)
        elif len(open_) >= MOST_CONNECTIONS:
            silent = self._longest_silent(open_)
        else:
            return True
        if silent is not None:
            self._warn(f"{silent.name}: silent for long; its place is another's")
            silent.cut_off()
        return silent is not None

    def _longest_silent(self, peers: list[TcpPeer]) -> TcpPeer | None:
        """Who has said nothing for longest, if it was too long."""
        now = time.monotonic()
        silent = [
            peer
            for peer in peers
            if now - peer.heard_s > (QUIET_S if peer.has_spoken else SPEAKS_WITHIN_S)
            and not peer.is_being_heard
            and not self._handler.hears(peer)
        ]
        return min(silent, key=lambda peer: peer.heard_s, default=None)

    def _read_stream(self, peer: TcpPeer) -> None:
        if peer.is_being_heard:  # the sender waits, and nothing is lost
            return
        try:
            data = peer.socket.recv(STREAM_BYTES)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if data:
            peer.is_being_heard = True
            self._backlog.add(data, peer, time.monotonic_ns(), len(data), is_due=True)
        else:
            self.hear_out(peer)

    def hear_out(self, peer: TcpPeer) -> None:
        """Read no more from a peer; what it has said is still acted on and answered."""
        peer.reads = False
        self.watch(peer)
        self._backlog.add(None, peer, 0)

    def watch(self, peer: TcpPeer) -> None:
        """Wait for what the peer has still to say or to take; close when there is neither."""
        with contextlib.suppress(KeyError, ValueError):
            self._selector.unregister(peer.socket)
        if peer.events:
            self._selector.register(peer.socket, peer.events, peer)
        elif peer.is_finished and peer.socket.fileno() >= 0:
            peer.socket.close()
            self._streams.discard(peer)
            self.traffic.connections -= 1
