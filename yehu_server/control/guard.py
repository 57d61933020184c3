"""Which web requests are answered: not what a foreign page makes a player's browser ask.

A page from anywhere can open a WebSocket to this machine, and by changing what its name means
(DNS rebinding) read from it too. Its requests show where it comes from.
"""

from __future__ import annotations

import ipaddress
import socket
from collections.abc import Sequence
from urllib.parse import urlsplit

from yehu_server.control.addresses import is_here

LONGEST_NAME = 300


def own_names() -> frozenset[str]:
    """What this machine is called."""
    name = socket.gethostname().lower()
    short = name.partition(".")[0]
    return frozenset({"localhost", name, short, f"{short}.local"} - {"", ".local"})


def refusal(hosts: Sequence[str], origins: Sequence[str], names: frozenset[str]) -> str:
    """Why a request is not answered, by its headers Host and Origin; nothing where it is."""
    host = _host_of(hosts[0]) if len(hosts) == 1 else ""
    if not (_is_address(host) or host in names):
        return "ask for this machine by its address, or as localhost"
    if not origins:
        return ""
    origin = _host_of_origin(origins[0]) if len(origins) == 1 else ""
    if origin != host or not (host in names or is_here(host)):
        return "a page from elsewhere may not ask"
    return ""


def _host_of_origin(origin: str) -> str:
    """The host of an origin such as ``http://127.0.0.1:9001``, or nothing."""
    scheme, separator, rest = origin[:LONGEST_NAME].partition("://")
    return _host_of(rest) if separator and scheme.lower() in {"http", "https"} else ""


def _host_of(text: str) -> str:
    """The host of ``HOST`` or ``HOST:PORT``, or nothing."""
    try:
        parts = urlsplit(f"//{text[:LONGEST_NAME]}")
        parts.port  # noqa: B018 - is checked as it is read
    except ValueError:
        return ""
    if parts.username is not None or parts.path or parts.query or parts.fragment:
        return ""
    return (parts.hostname or "").removesuffix(".")


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True
