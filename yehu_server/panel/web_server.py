"""Serves the page as static files to this machine, for those who want to try it."""

from __future__ import annotations

from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from yehu_server.errors import OutputError

HOST = "127.0.0.1"
CACHING = "no-cache"  # another version may be written into the folder


class _Handler(SimpleHTTPRequestHandler):
    extensions_map = {  # noqa: RUF012 - as the base class has it
        **SimpleHTTPRequestHandler.extensions_map,
        ".js": "text/javascript",
        ".wasm": "application/wasm",
    }

    def end_headers(self) -> None:
        self.send_header("Cache-Control", CACHING)
        super().end_headers()

    def log_message(self, *_: Any) -> None:
        """Say nothing: who serves the page to himself knows."""


def server_of(folder: Path, port: int) -> ThreadingHTTPServer:
    """A server of a folder's files on a port (0: a free one) of this machine, not yet running.

    Raises
    ------
    OutputError
        Where the port is taken.
    """
    try:
        return ThreadingHTTPServer((HOST, port), partial(_Handler, directory=str(folder)))
    except OSError as error:
        raise OutputError(f"{HOST}:{port}: {error.strerror}") from error


def url_of(server: ThreadingHTTPServer) -> str:
    """The address of the page."""
    return f"http://{HOST}:{server.server_address[1]}/"
