"""A client of OSCQuery independent of the package.

HTTP by http.client; WebSockets (RFC 6455) by hand.
"""

import base64
import hashlib
import http.client
import json
import os
import socket
import struct
from typing import Any, NamedTuple

from wire import Message, Wire

HOST = "127.0.0.1"
PATIENCE_S = 20.0
GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class Answer(NamedTuple):
    """An answer by HTTP."""

    status: int
    headers: http.client.HTTPMessage
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)


def ask(port: int, path: str, method: str = "GET", body: bytes | None = None, **headers) -> Answer:
    """One request; headers may have _ for -."""
    connection = http.client.HTTPConnection(HOST, port, timeout=PATIENCE_S)
    try:
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        connection.request(method, path, body, named)
        response = connection.getresponse()
        return Answer(response.status, response.headers, response.read())
    finally:
        connection.close()


def walk(node: dict[str, Any]):
    """All nodes of a tree, by path."""
    yield node["FULL_PATH"], node
    for child in node.get("CONTENTS", {}).values():
        yield from walk(child)


class Refused(Exception):  # noqa: N818 - it is no error
    """The server does not open a WebSocket."""

    def __init__(self, status: int) -> None:
        super().__init__(status)
        self.status = status


class WebSocket:
    """One WebSocket."""

    def __init__(self, port: int, path: str = "/", source: str = HOST, **headers: str) -> None:
        self._socket = socket.create_connection((HOST, port), PATIENCE_S, (source, 0))
        key = base64.b64encode(os.urandom(16)).decode()
        asked = {
            "Host": f"{HOST}:{port}",
            "Upgrade": "websocket",
            "Connection": "Upgrade",
            "Sec-WebSocket-Key": key,
            "Sec-WebSocket-Version": "13",
        } | headers
        lines = "".join(f"{name}: {value}\r\n" for name, value in asked.items())
        self._socket.sendall(f"GET {path} HTTP/1.1\r\n{lines}\r\n".encode())
        self._buffer = b""
        while b"\r\n\r\n" not in self._buffer:
            self._buffer += self._more()
        head, _, self._buffer = self._buffer.partition(b"\r\n\r\n")
        status = int(head.split()[1])
        if status != 101:
            self._socket.close()
            raise Refused(status)
        accepted = base64.b64encode(hashlib.sha1((key + GUID).encode()).digest())  # noqa: S324
        assert b"sec-websocket-accept: " + accepted.lower() in head.lower()

    def _more(self) -> bytes:
        data = self._socket.recv(1 << 16)
        if not data:
            raise ConnectionError
        return data

    def _read(self, size: int) -> bytes:
        while len(self._buffer) < size:
            self._buffer += self._more()
        data, self._buffer = self._buffer[:size], self._buffer[size:]
        return data

    def send(self, kind: int, data: bytes) -> None:
        """Send one frame, masked, as clients must."""
        size = len(data)
        head = bytes([0x80 | kind])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 1 << 16:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        mask = os.urandom(4)
        key = (mask * (size // 4 + 1))[:size]
        masked = int.from_bytes(data, "big") ^ int.from_bytes(key, "big")
        self._socket.sendall(head + mask + masked.to_bytes(size, "big"))

    def receive(self, within_s: float = PATIENCE_S) -> tuple[int, bytes]:
        """The next frame. Errors: TimeoutError; ConnectionError when hung up."""
        self._socket.settimeout(within_s)
        start = self._buffer
        try:
            first, second = self._read(2)
        except TimeoutError:
            self._buffer = start
            raise
        assert first & 0x80, "not in pieces"
        assert not second & 0x80, "servers do not mask"
        self._socket.settimeout(PATIENCE_S)
        size = second & 0x7F
        if size >= 126:
            form = ">H" if size == 126 else ">Q"
            (size,) = struct.unpack(form, self._read(struct.calcsize(form)))
        return first & 0x0F, self._read(size)

    # -- OSCQuery ----------------------------------------------------------------------------

    def command(self, command: str, data: Any) -> None:
        self.send(TEXT, json.dumps({"COMMAND": command, "DATA": data}).encode())

    def listen(self, path: str) -> None:
        self.command("LISTEN", path)

    def ignore(self, path: str) -> None:
        self.command("IGNORE", path)

    def message(self, address: str, *arguments: float | str | None) -> None:
        self.send(BINARY, Wire.message(address, *arguments))

    def next(self, within_s: float = PATIENCE_S) -> Message | dict[str, Any] | None:
        """The next message or command; None after the time."""
        while True:
            try:
                kind, data = self.receive(within_s)
            except TimeoutError:
                return None
            if kind == BINARY:
                return Wire.read(data)
            if kind == TEXT:
                return json.loads(data)
            if kind == CLOSE:
                raise ConnectionError(int.from_bytes(data[:2], "big"))
            if kind == PING:
                self.send(PONG, data)

    def wait_for(self, address: str) -> list[Any]:
        """The arguments of the next message of an address."""
        while (heard := self.next()) is not None:
            if isinstance(heard, Message) and heard.address == address:
                return heard.arguments
        raise AssertionError(f"no {address}")

    def sync(self) -> None:
        """Wait until everything sent so far is done and answered; discard the answers."""
        for _ in range(2):  # changes are sent with the flush after
            self.message("/yehu/get", "/output/gain")
            self.wait_for("/yehu/output/gain")

    def close(self) -> None:
        """Close the WebSocket by a close frame."""
        self.send(CLOSE, struct.pack(">H", 1000))
        self._socket.close()

    def vanish(self) -> None:
        """Reset the connection, without a close frame."""
        linger = struct.pack("ii", 1, 0)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger)
        self._socket.close()
