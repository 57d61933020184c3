"""Which web requests are answered."""

import socket

from yehu_server.live.web.request_filter import own_names, refusal

NAMES = frozenset({"localhost", "stage", "stage.local"})


def test_a_host_that_nobody_else_can_be_is_answered_and_a_name_that_another_may_have_is_not():
    for host in [
        *("127.0.0.1", "127.0.0.1:9001", "192.168.1.5:9001", "[::1]:9001", "[::1]", "localhost"),
        *("localhost:9001", "LocalHost:9001", "stage.local:9001", "stage", "stage.local."),
    ]:
        assert refusal([host], [], NAMES) == "", host
    for hosts in [
        [],
        [""],
        ["evil.example"],
        ["evil.example:9001"],
        ["localhost.evil.example"],
        ["127.0.0.1.evil.example"],
        ["127.0.0.1@evil.example"],
        ["evil.example/127.0.0.1"],
        ["127.0.0.1:port"],
        ["127.0.0.1:99999"],
        ["[::1"],
        ["localhost", "evil.example"],
        ["stage.evil.example"],
        [" " * 10_000],
        ["\u2160"],
    ]:
        assert "by its address" in refusal(hosts, [], NAMES), hosts


def test_a_page_of_this_machine_may_ask_and_one_from_elsewhere_may_not():
    for host, origin in [
        ("127.0.0.1:9001", "http://127.0.0.1:9001"),
        ("localhost:9001", "https://localhost:9001"),
        ("[::1]:9001", "http://[::1]:9001"),
        ("stage.local:9001", "http://Stage.local:9001"),
        ("stage.local", "https://stage.local."),
        ("stage.local:80", "http://stage.local"),
        ("stage.local:443", "https://stage.local"),
    ]:
        assert refusal([host], [origin], NAMES) == "", (host, origin)
    for host, *origins in [
        ("127.0.0.1", "http://127.0.0.1:9001"),
        ("127.0.0.1:80", "https://127.0.0.1"),
        ("127.0.0.1", "http://127.0.0.1", "http://127.0.0.1"),
        ("192.0.2.7:9001", "http://192.0.2.7:9001"),  # an address, but not of this machine
        ("127.0.0.1:9001", "http://127.0.0.1:3000"),  # any program may serve pages there
        *(
            ("127.0.0.1:9001", origin)
            for origin in (
                *("http://127.0.0.1", "http://127.0.0.1:port", "http://evil.example", "null", ""),
                *("http://127.0.0.1.evil.example", "http://localhost:9001", "file://"),
                *(
                    "127.0.0.1:9001",
                    "chrome-extension://127.0.0.1",
                    "http://evil.example@127.0.0.1",
                ),
            )
        ),
    ]:
        assert "foreign" in refusal([host], origins, NAMES), (host, origins)


def test_this_machine_knows_its_names():
    names = own_names()
    assert "localhost" in names
    assert socket.gethostname().lower() in names
    assert "" not in names
