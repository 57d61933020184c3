"""A server for pages."""

import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.page.pages import PageOptions
from yehu_server.live.server import Server
from yehu_server.live.web.server import WebOptions

HOST = "127.0.0.1"
ONE = (PartOptions(),)


def start(
    parts: tuple[PartOptions, ...] = ONE, port: int = 0, say: Callable[[str], object] = str
) -> Server:
    """A server of some parts, without a device, with its page at a port."""
    server = Server(
        ServeOptions(
            output=OutputOptions(device="null"),
            midi=None,
            osc=(HOST, 0),
            http=WebOptions((HOST, 0)),
            page=PageOptions((HOST, port), is_required=True),
            parts=list(parts),
        ),
        say,
    )
    server.start()
    return server


def stop(server: Server) -> None:
    """End it."""
    server.skip_fade_out()
    server.stop()


@contextmanager
def serving(parts: tuple[PartOptions, ...] = ONE) -> Iterator[tuple[Server, str]]:
    """A server, and the address of its page."""
    server = start(parts)
    try:
        yield server, f"http://{HOST}:{server.pages.port}/"
    finally:
        stop(server)


def free_port() -> int:
    """A port that is free now."""
    with socket.create_server((HOST, 0)) as probe:
        return int(probe.getsockname()[1])
