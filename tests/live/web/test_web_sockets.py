"""OSC and OSCQuery's commands by WebSocket, from clients independent of the package."""

import socket
import time
from types import SimpleNamespace

import pytest
from web_client import BINARY, TEXT, Refused, WebSocket, ask
from wire import Message, Wire

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.peers import WebTraffic
from yehu_server.live.web.frames import frame_of
from yehu_server.live.web.server import WebOptions
from yehu_server.live.web.web_sockets import WebPeer

HOST = "127.0.0.1"
QUIET_S = 0.15
FORCE, DEVICE = "/yehu/bow/force", "/yehu/status/device"


@pytest.fixture(scope="module")
def port(shared_web) -> int:
    return shared_web.server.web.port


@pytest.fixture
def connect(port):
    """Open WebSockets that are closed at the end."""
    opened = []

    def connect(**headers: str) -> WebSocket:
        opened.append(WebSocket(port, **headers))
        return opened[-1]

    yield connect
    for web in opened:
        web.vanish()


@pytest.fixture
def web(connect) -> WebSocket:
    return connect()


@pytest.fixture(autouse=True)
def _as_it_was(shared_web, until):
    """Check that each test leaves the server well and without clients."""
    yield
    status = shared_web.server.status
    until(lambda: status()["web_sockets"] == 0, "all WebSockets are gone")
    shared_web.player.reset(frame=shared_web.player.frame_of())  # after all that was asked
    assert shared_web.is_well()
    assert status()["http_failures"] == 0


# ---------------------------------------------------------------- OSC


def test_a_binary_frame_is_osc_and_who_sets_something_is_answered(web, port):
    web.message(FORCE, 1.25)
    assert web.next() == Message(FORCE, [1.25])
    assert ask(port, FORCE + "?VALUE").json == {"VALUE": [1.25]}
    web.message("/yehu/unsubscribe", None)  # the nil of a call's type, where it has no arguments
    assert web.next().arguments[1].startswith("nothing is subscribed")
    web.send(BINARY, b"no OSC")
    assert web.next().address == "/yehu/error"


# ---------------------------------------------------------------- LISTEN and IGNORE


def test_a_listener_is_sent_the_value_at_once_and_then_each_change(web, shared_web):
    web.listen(FORCE)
    assert web.next() == Message(FORCE, [0.5])
    client = shared_web.client()
    for value in (1.0, 1.5, 99.0):
        client.send("/bow/force", value)
        assert web.next() == Message(FORCE, [min(value, 5.0)])
    assert web.next(QUIET_S) is None
    for path, kind in (FORCE + "/unit", float), (DEVICE, str), (DEVICE + "_losses", int):
        web.listen(path)
        (value,) = web.wait_for(path)
        assert type(value) is kind


def test_what_is_no_command_or_has_no_value_is_answered_with_an_error(web, subtests):
    for path in [
        *("/yehu/bow", "/", "/yehu/note", "/bow/force", "/yehu/nothing", "", FORCE + "/"),
        "/yehu/status",
    ]:
        web.listen(path)
        answer = web.next()
        assert answer["COMMAND"] == "ERROR"
        assert repr(path) in answer["DATA"]
    for text in [
        "",
        "LISTEN",
        "[]",
        "null",
        "{}",
        '{"COMMAND": "LISTEN"}',
        '{"COMMAND": "LISTEN", "DATA": {}}',
        '{"COMMAND": "LISTEN", "DATA": ["/yehu/bow/force"]}',
        '{"COMMAND": ["LISTEN"], "DATA": "/yehu/bow/force"}',
        '{"COMMAND": "SHUTDOWN", "DATA": "/"}',
        "[" * 60_000,
        '{"COMMAND": "' + "x" * 60_000 + '"}',
    ]:
        with subtests.test(text=text[:60]):
            web.send(TEXT, text.encode())
            answer = web.next()
            assert answer["COMMAND"] == "ERROR"
            assert 0 < len(answer["DATA"]) < 1500
    web.listen(FORCE)
    assert web.next().address == FORCE


def test_text_that_is_none_or_a_frame_that_is_too_long_ends_the_one_who_sent_it(connect):
    longest = connect()
    longest.send(BINARY, Wire.message("/yehu/ping", "x" * 60_000))  # as long as a datagram
    assert len(longest.wait_for("/yehu/pong")[0]) == 60_000
    for kind, data, code in (
        (TEXT, b"\xff\xfe", "1007"),
        (BINARY, bytes(limits.WEB_FRAME + 1), "1009"),
    ):
        web = connect()
        web.send(kind, data)
        with pytest.raises(ConnectionError, match=code):
            web.next()
    connect().sync()


# ---------------------------------------------------------------- who is not let in


def test_a_page_from_elsewhere_or_a_handshake_that_is_none_gets_no_web_socket(connect, port):
    for headers, status in [
        ({"Origin": f"http://{HOST}:1"}, 403),
        ({"Host": "evil.example"}, 403),
        ({"Sec-WebSocket-Key": "short"}, 400),
    ]:
        with pytest.raises(Refused) as refused:
            connect(**headers)
        assert refused.value.status == status
    connect(Origin=f"http://{HOST}:{port}").sync()


def test_there_is_room_for_so_many_of_a_host_and_no_more(connect):
    hosts = [f"127.0.0.{2 + i}" for i in range(limits.WEB_SOCKETS // limits.WEB_SOCKETS_A_HOST)]
    for host in hosts:
        for _ in range(limits.WEB_SOCKETS_A_HOST):
            connect(source=host)
        with pytest.raises(Refused) as refused:
            connect(source=host)
        assert refused.value.status == 503
    with pytest.raises(Refused):  # all are taken
        connect(source="127.0.0.100")


def test_the_connections_of_a_host_shut_no_other_out(port, connect):
    first = socket.create_connection((HOST, port), source_address=("127.0.0.9", 0))
    crowd = [socket.create_connection((HOST, port)) for _ in range(limits.WEB_CONNECTIONS + 50)]
    try:
        connect(source="127.0.0.8").sync()
        first.sendall(b"GET /yehu/bow/force?TYPE HTTP/1.1\r\nHost: localhost\r\n\r\n")
        first.settimeout(20.0)
        assert first.recv(1 << 16).startswith(b"HTTP/1.1 200")
        held = sum(is_open(one) for one in crowd)
        assert held <= limits.WEB_CONNECTIONS_A_HOST
    finally:
        for connection in (first, *crowd):
            connection.close()


def test_connections_that_have_ended_count_no_more(port):
    with socket.create_connection((HOST, port), timeout=20.0) as first:
        for _ in range(limits.WEB_CONNECTIONS_A_HOST + 1):
            assert ask(port, "/yehu/bow/force?TYPE").status == 200
        first.sendall(b"GET /yehu/bow/force?TYPE HTTP/1.1\r\nHost: localhost\r\n\r\n")
        assert first.recv(1 << 16).startswith(b"HTTP/1.1 200")


def is_open(connection: socket.socket) -> bool:
    connection.setblocking(False)
    try:
        return bool(connection.recv(1))
    except BlockingIOError:
        return True
    except ConnectionError:
        return False


# ---------------------------------------------------------------- those who hold up, or leave


def test_one_who_reads_nothing_holds_up_nobody(connect, shared_web, until):
    deaf, well = connect(), connect()
    unsent = shared_web.server.status()["http_unsent"]
    for _ in range(400):
        deaf.message("/yehu/ping", "x" * 30_000)
    until(lambda: shared_web.server.status()["http_unsent"] > unsent, "some is dropped")
    well.listen(FORCE)
    well.next()
    shared_web.client().send("/bow/force", 3.0)
    assert well.next() == Message(FORCE, [3.0])  # though the deaf one still reads nothing


def test_what_a_peer_does_not_take_is_dropped_and_counted():
    traffic, calls, later, sent, unsent = WebTraffic(), [], [], [], 0
    transport = SimpleNamespace(
        is_closing=lambda: False, get_write_buffer_size=lambda: unsent, write=sent.append
    )
    loop = SimpleNamespace(
        call_soon_threadsafe=lambda *call: calls.append(call),
        call_later=lambda _s, call: later.append(call),
    )
    peer = WebPeer("deaf", transport, loop, traffic)
    for number in range(3 * limits.UNSENT // 1000):
        peer.send(bytes([number % 256]) * 1000)
    most = limits.UNSENT // 1000 + 1
    assert traffic.unsent == 3 * limits.UNSENT // 1000 - most  # the web's thread takes none
    assert not peer.takes_more
    (call,) = calls.pop()  # it is called once, and writes at once, for all
    call()
    (written,) = sent
    assert written == b"".join(frame_of(bytes([n % 256]) * 1000) for n in range(most))
    assert peer.takes_more
    unsent = limits.UNSENT + 1  # the other end reads none
    peer.write(b"")
    assert not peer.takes_more
    dropped = traffic.unsent
    peer.send(b"lost")
    assert (traffic.unsent, calls) == (dropped + 1, [])
    unsent = 0
    (measure,) = later
    measure()
    assert peer.takes_more


def test_one_who_vanishes_is_forgotten_with_all_it_asked_for(shared_web, port, until):
    web = WebSocket(port)
    web.listen(FORCE)
    web.message("/yehu/subscribe", 3600.0)
    web.sync()
    assert shared_web.server.status()["osc_subscribers"] == 1
    web.vanish()
    until(lambda: not shared_web.handler.clients._clients, "nobody is left")


# ---------------------------------------------------------------- the end


def test_the_end_of_the_server_is_reported_and_soon(make_live):
    live = make_live(http=WebOptions((HOST, 0)))
    webs = [WebSocket(live.server.web.port) for _ in range(5)]
    webs[0].sync()
    began = time.monotonic()
    live.server.web.stop()
    assert time.monotonic() - began < 40.0  # aiohttp itself would wait for a minute
    for web in webs:
        with pytest.raises(ConnectionError, match="1001"):
            web.next()
        web.vanish()
