"""Announcing the server by zeroconf; these tests do so on loopback only."""

import socket
from types import SimpleNamespace

import pytest
from zeroconf import ServiceBrowser, Zeroconf

from yehu_server.live import announce
from yehu_server.live.announce import OSC, OSCQUERY, Announcer, Service, announced
from yehu_server.live.web.server import WebOptions

HOST = "127.0.0.1"


def port(host: str, number: int) -> SimpleNamespace:
    return SimpleNamespace(host=host, port=number)


def test_what_others_can_reach_is_announced_or_what_one_commands(monkeypatch):
    monkeypatch.setattr(announce, "lan_address", lambda: "192.0.2.5")
    osc, query = Service(OSC, "192.0.2.7", 9000), Service(OSCQUERY, "192.0.2.5", 9001)
    here, far = port(HOST, 9000), port("192.0.2.7", 9000)
    for osc_port, query_port, command, expected in [
        (here, port("::1", 9001), None, []),
        (here, None, None, []),
        (far, port("0.0.0.0", 9001), None, [osc, query]),  # noqa: S104
        (far, port(HOST, 9001), None, [osc]),
        (here, port("::", 9001), None, [query]),
        (here, port(HOST, 9001), True, [Service(OSC, HOST, 9000), Service(OSCQUERY, HOST, 9001)]),
        (far, far, False, []),
    ]:
        assert announced(osc_port, query_port, command) == expected


def test_one_that_ends_before_it_began_leaves_nothing():
    said = []
    announcer = Announcer([Service(OSC, HOST, 9000)], said.append)
    announcer.start()
    announcer.stop()
    Announcer([Service(OSC, HOST, 9000)], said.append).stop()  # never started


class Browser:
    """A zeroconf browser on loopback."""

    def __init__(self) -> None:
        self.found: dict[str, tuple[str, int]] = {}
        self._zeroconf = Zeroconf(interfaces=[HOST])
        self._browser = ServiceBrowser(self._zeroconf, [OSC, OSCQUERY], self)

    def add_service(self, zeroconf: Zeroconf, kind: str, name: str) -> None:
        info = zeroconf.get_service_info(kind, name)
        if info is not None:
            self.found[name] = (info.parsed_addresses()[0], info.port)

    update_service = add_service

    def remove_service(self, zeroconf: Zeroconf, kind: str, name: str) -> None:
        del zeroconf, kind
        self.found.pop(name, None)

    def close(self) -> None:
        self._browser.cancel()
        self._zeroconf.close()


@pytest.fixture
def browser():
    try:
        browser = Browser()
    except OSError as error:
        pytest.skip(f"no multicast on loopback: {error}")
    yield browser
    browser.close()


def test_a_server_is_found_while_it_plays(make_live, browser, until):
    live = make_live(http=WebOptions((HOST, 0)), announce=True)
    server = live.server
    places = {(HOST, server.osc.port), (HOST, server.web.port)}
    until(lambda: places <= set(browser.found.values()), "both are found")
    names = [name for name, place in browser.found.items() if place in places]
    host = socket.gethostname().partition(".")[0]
    assert all(name.startswith(f"yehu-server {host}") for name in names)
    until(lambda: any("announced as yehu-server" in line for line in live.said), "a line")
    server._announcer.stop()
    until(lambda: not places & set(browser.found.values()), "both are gone")
