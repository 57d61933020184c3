"""Which web requests are answered."""

from __future__ import annotations

import socket

from yehu_server.live.web.access import own_names, refusal

NAMES = frozenset({"localhost", "stage", "stage.local"})


def test_a_host_that_nobody_else_can_be_is_answered(subtests):
    for host in [
        "127.0.0.1",
        "127.0.0.1:9001",
        "192.168.1.5:9001",
        "[::1]:9001",
        "[::1]",
        "localhost",
        "localhost:9001",
        "LocalHost:9001",
        "stage.local:9001",
        "stage",
        "stage.local.",
    ]:
        with subtests.test(host=host):
            assert refusal([host], [], NAMES) == ""


def test_a_name_that_another_may_have_is_refused(subtests):
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
        with subtests.test(hosts=hosts):
            assert "by its address" in refusal(hosts, [], NAMES)


def test_a_page_of_this_machine_may_ask(subtests):
    for host, origin in [
        ("127.0.0.1:9001", "http://127.0.0.1:9001"),
        ("localhost:9001", "https://localhost:9001"),
        ("[::1]:9001", "http://[::1]:9001"),
        ("stage.local:9001", "http://Stage.local:9001"),
        ("stage.local", "http://stage.local"),
        ("stage.local", "https://stage.local."),
        ("stage.local:80", "http://stage.local"),
        ("stage.local:443", "https://stage.local"),
    ]:
        with subtests.test(host=host, origin=origin):
            assert refusal([host], [origin], NAMES) == ""


def test_a_page_from_elsewhere_may_not(subtests):
    for host, origin in [
        ("127.0.0.1:9001", "http://127.0.0.1:3000"),  # any program may serve pages there
        ("127.0.0.1:9001", "http://127.0.0.1"),
        ("127.0.0.1", "http://127.0.0.1:9001"),
        ("127.0.0.1:80", "https://127.0.0.1"),
        ("127.0.0.1:9001", "http://127.0.0.1:port"),
        ("127.0.0.1:9001", "http://evil.example"),
        ("127.0.0.1:9001", "http://127.0.0.1.evil.example"),
        ("127.0.0.1:9001", "http://localhost:9001"),
        ("127.0.0.1:9001", "null"),
        ("127.0.0.1:9001", "file://"),
        ("127.0.0.1:9001", ""),
        ("127.0.0.1:9001", "127.0.0.1:9001"),
        ("127.0.0.1:9001", "chrome-extension://127.0.0.1"),
        ("127.0.0.1:9001", "http://evil.example@127.0.0.1"),
        ("192.0.2.7:9001", "http://192.0.2.7:9001"),  # an address, but not of this machine
    ]:
        with subtests.test(host=host, origin=origin):
            assert "foreign" in refusal([host], [origin], NAMES)


def test_two_origins_are_none():
    origins = ["http://127.0.0.1", "http://127.0.0.1"]
    assert "foreign" in refusal(["127.0.0.1"], origins, NAMES)


def test_this_machine_knows_its_names():
    names = own_names()
    assert "localhost" in names
    assert socket.gethostname().lower() in names
    assert "" not in names
