"""OSCQuery's HTTP and WebSockets, on a connection in memory."""

import asyncio
import functools
import json
import logging
from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import Any

from aiohttp import web as aiohttp_web
from aiohttp.test_utils import make_mocked_request
from fuzz.target import target, words

from yehu_server.errors import RefusedError
from yehu_server.live.osc.clients import Clients
from yehu_server.live.osc.osc_addresses import readable
from yehu_server.live.osc.packets import PacketError, unpack
from yehu_server.live.osc.status import STATUS, Kind
from yehu_server.live.web import web_sockets
from yehu_server.live.web.server import WebOptions, WebServer
from yehu_server.params.table import PREFIX, TABLE
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.playing.preset_folders import Presets

HOST = "127.0.0.1"
VALUES = {param.address: param.default for param in TABLE}
STATES: dict[str, float | str] = {row.name: "" if row.kind is Kind.TEXT else 0 for row in STATUS}
TICKS = 3
ENDS_WITHIN_S = 5.0
HANDSHAKE = (
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)


class Osc:
    """Stands in for the OSC thread."""

    host, port = HOST, 9000

    def is_behind(self, _peer: Any) -> bool:
        return False

    def receive(self, packet: bytes, peer: Any) -> None:
        assert peer.host
        try:
            list(unpack(packet))
        except PacketError:
            return

    def call_soon(self, action: Callable[[], None]) -> None:
        action()

    def leave(self, peer: Any) -> None:
        assert peer.host


class Connection(asyncio.Transport):
    """Keeps what is written."""

    def __init__(self) -> None:
        super().__init__({"peername": (HOST, 40_000), "sockname": (HOST, 9001)})
        self.written = bytearray()
        self._is_closing = False

    def write(self, data: bytes) -> None:
        self.written += data

    def writelines(self, pieces: Iterable[bytes]) -> None:
        self.written += b"".join(pieces)

    def get_write_buffer_size(self) -> int:
        return 0

    def is_closing(self) -> bool:
        return self._is_closing

    def close(self) -> None:
        self._is_closing = True

    abort = close

    def pause_reading(self) -> None:
        pass

    def resume_reading(self) -> None:
        pass


class Defects(logging.Handler):
    """Keeps the exceptions that a server logs and survives."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[BaseException] = []

    def emit(self, record: logging.LogRecord) -> None:
        if record.exc_info and record.exc_info[1]:
            self.found.append(record.exc_info[1])

    def check(self) -> None:
        """Raise the first one."""
        found, self.found = self.found, []
        if found:
            raise found[0]


class House:
    """A web server and its loop, without a socket."""

    def __init__(self) -> None:
        self.loop = asyncio.new_event_loop()
        self.defects = Defects()
        logger = logging.getLogger("yehu_server.live.web.server")
        logger.addHandler(self.defects)
        logger.propagate = False
        self.loop.set_exception_handler(lambda _loop, said: self._defect(said))
        clients = Clients(lambda _group: VALUES, PREFIX, lambda _group: STATES)
        player = SimpleNamespace(presets=Presets(), mapping=load(DEFAULT))
        context = SimpleNamespace(
            players=[player], values=lambda _: VALUES, status=lambda _: STATES, clients=clients
        )
        self.web = WebServer(WebOptions((HOST, 0)), Osc(), context)
        self._clients = clients
        self._server = self.loop.run_until_complete(self._set_up())

    def _defect(self, said: dict[str, Any]) -> None:
        self.defects.found.append(said.get("exception") or AssertionError(said["message"]))

    async def _set_up(self) -> aiohttp_web.Server:
        app = aiohttp_web.Application(logger=logging.getLogger("yehu_server.live.web.server"))
        app.router.add_route("*", "/{path:.*}", self.web._answer)
        quiet = logging.getLogger("fuzz.quiet")
        quiet.disabled = True
        runner = aiohttp_web.AppRunner(app, access_log=None, logger=quiet, lingering_time=0.0)
        await runner.setup()
        assert runner.server is not None
        return runner.server

    def talk(self, *pieces: bytes) -> bytes:
        """Send data as a client and close; return the answer. Errors: of the server."""
        before = self.web.traffic.failures
        answered = self.loop.run_until_complete(self._talk(pieces))
        self._clients.flush()
        self.defects.check()
        assert self.web.traffic.failures == before
        return answered

    async def _talk(self, pieces: Iterable[bytes]) -> bytes:
        before = asyncio.all_tasks()
        connection, protocol = Connection(), self._server()
        protocol.connection_made(connection)
        for piece in pieces:
            if not connection.is_closing():
                protocol.data_received(piece)
                for _ in range(TICKS):
                    await asyncio.sleep(0)
        protocol.connection_lost(None)
        if left := asyncio.all_tasks() - before:
            _, stuck = await asyncio.wait(left, timeout=ENDS_WITHIN_S)
            assert not stuck, "a connection that has ended is not forgotten"
        return bytes(connection.written)


@functools.cache
def house() -> House:
    return House()


def no_constant(name: str) -> None:
    raise AssertionError(f"{name} is no JSON")


WORDS = words(
    b"GET |HEAD |POST | HTTP/1.1\r\n|Host: 127.0.0.1\r\n|Origin: http://127.0.0.1\r\n",
    b"Upgrade: websocket\r\n|Content-Length: |Transfer-Encoding: chunked\r\n|\r\n\r\n|?VALUE",
    b"/yehu/bow/force|?HOST_INFO|/metrics|Accept: text/html\r\n",
)


@target("http-request", words=WORDS)
def http_request(data: bytes) -> None:
    """Any data is answered without a failure, or the server waits for more."""
    half = len(data) // 2
    answered = house().talk(data[:half], data[half:])
    assert not answered or answered.startswith(b"HTTP/")
    assert b"HTTP/1.1 500" not in answered


@target(
    "http-path", words=words(b"/yehu/|?VALUE|?HOST_INFO|&|%2f|%00|..|/parameters.html|/bow/force")
)
def http_path(data: bytes) -> None:
    """Any path and query is answered with JSON, a page, or a client's error."""
    path = "/" + data.decode("latin-1")
    try:
        request = make_mocked_request("GET", path, {"Host": HOST}, transport=Connection())
    except ValueError:  # no path: aiohttp's own parser refuses it
        return
    server = house()
    try:
        response = server.loop.run_until_complete(server.web._answer(request))
    except aiohttp_web.HTTPException as error:
        response = error
    server.defects.check()
    if isinstance(response, aiohttp_web.HTTPException):
        assert 400 <= response.status < 500
        return
    assert response.status in {200, 204}
    if response.content_type == "application/json":
        json.loads(response.body, parse_constant=no_constant)


@target(
    "websocket",
    words=words(b'\x81\x85|\x82~|\x88\x80|\x89\x00|\x7f\xff\xff|{"COMMAND":"LISTEN","DATA":"'),
)
def websocket(data: bytes) -> None:
    """After any frames a WebSocket goes on or is closed, and ends with its connection."""
    half = len(data) // 2
    answered = house().talk(HANDSHAKE, data[:half], data[half:])
    assert answered.startswith(b"HTTP/1.1 101")
    assert house().web.traffic.web_sockets == 0


@target(
    "websocket-command",
    RefusedError,
    words=words(b'{"COMMAND": |"LISTEN"|"IGNORE"|, "DATA": |"/yehu/bow/force"|"/yehu/status/load"'),
)
def websocket_command(data: bytes) -> None:
    """A text frame is a command for an existing address, or a RefusedError."""
    command, address = web_sockets._read(data.decode(errors="replace"), 1)
    assert command in {"LISTEN", "IGNORE"}
    assert address in readable(1)
