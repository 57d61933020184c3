"""Which requests and connections are served: limits on their number, and no foreign web pages.

A page from any site can, in a player's browser, open a WebSocket to this machine, and read from it
too where the site's name is made to mean this machine (DNS rebinding). So the headers Host and
Origin are checked. Pages of another port of this machine count as foreign, since any program may
serve them.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
from collections import Counter
from collections.abc import Awaitable, Callable, Iterator, Sequence
from urllib.parse import urlsplit

from aiohttp import web

from yehu_server.live import traffic_limits as limits
from yehu_server.live.network import Allowed, is_here, is_ip_address, plain

ENDING_S = 0.2  # to finish answers at the end
LONGEST_NAME = 300
PORTS = {"http": 80, "https": 443}  # by scheme, where an origin names none
NOWHERE = ("", 0)


async def serve_http(
    answer: Callable[[web.Request], Awaitable[web.StreamResponse]],
    listening: socket.socket,
    connections: Connections,
) -> web.AppRunner:
    """Serve all paths at a listening socket by a function; return what `cleanup` ends it by."""
    app = web.Application()
    app.router.add_route("*", "/{path:.*}", answer)
    quiet = logging.getLogger(f"{__name__}.http")  # malformed requests are not logged
    quiet.disabled = True
    runner = web.AppRunner(
        app,
        access_log=None,
        logger=quiet,
        keepalive_timeout=limits.WEB_IDLE_S,
        lingering_time=0.0,
        shutdown_timeout=ENDING_S,
    )
    await runner.setup()
    assert runner.server is not None  # noqa: S101 - setup makes it
    connections.limit(runner.server)
    try:
        await web.SockSite(runner, listening).start()
    except BaseException:
        await runner.cleanup()
        raise
    return runner


def own_names() -> frozenset[str]:
    """The names of this machine."""
    name = socket.gethostname().lower()
    short = name.partition(".")[0]
    return frozenset({"localhost", name, short, f"{short}.local"} - {"", ".local"})


def refusal(hosts: Sequence[str], origins: Sequence[str], names: frozenset[str]) -> str:
    """Why a request is refused, by its headers Host and Origin; empty where it is allowed."""
    host, _ = _place(hosts[0]) if len(hosts) == 1 else NOWHERE
    if not (is_ip_address(host) or host in names):
        return "ask for this machine by its address, or as localhost"
    if not origins:
        return ""
    scheme, _, origin = origins[0][:LONGEST_NAME].partition("://")
    port = PORTS.get(scheme.lower()) if len(origins) == 1 else None
    is_ours = port is not None and _place(origin, port) == _place(hosts[0], port)
    if not is_ours or not (host in names or is_here(host)):
        return "requests of foreign pages are refused"
    return ""


def check(request: web.Request, allowed: Allowed, names: frozenset[str]) -> None:
    """Refuse (HTTPException) a request that its sender, its headers or its method do not allow."""
    if request.remote is None or request.remote not in allowed:
        raise web.HTTPForbidden(text="this address is not allowed\n")
    headers = request.headers
    try:
        "".join((request.path, *headers.values())).encode()
    except UnicodeEncodeError:  # surrogates, which cannot be sent back
        refused = web.HTTPBadRequest(text="not UTF-8\n")
        refused.force_close()
        raise refused from None
    if reason := refusal(headers.getall("Host", []), headers.getall("Origin", []), names):
        raise web.HTTPForbidden(text=f"{reason}\n")
    if request.method not in {"GET", "HEAD"}:
        raise web.HTTPMethodNotAllowed(request.method, ("GET", "HEAD"))


def _place(text: str, port: int = 0) -> tuple[str, int]:
    """Host and port of ``HOST:PORT``, or of ``HOST`` with a default port; NOWHERE for others."""
    try:
        parts = urlsplit(f"//{text[:LONGEST_NAME]}")
        port = port if parts.port is None else parts.port
    except ValueError:
        return NOWHERE
    if parts.username is not None or parts.path or parts.query or parts.fragment:
        return NOWHERE
    return (parts.hostname or "").removesuffix("."), port


class Connections:
    """The connections of a server. One too many closes the oldest of the host that has most.

    WebSockets are not closed; what would be one too many is answered with 503.
    """

    def __init__(self) -> None:
        self._hosts: dict[web.RequestHandler, str] = {}  # in the order in which they came
        self._web_sockets: dict[web.RequestHandler, str] = {}  # those that are WebSockets

    def limit(self, server: web.Server) -> None:
        """Limit the connections of a server from now on."""
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
        if count > limits.WEB_CONNECTIONS_A_HOST or len(self._hosts) > limits.WEB_CONNECTIONS:
            of_host = [one for one, its in self._hosts.items() if its == host]
            oldest = next(one for one in of_host if one not in self._web_sockets)  # or the new one
            del self._hosts[oldest]
            oldest.force_close()

    @contextlib.contextmanager
    def web_socket(self, request: web.Request) -> Iterator[None]:
        """Count a WebSocket for a block; HTTPServiceUnavailable where there are too many."""
        host = plain(request.remote or "::")
        others = list(self._web_sockets.values())
        if len(others) >= limits.WEB_SOCKETS or others.count(host) >= limits.WEB_SOCKETS_A_HOST:
            raise web.HTTPServiceUnavailable(text="there are too many WebSockets\n")
        self._web_sockets[request.protocol] = host
        try:
            yield
        finally:
            del self._web_sockets[request.protocol]
