"""Serve OSCQuery by HTTP and WebSocket, and metrics, in a thread.

Only OSC messages in a WebSocket change anything. No path of a request is used as a file's name.
"""

import asyncio
import errno
import ipaddress
import json
import logging
import socket
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

from aiohttp import web
from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import choose_encoder
from prometheus_client.registry import Collector

from yehu_server.errors import DeviceError, one_line
from yehu_server.live import traffic_limits as limits
from yehu_server.live.network import Address, Allowed, format_address, listening, plain, why_not
from yehu_server.live.osc.all_calls import more_calls
from yehu_server.live.osc.context import CallContext
from yehu_server.live.osc.listening_sockets import HTTP_BESIDE
from yehu_server.live.osc.peers import WebTraffic
from yehu_server.live.osc.receiving import OscPorts
from yehu_server.live.osc.status import PART_STATUS, STATUS, Kind
from yehu_server.live.part_addresses import FIRST, group_of
from yehu_server.live.web import query
from yehu_server.live.web.loop_thread import LoopThread
from yehu_server.live.web.request_filter import Connections, check, own_names, serve_http
from yehu_server.live.web.web_sockets import WebSockets
from yehu_server.params.table import PREFIX
from yehu_server.util.files import shipped_folder

log = logging.getLogger(__name__)

HEADERS = {"X-Content-Type-Options": "nosniff", "Cache-Control": "no-store"}
PARAMETERS = "parameters.html"
NAME = "yehu-server"  # in HOST_INFO
OSCQUERY = "OSCQuery"
PANEL = """
<li><a href="/panel/">The instrument</a></li>"""
PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>yehu-server</title></head>
<body><h1>yehu-server</h1><ul>{panel}
<li><a href="/{parameters}">Parameters</a></li>
<li><a href="/?HOST_INFO">OSCQuery</a>: <a href="{prefix}">the tree</a></li>
<li><a href="/metrics">Metrics</a></li>
</ul></body></html>
"""


@dataclass(frozen=True)
class WebOptions:
    """The address to listen at, and the networks that are answered."""

    address: Address
    allowed: Allowed = field(default_factory=Allowed)


class WebServer:
    """A TCP port for HTTP and WebSockets, and its thread; `page_port` is the page's, if any."""

    def __init__(
        self,
        options: WebOptions,
        osc: OscPorts,
        context: CallContext,
        page_port: Callable[[], int | None] = lambda: None,
    ) -> None:
        self.traffic = WebTraffic()
        self._allowed = options.allowed
        self._osc = osc
        self._context = context
        self._page_port = page_port
        self._parts = len(context.players)
        self._sockets = WebSockets(osc, context.clients, self.traffic, self._parts)
        self._metrics = Metrics(context.status, self._parts)
        self._names = own_names()
        self._listening = listen(OSCQUERY, *options.address)
        self.host, self.port = self._listening.getsockname()[:2]
        self._connections = Connections()
        self._thread = LoopThread(
            self._serve, "OSCQuery", lambda error: log.warning("OSCQuery: %s; trying again", error)
        )

    def start(self) -> None:
        """Start to serve."""
        self._thread.start()

    def stop(self) -> None:
        """Close all connections and stop serving."""
        self._thread.stop()
        self._listening.close()

    def tree_changed(self, path: str) -> None:
        """Report to all WebSockets that the tree has changed at a path; any thread may call."""
        self._thread.call(self._sockets.broadcast, "PATH_CHANGED", path)

    async def _serve(self) -> None:
        # A copy, since it is closed at the end, and serving may have to start again.
        listening = self._listening.dup()
        runner = await serve_http(self._answer, listening, self._connections)
        try:
            await asyncio.Event().wait()
        finally:
            await self._sockets.close()
            await runner.cleanup()

    async def _answer(self, request: web.Request) -> web.StreamResponse:
        self.traffic.requests += 1
        try:
            return await self._respond(request)
        except web.HTTPException as error:
            if error.status in {403, 405, 413, 503}:
                self.traffic.refused += 1
                error.force_close()
            error.headers.update(HEADERS)
            raise
        except ConnectionError:  # the client hung up
            raise
        except Exception:  # a defect of the server must fail this request only
            self.traffic.failures += 1
            log.exception("OSCQuery: a request could not be answered")
            raise web.HTTPInternalServerError from None

    async def _respond(self, request: web.Request) -> web.StreamResponse:
        check(request, self._allowed, self._names)
        if (request.content_length or 0) > limits.WEB_BODY:
            raise web.HTTPRequestEntityTooLarge(limits.WEB_BODY, request.content_length or 0)
        if request.headers.get("Upgrade", "").lower() == "websocket":
            with self._connections.web_socket(request):
                return await self._sockets.serve(request)
        if request.path == "/metrics":
            body, content_type = self._metrics.text(request.headers.get("Accept", ""))
            return web.Response(body=body, headers=HEADERS | {"Content-Type": content_type})
        if request.path == f"/{PARAMETERS}":
            return self._parameters()
        page_port = self._page_port()
        if request.path in {"/panel", "/panel/"} and page_port is not None:
            host = urlsplit(f"//{request.host}").hostname or ""  # which was checked
            raise web.HTTPTemporaryRedirect(f"http://{format_address(host, page_port)}/")
        reads_html = "text/html" in request.headers.get("Accept", "")
        if request.path == "/" and not request.query_string and reads_html:
            link = "" if page_port is None else PANEL
            return _html(PAGE.format(panel=link, parameters=PARAMETERS, prefix=PREFIX))
        return self._query(request)

    def _query(self, request: web.Request) -> web.Response:
        """Answer with a node, or with some of its attributes."""
        wanted = list(request.query)
        if wanted == ["HOST_INFO"]:
            return _json(self._host_info(request))
        for name in wanted:
            if name not in query.ATTRIBUTES:
                raise web.HTTPBadRequest(text=one_line(f"unknown attribute {name!r}") + "\n")
        context, more = self._context, more_calls(self._context.players)
        node = query.node_at(request.path, context.values, context.status, self._parts, more)
        if node is None:
            raise web.HTTPNotFound(text=one_line(f"nothing at {request.path}") + "\n")
        if not wanted:
            return _json(node)
        found = {name: node[name] for name in wanted if name in node}
        return _json(found) if found else web.Response(status=204, headers=HEADERS)

    def _host_info(self, request: web.Request) -> dict[str, Any]:
        # The address by which the client reached this machine, which may have several.
        reached = plain(request.get_extra_info("sockname", (self.host, self.port))[0])
        is_anywhere = ipaddress.ip_address(plain(self._osc.host)).is_unspecified
        osc_host = reached if is_anywhere else self._osc.host
        return {
            "NAME": NAME,
            "EXTENSIONS": query.EXTENSIONS,
            "OSC_IP": osc_host,
            "OSC_PORT": self._osc.port,
            "OSC_TRANSPORT": "UDP",
            "WS_IP": reached,
            "WS_PORT": self.port,
        }

    def _parameters(self) -> web.Response:
        file = shipped_folder("mappings") / PARAMETERS
        try:
            return _html(file.read_text("utf-8"))
        except OSError:
            raise web.HTTPNotFound(text="this page is not installed\n") from None


def listen(what: str, host: str, port: int) -> socket.socket:
    """Listen at an address, by IPv4 and IPv6 if it is one; a DeviceError names `what` cannot."""
    try:
        return listening((host, port))
    except OSError as error:
        where = format_address(host, port)
        is_other = what == OSCQUERY and error.errno == errno.EADDRINUSE
        beside = f"; play beside it: {HTTP_BESIDE}" * is_other
        raise DeviceError(f"{what}: cannot listen at {where}: {why_not(error)}{beside}") from error


def _html(text: str) -> web.Response:
    return web.Response(text=text, content_type="text/html", headers=HEADERS)


def _json(what: Any) -> web.Response:
    body = json.dumps(what, allow_nan=False).encode()
    return web.Response(body=body, content_type="application/json", headers=HEADERS)


NAMESPACE = "yehu"  # of metrics
FAMILIES = {Kind.GAUGE: GaugeMetricFamily, Kind.COUNTER: CounterMetricFamily}


class Metrics(Collector):
    """The status values that are numbers, in formats of Prometheus, read at each request.

    `status`: returns the status values of a group of addresses.
    `parts`: number of parts; where there are several, each has metrics with the label ``part``.
    """

    def __init__(self, status: Callable[[str], Mapping[str, float | str]], parts: int) -> None:
        self._status = status
        self._parts = parts
        self._registry = CollectorRegistry()
        self._registry.register(self)

    def describe(self) -> list[Metric]:
        """See `Collector`; the names come from the table, none are registered."""
        return []

    def collect(self) -> Iterator[Metric]:
        """See `Collector`."""
        status = self._status(FIRST)
        for row in STATUS:
            family = FAMILIES.get(row.kind)
            if family is not None:
                yield family(f"{NAMESPACE}_{row.name}", row.doc, value=float(status[row.name]))
        several = range(self._parts) if self._parts > 1 else ()
        parts = [self._status(group_of(part)) for part in several]
        for own in PART_STATUS if parts else ():
            metric = FAMILIES[own.kind](f"{NAMESPACE}_part_{own.name}", own.doc, labels=["part"])
            for number, part in enumerate(parts, start=1):
                metric.add_metric([str(number)], float(part[own.name]))
            yield metric

    def text(self, accept: str) -> tuple[bytes, str]:
        """The metrics, in a format that a client's Accept header asks for, and its content type."""
        try:
            encode, content_type = choose_encoder(accept)
        except (TypeError, ValueError):  # prometheus-client fails on malformed versions
            encode, content_type = choose_encoder("")
        return encode(self._registry), content_type
