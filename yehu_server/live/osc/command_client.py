"""An OSC client for commands that change or show a running server."""

import contextlib
import socket
import time
from collections.abc import Iterator
from typing import Self

from yehu_server.errors import DeviceError, RefusedError
from yehu_server.live.network import Address, format_address
from yehu_server.live.osc.packets import Message, PacketError, pack, unpack
from yehu_server.params.table import PREFIX
from yehu_server.util.files import error_reason
from yehu_server.util.hints import command_name

ANSWERS_WITHIN_S = 2.0
DATAGRAM_BYTES = 1 << 16


class OscClient:
    """An OSC client of one server, by UDP, as a context; raises DeviceError: a wrong address."""

    def __init__(self, server: Address) -> None:
        self._name = format_address(*server)
        try:
            family, kind, _, _, address = socket.getaddrinfo(*server, type=socket.SOCK_DGRAM)[0]
            self._socket = socket.socket(family, kind)
            self._socket.connect(address)  # receives from this server only
        except OSError as error:
            raise DeviceError(f"{self._name}: {error_reason(error)}") from error

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def send(self, address: str, *arguments: float | str) -> None:
        """Send a message; `address` is without the prefix."""
        with contextlib.suppress(OSError):  # nobody listens there: no answer will come
            self._socket.send(pack(PREFIX + address, *arguments))

    def answers(self, within_s: float = ANSWERS_WITHIN_S) -> Iterator[Message]:
        """Messages as they come, addresses without the prefix, until none comes for `within_s`.

        Raises RefusedError where the server answers with an error.
        """
        until = time.monotonic() + within_s
        while (left := until - time.monotonic()) > 0.0:
            self._socket.settimeout(left)
            try:
                packet = self._socket.recv(DATAGRAM_BYTES)
            except TimeoutError:
                return
            except OSError:  # nobody listens there
                time.sleep(min(left, 0.05))
                continue
            with contextlib.suppress(PacketError):
                for message in unpack(packet):
                    known = message.address.removeprefix(PREFIX)
                    if known == "/error" and len(message.arguments) == 2:
                        raise RefusedError(str(message.arguments[1]))
                    yield Message(known, message.arguments)
            until = time.monotonic() + within_s

    def answer(self, address: str, within_s: float = ANSWERS_WITHIN_S) -> Message:
        """The next message at an address, without the prefix; raises DeviceError, RefusedError."""
        for message in self.answers(within_s):
            if message.address == address:
                return message
        raise DeviceError(
            f"no server answers at {self._name}; is {command_name()} serve running? "
            "At another address: --server HOST:PORT"
        )
