"""Asking a server that runs: what the commands do that change or show one."""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterator
from types import TracebackType
from typing import Self

from yehu_server.control.addresses import Address, shown, why
from yehu_server.control.packets import Message, PacketError, pack, unpack
from yehu_server.errors import DeviceError, RefusedError
from yehu_server.params.table import PREFIX

ANSWERS_WITHIN_S = 2.0
DATAGRAM_BYTES = 1 << 16


class OscClient:
    """Talks to one server by UDP; a context manager.

    Errors: DeviceError where its address is none.
    """

    def __init__(self, server: Address) -> None:
        self._name = shown(*server)
        try:
            family, kind, _, _, address = socket.getaddrinfo(*server, type=socket.SOCK_DGRAM)[0]
            self._socket = socket.socket(family, kind)
            self._socket.connect(address)  # hears nobody else
        except OSError as error:
            raise DeviceError(f"{self._name}: {why(error)}") from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._socket.close()

    def send(self, address: str, *arguments: float | str) -> None:
        """Send a message to an address after the prefix."""
        with contextlib.suppress(OSError):  # nobody there: no answer will tell
            self._socket.send(pack(PREFIX + address, *arguments))

    def answers(self, within_s: float = ANSWERS_WITHIN_S) -> Iterator[Message]:
        """What comes, with addresses after the prefix, until for so long nothing does.

        Errors: RefusedError where the server refuses something.
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
        """The next message of an address. Errors: DeviceError where none comes; RefusedError."""
        for message in self.answers(within_s):
            if message.address == address:
                return message
        raise DeviceError(f"no server answers at {self._name}; is yehu-server serve running?")
