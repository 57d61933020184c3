"""Sockets: no packet is lost without need, every loss is counted, and only some may send."""

import contextlib
import logging
import socket
import struct
import sys
import threading
import time
from collections.abc import Iterator

import pytest

from yehu_server.errors import DeviceError
from yehu_server.live import traffic_limits as limits
from yehu_server.live.network import Allowed
from yehu_server.live.osc import receiving
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.receiving import OscPorts
from yehu_server.live.osc.schedule import AHEAD_S
from yehu_server.live.osc.work_queue import WorkQueue

HOST = "127.0.0.1"
BURST = 20_000
PACKET_BYTES = 768  # of a small packet, as Linux accounts for it in the buffer
SETTLE_S = 0.05

on_linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux counts them")


class Collector:
    """Keeps the packets that come, unless it is held up."""

    def __init__(self) -> None:
        self.packets: list[tuple[bytes, object, int]] = []
        self.answer: bytes | None = None
        self.gone_peers: list[object] = []
        self.refused: list[object] = []
        self.go_on = threading.Event()
        self.go_on.set()
        self.is_idle = True  # whether it is not held up
        self.is_slow = False  # then it yields to others while it is held up
        self.hearing: list[object] = []
        self.ticks = 0
        self.takes_s = 0.0
        self.since_tick = [0]  # packets handled since each tick
        self.ticked_s: list[float] = []  # of the thread's own time

    def handle(self, packet: bytes, peer, arrived_ns: int) -> Iterator[None]:
        while self.is_slow and not self.go_on.is_set():
            yield
        self.is_idle = False
        self.go_on.wait()
        self.is_idle = True
        yield
        self.packets.append((packet, peer, arrived_ns))
        self.since_tick[-1] += 1
        if self.takes_s:
            time.sleep(self.takes_s)
        if packet == b"raise":
            raise RuntimeError("as asked")
        if self.answer is not None:
            peer.send(self.answer)

    def refuse_long(self, peer) -> None:
        self.refused.append(peer)

    def due(self) -> list[tuple[Iterator[None], object, int]]:
        return []

    def flush(self) -> None:
        self.ticks += 1
        self.since_tick.append(0)
        self.ticked_s.append(time.thread_time())

    def wait_s(self) -> float:
        return 0.5

    def is_subscribed(self, peer) -> bool:
        return peer in self.hearing

    @property
    def clients(self):
        return self

    def forget(self, peer) -> None:
        self.gone_peers.append(peer)

    @property
    def bodies(self) -> list[bytes]:
        return [packet for packet, _, _ in self.packets]


@pytest.fixture
def keeper():
    return Collector()


@pytest.fixture
def listen(keeper):
    """Listen with the keeper behind, anywhere on this machine."""
    with contextlib.ExitStack() as ending:

        def listen(*, host: str = HOST, allowed: Allowed | None = None, start: bool = True):
            ports = OscPorts(host, 0, allowed or Allowed(), keeper)
            ending.callback(ports.stop)
            ending.callback(keeper.go_on.set)
            if start:
                ports.start()
            return ports

        yield listen


@pytest.fixture
def client(kit):
    with contextlib.ExitStack() as ending:

        def client(ports, kind: str = "udp"):
            if kind == "udp":
                made = kit.Client(ports.port, ports.host)
            else:
                made = kit.Stream(ports.port, slip=kind == "slip", host=ports.host)
            ending.callback(made.close)
            return made

        yield client


def numbered(count: int) -> list[bytes]:
    return [pack("/yehu/bow/force", number) for number in range(count)]


# ---------------------------------------------------------------- UDP


def send_all(client, packets) -> None:
    for packet in packets:
        client.take(packet)


@pytest.mark.parametrize("hindrance", ["none", "busy", "held up", "not started"])
def test_a_burst_that_buffer_and_queue_hold_arrives_whole(
    listen, client, keeper, until, busy, hindrance
):
    ports = listen(start=hindrance != "not started")
    holds = limits.WAITING // 2 // (len(numbered(1)[0]) + limits.OVERHEAD)
    packets = numbered(min(holds, ports.traffic.buffer_bytes // (2 * PACKET_BYTES)))
    if hindrance == "held up":
        keeper.go_on.clear()
    with busy() if hindrance == "busy" else contextlib.nullcontext():
        send_all(client(ports), packets)
        if hindrance == "not started":
            ports.start()
        keeper.go_on.set()
        until(lambda: len(keeper.packets) >= len(packets), "all packets")
    assert keeper.bodies == packets
    assert ports.traffic.packets == len(packets)
    assert ports.traffic.kernel_drops == 0


@pytest.mark.parametrize("slice_ns", [0, 1 << 60])
def test_what_comes_while_nothing_waits_is_handled_as_it_is_read_for_a_slice_of_time(
    listen, client, keeper, monkeypatch, slice_ns
):
    """Then the rest is read first, so that the kernel has room."""
    order, read = [], receiving.receive

    def note_read(*of):
        datagram = read(*of)
        order.append("read")
        return datagram

    def note_handled(*_of):
        order.append("handled")
        yield from ()

    monkeypatch.setattr(receiving, "SLICE_NS", slice_ns)
    monkeypatch.setattr(receiving, "receive", note_read)
    monkeypatch.setattr(keeper, "handle", note_handled)
    ports = listen(start=False)
    send_all(client(ports), numbered(3))
    ports._read_datagrams(0)
    ports._queue.work()
    assert order == (["read", "handled"] * 3 if slice_ns else ["read"] * 3 + ["handled"] * 3)


def test_a_port_is_one_peer_however_many_others_send(listen, monkeypatch):
    monkeypatch.setattr(limits, "PEERS", 1)
    ports = listen(start=False)
    one, other = ports._peer((HOST, 1)), ports._peer((HOST, 2))
    assert ports._peer((HOST, 1)) is one is not other
    assert other.at(1) is one


@on_linux
def test_what_the_kernel_drops_is_counted(listen, client, keeper, until):
    ports = listen(start=False)
    ports._udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8192)
    sender = client(ports)
    send_all(sender, numbered(1000))
    ports.start()
    until(lambda: keeper.packets, "a packet")
    time.sleep(SETTLE_S)
    sender.take(b"the last")  # the kernel reports drops with the next packet
    until(lambda: b"the last" in keeper.bodies, "the last packet")
    assert ports.traffic.kernel_drops > 0
    assert ports.traffic.packets + ports.traffic.kernel_drops == 1001


def test_longer_datagrams_are_refused_and_counted(listen, client, keeper, until):
    ports = listen()
    sender = client(ports)
    for size in (limits.DATAGRAM + 1, 65507):
        sender.take(b"x" * size)
    for size in (4, limits.DATAGRAM):
        sender.take(b"/" * size)
    until(lambda: len(keeper.packets) == 2, "the short ones")
    assert keeper.bodies == [b"/" * 4, b"/" * limits.DATAGRAM]
    assert ports.traffic.excess == len(keeper.refused) == 2


@on_linux
def test_a_packet_has_the_time_of_its_arrival_and_not_of_reading(listen, client, keeper, until):
    ports = listen()
    sender = client(ports)
    for _ in range(100):  # the kernel begins to stamp some time after it was asked to
        keeper.packets.clear()
        keeper.go_on.clear()
        sender.take(b"holds")  # the thread
        until(lambda: not keeper.is_idle, "it to be handled")
        before = time.monotonic_ns()
        sender.take(b"late")
        after = time.monotonic_ns()
        time.sleep(0.02)
        keeper.go_on.set()
        until(lambda: len(keeper.packets) == 2, "both")
        arrived_ns = keeper.packets[1][2]
        if arrived_ns < after + 5_000_000:
            break
    assert before - 1_000_000 < arrived_ns < after + 1_000_000  # the clocks' common error


def test_who_has_too_much_waiting_loses_what_comes_and_others_lose_nothing(
    listen, client, keeper, until
):
    ports = listen(start=False)
    ports._queue = WorkQueue(8 * (limits.OVERHEAD + 16_000))
    ports.start()
    one, other = client(ports), client(ports)
    keeper.is_slow = True
    keeper.go_on.clear()
    for number in range(10):
        one.take(b"x" * 16_000)
        until(lambda count=number + 1: ports.traffic.packets == count, "it to be read")
    other.take(b"y" * 16_000)
    until(lambda: ports.traffic.packets == 11, "the other to be read")
    keeper.go_on.set()
    until(lambda: not ports._queue, "all to be handled")
    one.take(b"again")
    until(lambda: b"again" in keeper.bodies, "it to be heard again")
    assert sorted(keeper.bodies) == [b"again", *[b"x" * 16_000] * 4, b"y" * 16_000]
    assert ports.traffic.excess == 6


def test_there_is_osc_over_ipv6(listen, client, keeper):
    try:
        ports = listen(host="::1", allowed=Allowed(["::1/128"]))
    except DeviceError:
        pytest.skip("no IPv6 here")
    keeper.answer = pack("/yehu/pong")
    for kind in ("udp", "prefixed", "slip"):
        sender = client(ports, kind)
        sender.take(b"/ping\0\0\0")
        assert sender.next() == ("/yehu/pong", [])


# ---------------------------------------------------------------- TCP

KINDS = ["prefixed", "slip"]


@pytest.mark.parametrize("kind", KINDS)
def test_a_stream_loses_nothing_while_python_is_busy(listen, client, keeper, until, busy, kind):
    ports = listen()
    packets = numbered(BURST)
    stream = client(ports, kind)
    with busy():
        stream.socket.sendall(b"".join(map(stream.wrap, packets)))
        until(lambda: len(keeper.packets) >= BURST, "all packets")
    assert keeper.bodies == packets


def test_a_stream_is_not_read_further_before_it_is_handled(listen, client, keeper, until):
    ports = listen()
    keeper.go_on.clear()
    streams = [client(ports, "prefixed") for _ in range(20)]
    data = streams[0].wrap(b"/" + b"x" * 59_999) * 4
    senders = [threading.Thread(target=each.socket.sendall, args=(data,)) for each in streams]
    for sender in senders:
        sender.start()
    time.sleep(SETTLE_S)
    held = sum(ports._queue.held(peer) for peer in list(ports._streams))
    assert held <= len(streams) * (limits.STREAM_READ + limits.OVERHEAD)
    keeper.go_on.set()
    until(lambda: len(keeper.packets) == 80, "all packets")
    for sender in senders:
        sender.join()
    assert ports.traffic.excess == 0


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_sent_before_hanging_up_is_heard(listen, client, keeper, until, kind):
    ports = listen()
    packets = numbered(3000)
    stream = client(ports, kind)
    stream.socket.sendall(b"".join(map(stream.wrap, packets)))
    stream.close()
    until(lambda: len(keeper.packets) >= 3000, "all packets")
    assert keeper.bodies == packets
    until(lambda: ports.traffic.connections == 0, "the connection to be gone")
    assert len(keeper.gone_peers) == 1


def test_who_sends_no_packets_is_hung_up_on_and_others_play_on(listen, client, keeper, until):
    ports = listen()
    bad, good = client(ports, "prefixed"), client(ports, "prefixed")
    good.take(b"/a\0\0")
    bad.socket.sendall(bad.wrap(b"/b\0\0") + struct.pack(">I", 1 << 23))
    assert bad.has_ended()
    good.take(b"/c\0\0")
    until(lambda: len(keeper.packets) == 3, "all whole packets")
    assert sorted(keeper.bodies) == [b"/a\0\0", b"/b\0\0", b"/c\0\0"]
    assert ports.traffic.connections == 1


class Net:
    """A socket that counts what it is given to send."""

    def __init__(self) -> None:
        self.sent_bytes = 0

    def sendto(self, packet: bytes, _address: object) -> None:
        self.sent_bytes += len(packet)


@pytest.mark.parametrize(
    ("is_here", "hosts", "most"),
    [(False, 1, 2), (False, 100, limits.ANSWERED_TO_ALL_HOSTS), (True, 1, 100)],
)
def test_answers_to_other_hosts_are_bounded_for_each_and_for_all(
    listen, monkeypatch, is_here, hosts, most
):
    """An address may be forged: a hundred ports of one host must not get a hundred answers."""
    ports, net = listen(), Net()
    monkeypatch.setattr(receiving, "is_here", lambda _host: is_here)
    monkeypatch.setattr(ports, "_udp", net)
    for number in range(100):
        peer = ports._peer((f"203.0.113.{number % hosts}", 1 + number))
        while peer.takes_more:
            peer.send(b"x" * 10_000)
    assert most <= net.sent_bytes / limits.ANSWERED < 1.2 * most + 0.2


def test_who_never_reads_misses_answers_and_others_play_on(listen, client, keeper, until):
    ports = listen()
    keeper.answer = b"x" * 60_000
    deaf = client(ports, "prefixed")
    for _ in range(400):
        deaf.take(b"/ping\0\0\0")
    until(lambda: len(keeper.packets) == 400, "all that it says")
    assert ports.traffic.unsent > 0
    assert ports.traffic.connections == 1
    keeper.answer = pack("/yehu/pong")
    other = client(ports, "slip")
    other.take(b"/ping\0\0\0")
    assert other.next() == ("/yehu/pong", [])


@pytest.mark.parametrize("many", [limits.CONNECTIONS_A_HOST, limits.CONNECTIONS])
def test_there_is_room_for_so_many_connections(listen, client, keeper, until, monkeypatch, many):
    monkeypatch.setattr(limits, "CONNECTIONS_A_HOST", many)
    ports = listen()
    streams = [client(ports, "slip") for _ in range(many)]
    for stream in streams:
        stream.take(b"/a\0\0")
    until(lambda: len(keeper.packets) == len(streams), "all to be heard")
    assert client(ports, "slip").has_ended()
    assert ports.traffic.refused == 1
    streams[0].close()
    until(lambda: ports.traffic.connections < len(streams), "room")
    late = client(ports, "slip")
    late.take(b"/late\0\0\0")
    until(lambda: b"/late\0\0\0" in keeper.bodies, "the late one")


def test_connections_that_never_say_a_thing_shut_nobody_out(
    listen, client, keeper, until, monkeypatch
):
    monkeypatch.setattr(limits, "CONNECTIONS", 3)
    ports = listen()
    half, silent, speaks = (client(ports, "prefixed") for _ in range(3))
    half.socket.sendall(struct.pack(">I", 100) + b"/half")
    speaks.take(b"/a\0\0")
    until(lambda: len(keeper.packets) == 1, "it to be heard")
    assert client(ports, "slip").has_ended()  # they still have time
    monkeypatch.setattr(limits, "FIRST_PACKET_S", 0.0)
    for body in (b"/b\0\0", b"/c\0\0"):
        client(ports, "slip").take(body)
        until(lambda body=body: body in keeper.bodies, "who comes")
    assert half.has_ended()
    assert silent.has_ended()
    speaks.take(b"/d\0\0")
    until(lambda: b"/d\0\0" in keeper.bodies, "who stays")


def test_who_is_silent_for_long_gives_its_place_to_who_comes_unless_it_listens(
    listen, client, keeper, until, monkeypatch
):
    monkeypatch.setattr(limits, "CONNECTIONS", 3)
    monkeypatch.setattr(limits, "QUIET_S", 1.0)
    ports = listen()
    listens, silent, speaks = (client(ports, "prefixed") for _ in range(3))
    for number, stream in enumerate((listens, silent, speaks)):
        stream.take(b"/a\0\0")
        until(lambda count=number + 1: len(keeper.packets) == count, "it to be heard")
    keeper.hearing.append(keeper.packets[0][1])
    time.sleep(1.1)
    speaks.take(b"/b\0\0")
    until(lambda: len(keeper.packets) == 4, "it to be heard")
    comes = client(ports, "slip")
    comes.take(b"/c\0\0")
    until(lambda: b"/c\0\0" in keeper.bodies, "who comes")
    assert silent.has_ended()
    for stream in (listens, speaks):
        stream.take(b"/d\0\0")
    until(lambda: keeper.bodies.count(b"/d\0\0") == 2, "who stays")
    assert client(ports, "slip").has_ended()  # nobody is silent any more


# A browser's POST for a page of http://evil.example, with OSC as its body.
NOTE = pack("/yehu/note", 67.0, 90.0)
POST = (
    b"POST / HTTP/1.1\r\nHost: 127.0.0.1:9000\r\nUser-Agent: curl/7.88.1\r\nAccept: */*\r\n"
    b"Origin: http://evil.example\r\nContent-Length: %d\r\n"
    b"Content-Type: application/x-www-form-urlencoded\r\n\r\n\xc0%b\xc0"
) % (len(NOTE) + 2, NOTE)


def test_a_web_page_is_hung_up_on_with_its_first_byte_and_plays_nothing(
    listen, client, keeper, until
):
    ports = listen()
    for _ in range(20):
        page = client(ports, "slip")
        with contextlib.suppress(OSError):
            page.socket.sendall(POST)
        assert page.has_ended()
    page = client(ports, "slip")
    page.socket.sendall(POST[:1])
    assert page.has_ended()
    assert ports.traffic.refused == 21
    assert keeper.packets == []
    until(lambda: ports.traffic.connections == 0, "all to be gone")


# ---------------------------------------------------------------- who may speak


@pytest.mark.parametrize("kind", ["udp", *KINDS])
def test_who_is_not_allowed_is_counted_and_never_answered(listen, client, keeper, until, kind):
    ports = listen(allowed=Allowed(["192.0.2.0/24"]))
    keeper.answer = b"/yehu/pong\0\0,\0\0\0"
    sender = client(ports, kind)
    with contextlib.suppress(OSError):
        sender.take(b"/ping\0\0\0")
    until(lambda: ports.traffic.refused == 1, "the refusal to be counted")
    assert sender.next(0.1) is None
    assert keeper.packets == []
    assert ports.traffic.packets == ports.traffic.connections == 0


# ---------------------------------------------------------------- the thread


def test_a_handler_that_fails_is_counted_and_the_next_packet_is_heard(
    listen, client, keeper, until
):
    ports = listen()
    sender = client(ports)
    logging.disable(logging.CRITICAL)
    try:
        sender.take(b"raise")
        sender.take(b"/next\0\0\0")
        until(lambda: b"/next\0\0\0" in keeper.bodies, "the next")
    finally:
        logging.disable(logging.NOTSET)
    assert ports.traffic.failures == 1


def test_what_is_due_is_looked_after_however_much_is_to_be_handled(listen, client, keeper, until):
    ports = listen()
    keeper.takes_s = 0.001
    send_all(client(ports), numbered(300))
    until(lambda: len(keeper.packets) == 300, "all packets")
    assert max(keeper.since_tick) * keeper.takes_s <= AHEAD_S


def test_an_idle_server_sleeps(listen, keeper):
    listen()
    time.sleep(0.3)
    assert keeper.ticks <= 5


def test_when_it_stops_everything_is_closed_whether_it_was_started_or_not(keeper, client):
    ports = OscPorts(HOST, 0, Allowed(), keeper)
    ports.start()
    stream = client(ports, "prefixed")
    stream.take(b"/a\0\0")
    threads = threading.active_count()
    ports.stop()
    assert threading.active_count() == threads - 1
    assert stream.has_ended()
    OscPorts(HOST, ports.port, Allowed(), keeper).stop()
    OscPorts(HOST, ports.port, Allowed(), keeper).stop()
