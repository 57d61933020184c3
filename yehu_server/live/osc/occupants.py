"""Who listens at an address that is in use already: a yehu-server, or somebody else."""

from __future__ import annotations

import contextlib
import errno
import http.client
import json
import socket
from collections.abc import Callable

from yehu_server.live.osc.packets import PacketError, pack, unpack
from yehu_server.params.table import PREFIX

WITHIN_S = 0.3
ANSWER_BYTES = 1 << 16
NAME = "yehu-server"  # in HOST_INFO of OSCQuery
LOCAL = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # noqa: S104 - nothing is bound


def by_whom(error: OSError, host: str, port: int, asks: Callable[[str, int], bool]) -> str:
    """What to add to an error of binding: whether a yehu-server is there; else nothing."""
    if error.errno != errno.EADDRINUSE or not asks(LOCAL.get(host, host), port):
        return ""
    return " by a running yehu-server; end it there, or play beside it: --osc :9010 --http :9011"


def plays_at(host: str, port: int) -> bool:
    """Whether a yehu-server answers OSC at an address."""
    with contextlib.suppress(OSError, PacketError):
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        with socket.socket(family, kind) as asking:
            asking.settimeout(WITHIN_S)
            asking.connect(address)
            asking.send(pack(f"{PREFIX}/ping"))
            answers = unpack(asking.recv(ANSWER_BYTES))
            return any(answer.address == f"{PREFIX}/pong" for answer in answers)
    return False


def serves_at(host: str, port: int) -> bool:
    """Whether a yehu-server answers OSCQuery at an address."""
    connection = http.client.HTTPConnection(host, port, timeout=WITHIN_S)
    with contextlib.suppress(OSError, http.client.HTTPException, ValueError):
        with contextlib.closing(connection):
            connection.request("GET", "/?HOST_INFO")
            told = json.loads(connection.getresponse().read(ANSWER_BYTES))
        return isinstance(told, dict) and str(told.get("NAME", "")).startswith(NAME)
    return False
