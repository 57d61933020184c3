"""Announce the server on the network by zeroconf (Bonjour)."""

import asyncio
import contextlib
import ipaddress
import socket
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from yehu_server.live.network import lan_address, plain
from yehu_server.live.osc.receiving import OscPorts
from yehu_server.live.web.loop_thread import LoopThread
from yehu_server.live.web.server import NAME, WebServer
from yehu_server.util.files import error_reason
from yehu_server.util.retry import Backoff

OSC, OSCQUERY = "_osc._udp.local.", "_oscjson._tcp.local."
LONGEST_LABEL = 63  # bytes; of DNS
AGAIN_AFTER_S, AGAIN_AFTER_AT_MOST_S = 2.0, 60.0


@dataclass(frozen=True)
class Service:
    """A port to announce."""

    kind: str
    host: str
    port: int


def announced(osc: OscPorts, web: WebServer | None, wanted: bool | None) -> list[Service]:
    """The services to announce: by default those that other machines can reach.

    `wanted`: announce all of them (True), or none (False).
    A port that listens at all addresses is announced at the machine's address on its network.
    """
    services = [Service(OSC, _reached(osc.host), osc.port)]
    if web is not None:
        services.append(Service(OSCQUERY, _reached(web.host), web.port))
    if wanted is None:
        return [one for one in services if not ipaddress.ip_address(one.host).is_loopback]
    return services if wanted else []


def _reached(host: str) -> str:
    host = plain(host)
    return lan_address() if ipaddress.ip_address(host).is_unspecified else host


class Announcer:
    """Announces services, from `start` to `stop`, in a thread; reports to `on_message`."""

    def __init__(self, services: Sequence[Service], on_message: Callable[[str], None]) -> None:
        self._services = services
        self._on_message = on_message
        patience = Backoff(AGAIN_AFTER_S, AGAIN_AFTER_AT_MOST_S)
        self._thread = LoopThread(
            self._announce,
            "zeroconf",
            lambda error: on_message(f"not announced: {error_reason(error)}"),
            patience,
        )

    def start(self) -> None:
        """Start to announce."""
        self._thread.start()

    def stop(self) -> None:
        """Withdraw the announcement."""
        self._thread.stop()

    async def _announce(self) -> None:
        import zeroconf  # late, so that playing starts sooner
        from zeroconf.asyncio import AsyncZeroconf

        hosts = sorted({service.host for service in self._services})
        if any(ipaddress.ip_address(host).is_unspecified for host in hosts):
            self._on_message("not announced: this machine has no network")
            return
        found = AsyncZeroconf(interfaces=hosts)
        host = socket.gethostname().partition(".")[0]
        name = f"{NAME} {host}".encode()[:LONGEST_LABEL].decode(errors="ignore")
        infos = [
            zeroconf.ServiceInfo(
                service.kind,
                f"{name}.{service.kind}",
                port=service.port,
                server=f"{host}.local.",
                parsed_addresses=[service.host],
            )
            for service in self._services
        ]
        # Shielded from cancellation: if it were cut short, its sockets would stay open.
        started = asyncio.ensure_future(found.zeroconf.async_wait_for_start())
        try:
            await asyncio.shield(started)
            for info in infos:
                await (await found.async_register_service(info, allow_name_change=True))
            names = {info.name.removesuffix(f".{info.type}") for info in infos}
            self._on_message(f"announced as {' and '.join(sorted(names))}")
            await asyncio.Event().wait()
        finally:
            with contextlib.suppress(zeroconf.Error):
                await started
            await found.async_close()
