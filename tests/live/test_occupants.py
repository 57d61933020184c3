"""An address in use names a yehu-server that is there."""

from __future__ import annotations

import socket

import pytest

from yehu_server.errors import DeviceError
from yehu_server.live.osc.open_sockets import open_both
from yehu_server.live.web.server import listen

HOST = "127.0.0.1"
NAMED = "in use by a running yehu-server; end it there, or"


def test_a_running_server_is_named(shared_web) -> None:
    server = shared_web.server
    for host in (HOST, "0.0.0.0"):  # noqa: S104
        with pytest.raises(DeviceError, match=NAMED):
            open_both(host, server.osc.port)
    with pytest.raises(DeviceError, match=NAMED):
        listen("OSCQuery", HOST, server.web.port)


@pytest.mark.parametrize("kind", [socket.SOCK_DGRAM, socket.SOCK_STREAM])
def test_others_are_not_named(kind) -> None:
    with socket.socket(socket.AF_INET, kind) as other:
        other.bind((HOST, 0))
        if kind == socket.SOCK_STREAM:
            other.listen()
        port = other.getsockname()[1]
        with pytest.raises(DeviceError, match=r"in use$"):
            open_both(HOST, port)
        if kind == socket.SOCK_STREAM:
            with pytest.raises(DeviceError, match=r"in use$"):
                listen("OSCQuery", HOST, port)
