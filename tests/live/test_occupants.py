"""An address in use names a yehu-server that is there."""

from __future__ import annotations

import socket

import pytest

from yehu_server.errors import DeviceError
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import ServeOptions
from yehu_server.live.osc.open_sockets import open_both
from yehu_server.live.server import Server
from yehu_server.live.web.server import WebOptions, listen

HOST = "127.0.0.1"


@pytest.fixture(scope="module")
def server():
    output = OutputOptions(device="null")
    server = Server(
        ServeOptions(output=output, midi=None, osc=(HOST, 0), http=WebOptions((HOST, 0)))
    )
    server.start()
    yield server
    server.skip_fade_out()
    server.stop()


@pytest.mark.parametrize("host", [HOST, "0.0.0.0"])  # noqa: S104
def test_osc_names_it(server, host) -> None:
    with pytest.raises(DeviceError, match="in use by a running yehu-server; end it there, or"):
        open_both(host, server.osc.port)


def test_oscquery_names_it(server) -> None:
    with pytest.raises(DeviceError, match="in use by a running yehu-server; end it there, or"):
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
