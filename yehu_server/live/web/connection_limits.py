"""Bounds on the connections of an HTTP server: in all, and of one host."""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter
from collections.abc import Iterator

from aiohttp import web

from yehu_server.live.network import plain

MOST_CONNECTIONS, MOST_OF_A_HOST = 256, 128  # with those that have sent no request
MOST_WEB_SOCKETS, MOST_SOCKETS_OF_A_HOST = 64, 32


class Connections:
    """The connections of a server. One too many closes the oldest of the host that has most.

    WebSockets are not closed; what would be one too many is answered with 503.
    """

    def __init__(self) -> None:
        self._hosts: dict[web.RequestHandler, str] = {}  # in the order in which they came
        self._talking: dict[web.RequestHandler, str] = {}  # those that are WebSockets

    def bound(self, server: web.Server) -> None:
        """Bound the connections of a server from now on."""
        made, lost = server.connection_made, server.connection_lost

        def begin(handler: web.RequestHandler, transport: asyncio.Transport) -> None:
            made(handler, transport)
            self._hosts[handler] = plain(transport.get_extra_info("peername", ("::",))[0])
            self._make_room()

        def end(handler: web.RequestHandler, exc: BaseException | None = None) -> None:
            lost(handler, exc)
            self._hosts.pop(handler, None)

        server.connection_made, server.connection_lost = begin, end  # type: ignore[method-assign]

    def _make_room(self) -> None:
        [(host, count)] = Counter(self._hosts.values()).most_common(1)
        if count > MOST_OF_A_HOST or len(self._hosts) > MOST_CONNECTIONS:
            of_host = [one for one, its in self._hosts.items() if its == host]
            oldest = next(one for one in of_host if one not in self._talking)  # or the new one
            del self._hosts[oldest]
            oldest.force_close()

    @contextlib.contextmanager
    def talking(self, request: web.Request) -> Iterator[None]:
        """Count a connection as a WebSocket for the time of a block.

        Raises HTTPServiceUnavailable where there are too many, in all or of its host.
        """
        host = plain(request.remote or "::")
        others = list(self._talking.values())
        if len(others) >= MOST_WEB_SOCKETS or others.count(host) >= MOST_SOCKETS_OF_A_HOST:
            raise web.HTTPServiceUnavailable(text="there are too many WebSockets\n")
        self._talking[request.protocol] = host
        try:
            yield
        finally:
            del self._talking[request.protocol]
