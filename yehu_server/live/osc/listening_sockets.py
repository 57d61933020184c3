"""Open the sockets for OSC, and find out who uses an address."""

import contextlib
import errno
import socket

from yehu_server.errors import DeviceError, YehuError
from yehu_server.live.network import format_address, listening, why_not
from yehu_server.live.osc.command_client import OscClient

TRIES_FOR_A_PORT = 20
# Of who is asked at an address in use.
ANSWERS_WITHIN_S = 0.3
HTTP_BESIDE = "--http :9011"
BESIDE = f"--osc :9010 {HTTP_BESIDE}"
LOCAL = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # noqa: S104 - nothing is bound


def open_both(host: str, port: int) -> tuple[socket.socket, socket.socket]:
    """Open UDP and TCP sockets at an address; raises DeviceError where it is in use or not ours."""
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0][0]
        for _ in range(TRIES_FOR_A_PORT if port == 0 else 0):
            with contextlib.suppress(OSError):  # in use for TCP only
                return _bind(family, host, port)
        return _bind(family, host, port)
    except OSError as error:
        raise DeviceError(
            f"OSC: cannot listen at {format_address(host, port)}: {why_not(error)}"
            f"{by_whom(error, host, port)}"
        ) from error


def _bind(family: int, host: str, port: int) -> tuple[socket.socket, socket.socket]:
    with contextlib.ExitStack() as undo:
        udp = undo.enter_context(socket.socket(family, socket.SOCK_DGRAM))
        udp.bind((host, port))
        tcp = undo.enter_context(listening((host, udp.getsockname()[1])))
        undo.pop_all()
    return udp, tcp


def by_whom(error: OSError, host: str, port: int) -> str:
    """What to add to an error of binding: whether a yehu-server answers there; else nothing."""
    if error.errno == errno.EADDRINUSE:
        with contextlib.suppress(YehuError), OscClient((LOCAL.get(host, host), port)) as client:
            client.send("/ping")
            client.answer("/pong", ANSWERS_WITHIN_S)
            return f" by a running yehu-server; end it there, or play beside it: {BESIDE}"
    return ""
