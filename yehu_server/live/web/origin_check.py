"""Protection against foreign web pages in a player's browser: by the headers Host and Origin.

A page from any site can open a WebSocket to this machine, and read from it too where the site's
name is made to mean this machine (DNS rebinding). Pages of another port of this machine count as
foreign, since any program may serve them.
"""

from __future__ import annotations

import ipaddress
import socket
from collections.abc import Sequence
from urllib.parse import urlsplit

from aiohttp import web

from yehu_server.live.network import Allowed, is_here

LONGEST_NAME = 300
PORTS = {"http": 80, "https": 443}  # by scheme, where an origin names none
NOWHERE = ("", 0)


def own_names() -> frozenset[str]:
    """The names of this machine."""
    name = socket.gethostname().lower()
    short = name.partition(".")[0]
    return frozenset({"localhost", name, short, f"{short}.local"} - {"", ".local"})


def refusal(hosts: Sequence[str], origins: Sequence[str], names: frozenset[str]) -> str:
    """Why a request is refused, by its headers Host and Origin; empty where it is allowed."""
    host, _ = _place(hosts[0]) if len(hosts) == 1 else NOWHERE
    if not (_is_address(host) or host in names):
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
    """Refuse a request that is not allowed by its sender, its headers or its method.

    Raises web.HTTPException where it is refused.
    """
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


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True
