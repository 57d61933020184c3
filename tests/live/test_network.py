"""Addresses to listen at, and networks that may send."""

from types import SimpleNamespace

import ifaddr
import pytest

from yehu_server.errors import ParameterError
from yehu_server.live.network import Allowed, format_address, lan_interface, parse_address


def test_who_is_heard():
    for networks, host, is_heard in [
        ((), "203.0.113.9", True),
        (("127.0.0.0/8",), "127.0.0.1", True),
        (("127.0.0.1",), "127.0.0.1", True),
        (("192.168.1.7/24",), "192.168.1.200", True),
        (("192.168.1.0/24",), "192.168.2.1", False),
        (("192.168.1.0/24", "10.0.0.0/8"), "10.1.2.3", True),
        (("127.0.0.0/8",), "::ffff:127.0.0.1", True),
        (("127.0.0.0/8",), "::1", False),
        (("fe80::/10",), "fe80::1%eth0", True),
        (("0.0.0.0/0",), "203.0.113.9", True),
    ]:
        allowed = Allowed(networks)
        assert [host in allowed for _ in range(2)] == [is_heard] * 2, (networks, host)
    for text in ("", "localhost", "192.168.1", "192.168.1.0/33", "1.2.3.4/x", "*"):
        with pytest.raises(ParameterError, match="network"):
            Allowed([text])


def test_where_to_listen_is_read_or_refused(subtests):
    ours = "0.0.0.0"  # noqa: S104 - only a default
    for text, address in [
        ("127.0.0.1:9000", ("127.0.0.1", 9000)),
        (":57120", (ours, 57120)),
        ("localhost", ("localhost", 9001)),
        ("10.0.0.1:0", ("10.0.0.1", 0)),
        ("[::1]:9000", ("::1", 9000)),
        ("[::1]", ("::1", 9001)),
        ("::1", ("::1", 9001)),
        ("2001:db8::9:1", ("2001:db8::9:1", 9001)),
        ("fe80::1%eth0", ("fe80::1%eth0", 9001)),
    ]:
        with subtests.test(text=text):
            assert parse_address(text, ours, 9001) == address
            assert parse_address(format_address(*address), ours, 0) == address  # as it is shown
    for text in ["a:b", "a:-1", "a:65536", "a:1.5", "a:1e3", "[::1]:x", "a..b", f"{64 * 'a'}.b"]:
        with subtests.test(text=text), pytest.raises(ParameterError, match="HOST:PORT"):
            parse_address(text, "127.0.0.1", 9000)
    with pytest.raises(ParameterError, match="9120 is a port: write :9120"):
        parse_address("9120", "127.0.0.1", 9000)


@pytest.mark.parametrize(
    ("own", "network"), [("192.168.5.5", "192.168.4.0/22"), ("10.1.2.3", "10.1.2.3/32")]
)
def test_the_network_is_as_wide_as_the_interface_says(monkeypatch, own, network):
    found = [("::1", 128), ("127.0.0.1", 8), ("192.168.5.5", 22)]
    ips = [SimpleNamespace(ip=ip, network_prefix=prefix) for ip, prefix in found]
    monkeypatch.setattr("yehu_server.live.network.lan_address", lambda: own)
    monkeypatch.setattr(ifaddr, "get_adapters", lambda: [SimpleNamespace(ips=ips)])
    assert str(lan_interface().network) == network
