"""Network addresses: reading and writing them, and which senders are allowed."""

import contextlib
import errno
import ipaddress
import re
import socket
from collections.abc import Iterable
from functools import lru_cache

from yehu_server.errors import ParameterError
from yehu_server.util.files import error_reason

Network = ipaddress.IPv4Network | ipaddress.IPv6Network
Address = tuple[str, int]

# Where a server listens by default, and where commands search for it.
OSC_ADDRESS: Address = ("127.0.0.1", 9000)
HTTP_ADDRESS: Address = ("127.0.0.1", 9001)
# A host's name, or its address in IPv4: labels of 1 to 63 characters, and a final full stop or not.
_LABEL = r"[A-Za-z0-9_](?:[A-Za-z0-9_-]{0,61}[A-Za-z0-9_])?"
_NAME = re.compile(rf"{_LABEL}(?:\.{_LABEL})*\.?")
ANYWHERE = "0.0.0.0"  # noqa: S104 - nothing is bound to it here


class Allowed:
    """The networks, such as ``192.168.1.0/24``, whose hosts may send; without any, all may.

    Raises ParameterError where one is not a network.
    """

    def __init__(self, networks: Iterable[str] = ()) -> None:
        self._networks: list[Network] = []
        self._has = lru_cache(maxsize=1 << 16)(self._find)
        for text in networks:
            try:
                self._networks.append(ipaddress.ip_network(text, strict=False))
            except ValueError:
                raise ParameterError(f"{text!r} is not a network, such as 192.168.1.0/24") from None

    def __contains__(self, host: str) -> bool:
        """Whether a host (an IP address) may send."""
        return not self._networks or self._has(host)

    def _find(self, host: str) -> bool:
        address = ipaddress.ip_address(plain(host))
        return any(address in network for network in self._networks)


@lru_cache(maxsize=1024)
def is_here(host: str) -> bool:
    """Whether an IP address is one of this machine's."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.bind((host, 0))  # only an address of ours can be bound
    except OSError:
        return False
    return True


def plain(host: str) -> str:
    """An IP address without its zone, and in IPv4 where it is an IPv4 address mapped to IPv6."""
    address = ipaddress.ip_address(host.partition("%")[0])
    return str(getattr(address, "ipv4_mapped", None) or address)


def lan_address() -> str:
    """Find this machine's address on its network, without sending a packet."""
    with contextlib.suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.connect(("192.0.2.1", 9))  # a network reserved for documentation
        return str(probe.getsockname()[0])
    return ANYWHERE  # there is no network


def listening(address: Address) -> socket.socket:
    """Listen at an address by TCP, by IPv4 and IPv6 if it is one; raises OSError.

    On Windows SO_REUSEADDR, which Python then leaves out, takes the port of another program.
    """
    family = socket.getaddrinfo(*address, type=socket.SOCK_STREAM)[0][0]
    dualstack = family is socket.AF_INET6 and socket.has_dualstack_ipv6()
    return socket.create_server(address, family=family, dualstack_ipv6=dualstack)


def why_not(error: OSError) -> str:
    """The reason why an address cannot be bound; of one not this machine's, with those that are."""
    if error.errno != errno.EADDRNOTAVAIL:
        return error_reason(error)
    import ifaddr

    own = [
        str(each.ip) for adapter in ifaddr.get_adapters() for each in adapter.ips if each.is_IPv4
    ]
    return f"{error_reason(error)}; this machine has {', '.join(own)}"


def lan_interface() -> ipaddress.IPv4Interface:
    """Find this machine's address on its network, with that network's mask."""
    import ifaddr

    address = lan_address()
    for adapter in ifaddr.get_adapters():
        for own in adapter.ips:
            if own.ip == address:
                return ipaddress.IPv4Interface(f"{address}/{own.network_prefix}")
    return ipaddress.IPv4Interface(address)  # a network of this machine alone


def format_address(host: str, port: int) -> str:
    """Host and port as text that `parse_address` reads."""
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


def parse_address(text: str, default_host: str, default_port: int) -> Address:
    """Read HOST:PORT, HOST, :PORT or [IPv6]:PORT; raises ParameterError for anything else."""
    if text.isdecimal():
        raise ParameterError(f"{text} is a port: write :{text}")
    host, colon, port = text.rpartition(":")
    is_bare_ipv6 = ":" in host and not host.endswith("]")
    if not colon or text.endswith("]") or is_bare_ipv6:
        host, port = text, ""
    try:
        number = int(port) if port else default_port
    except ValueError:
        number = -1
    host = host.removeprefix("[").removesuffix("]") or default_host
    if not 0 <= number <= 65535 or not (_NAME.fullmatch(host) or is_ip_address(host)):
        raise ParameterError(
            f"{text!r}: expected HOST:PORT, such as {format_address(*OSC_ADDRESS)}"
        )
    return host, number


def is_ip_address(text: str) -> bool:
    """Whether a text is an IP address."""
    try:
        ipaddress.ip_address(text)
    except ValueError:
        return False
    return True
