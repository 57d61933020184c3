"""A server for pages."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable
from typing import Any

from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.page.pages import PageOptions
from yehu_server.live.server import Server

HOST = "127.0.0.1"
PATIENCE_S = 30.0


def until(condition: Callable[[], Any]) -> bool:
    """Wait until something is so; return whether it came to be."""
    deadline = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.01)
    return True


def start(port: int, parts: int = 1) -> Server:
    """A server of some parts, without a device, with its page at a port."""
    server = Server(
        ServeOptions(
            output=OutputOptions(device="null"),
            midi=None,
            osc=(HOST, 0),
            page=PageOptions((HOST, port), is_wished=True),
            parts=[PartOptions() for _ in range(parts)],
        )
    )
    server.start()
    return server


def stop(server: Server) -> None:
    """End it."""
    server.skip_fade_out()
    server.stop()


def free_port() -> int:
    """A port that is free now."""
    with socket.create_server((HOST, 0)) as probe:
        return int(probe.getsockname()[1])
