"""Serve WebSockets: OSC in binary frames, OSCQuery commands in text frames."""

import asyncio
import contextlib
import json
from collections import deque
from typing import Any

from aiohttp import WSMsgType, web

from yehu_server.errors import RefusedError, shortened
from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.clients import Clients
from yehu_server.live.osc.osc_addresses import readable
from yehu_server.live.osc.peers import Peer, WebTraffic
from yehu_server.live.osc.receiving import OscPorts
from yehu_server.live.web.frames import TEXT, frame_of, messages, write
from yehu_server.params.table import PREFIX

HEARTBEAT_S = 20.0  # a socket that does not answer within half of this is closed
CLOSING_S = 0.3
BEHIND_S, MEASURE_S = 0.005, 0.02


class WebPeer(Peer):
    """A WebSocket, which the OSC thread sends packets to, and the web's thread writes them.

    It writes what waits at once: each call of the system lets the other thread go on, which is to
    play. While the other end does not read, further packets are dropped, and no other client is
    delayed.
    """

    def __init__(
        self,
        host: str,
        transport: asyncio.WriteTransport,
        loop: asyncio.AbstractEventLoop,
        traffic: WebTraffic,
    ) -> None:
        self.host = host
        self._transport = transport
        self._loop = loop
        self._traffic = traffic
        self._sent, self._passed_on, self._buffered = 0, 0, 0  # bytes, each counted by one thread
        self._waiting: deque[bytes] = deque()
        self._is_called = False  # whether the web's thread was, for those
        self._measures = False

    @property
    def _unsent_bytes(self) -> int:
        return self._sent - self._passed_on + self._buffered

    @property
    def takes_more(self) -> bool:
        """See `Peer`."""
        return self._unsent_bytes < limits.UNSENT // 2

    def send(self, *packets: bytes) -> None:
        """See `Peer`."""
        if self._unsent_bytes > limits.UNSENT:
            self._traffic.unsent += len(packets)
            return
        self._sent += sum(map(len, packets))
        self._waiting += packets
        if not self._is_called:
            self._is_called = True
            with contextlib.suppress(RuntimeError):  # the loop has ended
                self._loop.call_soon_threadsafe(self._pass_on)

    def _pass_on(self) -> None:
        self._is_called = False  # before they are taken, so that none is left
        packets = [self._waiting.popleft() for _ in range(len(self._waiting))]
        self._passed_on += sum(map(len, packets))
        self.write(*map(frame_of, packets))

    def write(self, *frames: bytes) -> None:
        """Write frames; for the web's thread."""
        if not write(self._transport, b"".join(frames), limits.UNSENT):
            self._traffic.unsent += len(frames)
        if not self._measures:
            self._measure()

    def _measure(self) -> None:
        """Note, in the web's thread, what the other end has not read, until it has read all."""
        self._buffered = self._transport.get_write_buffer_size()
        self._measures = self._buffered > 0 and not self._transport.is_closing()
        if self._measures:
            self._loop.call_later(MEASURE_S, self._measure)


class WebSockets:
    """All open WebSockets; used by the web's thread."""

    def __init__(
        self, osc: OscPorts, clients: Clients, traffic: WebTraffic, parts: int = 1
    ) -> None:
        self._osc = osc
        self._clients = clients  # used by the OSC thread only
        self._traffic = traffic
        self._parts = parts  # number of them
        self._open: dict[web.WebSocketResponse, WebPeer] = {}

    async def serve(self, request: web.Request) -> web.WebSocketResponse:
        """Serve one client until either end closes the connection."""
        socket = web.WebSocketResponse(
            timeout=CLOSING_S,
            heartbeat=HEARTBEAT_S,
            autoping=False,
            max_msg_size=limits.WEB_FRAME,
            compress=False,
        )
        await socket.prepare(request)
        if request.transport is None:  # it has gone already
            return socket
        loop = asyncio.get_running_loop()
        peer = WebPeer(str(request.remote), request.transport, loop, self._traffic)
        self._open[socket] = peer
        self._traffic.web_sockets += 1
        try:
            async for frame in messages(socket):
                # The sender waits while its packets wait; nothing is lost.
                while self._osc.is_behind(peer):  # noqa: ASYNC110 - the OSC thread has no event
                    await asyncio.sleep(BEHIND_S)
                if frame.type is WSMsgType.BINARY:
                    self._osc.receive(frame.data, peer)
                elif frame.type is WSMsgType.TEXT:
                    self._carry_out(frame.data, peer)
        finally:
            del self._open[socket]
            self._traffic.web_sockets -= 1
            self._osc.leave(peer)
        return socket

    def broadcast(self, command: str, data: Any) -> None:
        """Send a command to all clients."""
        for peer in self._open.values():
            peer.write(_command(command, data))

    async def close(self) -> None:
        """Close all WebSockets."""
        closing = [socket.close(code=1001) for socket in list(self._open)]
        await asyncio.gather(*closing, return_exceptions=True)

    def _carry_out(self, text: str, peer: WebPeer) -> None:
        try:
            command, address = _read(text, self._parts)
        except RefusedError as error:
            peer.write(_command("ERROR", str(error)))
            return
        act = self._clients.listen if command == "LISTEN" else self._clients.ignore
        self._osc.call_soon(lambda: act(peer, address))


def _command(command: str, data: Any) -> bytes:
    return frame_of(json.dumps({"COMMAND": command, "DATA": data}).encode(), TEXT)


def _read(text: str, parts: int) -> tuple[str, str]:
    """Read a command and its address (without the prefix); raises RefusedError."""
    try:
        message = json.loads(text)
    except (ValueError, RecursionError):
        raise RefusedError("not JSON") from None
    if not isinstance(message, dict):
        raise RefusedError("expected an object with COMMAND and DATA")
    command, path = message.get("COMMAND"), message.get("DATA")
    if command not in ("LISTEN", "IGNORE"):
        raise RefusedError(f"unknown command {shortened(repr(command))}; there are LISTEN, IGNORE")
    address = path.removeprefix(PREFIX) if isinstance(path, str) else ""
    if address not in readable(parts) or address == path:
        raise RefusedError(f"{command}: nothing to listen to at {shortened(repr(path))}")
    return command, address
