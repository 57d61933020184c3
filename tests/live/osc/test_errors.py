"""Errors by OSC: unknown addresses, malformed packets, and how many errors are answered."""

from __future__ import annotations

import difflib

import pytest
from wire import errors

from yehu_server.live.osc import clients


@pytest.mark.parametrize(
    "address",
    [
        "/yehu",
        "/yehu/",
        "/yehu/bow",  # that takes two
        "/yehu/bow/",
        "/yehu/bow/forc",
        "/yehu/bow/force/",
        "/yehu//bow/force",
        "/bow/force",
        "/yehubow/force",
        "/YEHU/bow/force",
        "/yehu/bow/force ",
        "/",
        "//",
        "/yehu/bow/fôrce",
        "/ÿehu/" + "x" * 300,
    ],
)
def test_an_unknown_address_is_answered_and_changes_nothing(shared_server, wire, address):
    client = shared_server.client()
    before, counted = shared_server.player.values(), shared_server.handler.counts.errors
    client.take(wire.message(address, 0.123))
    assert client.wait_for("/error")[0] == address
    assert shared_server.player.values() == before
    assert shared_server.handler.counts.errors == counted + 1
    assert shared_server.is_well()


def test_a_near_name_is_suggested(shared_server):
    client = shared_server.client()
    client.tell("/bow/forc", 0.5)
    assert "/bow/force" in client.wait_for("/error")[1]


@pytest.mark.parametrize(
    "packet",
    [b"", b"\0", b"hello", b"/yehu/bow/force", b"/yehu/bow/force\0,i\0\0\0", b"#bundle\0\0"],
    ids=repr,
)
def test_a_malformed_packet_is_counted_and_answered(shared_server, packet):
    client = shared_server.client()
    counted = shared_server.handler.counts.malformed
    client.take(packet)
    assert "malformed" in client.wait_for("/error")[1]
    assert shared_server.handler.counts.malformed == counted + 1


def test_an_address_of_any_length_is_answered(shared_server):
    client = shared_server.client()
    client.tell("/" + "x" * 16_000)
    assert client.next(0.5)


@pytest.mark.parametrize(
    "call",
    ["/get", "/preset/load", "/preset/save", "/preset/delete", "/learn", "/unlearn", "/bow/force"],
)
def test_an_error_is_of_bounded_length_and_keeps_its_reason(still, call):
    (refused,) = still.ask(call, "x" * 60_000)
    address, reason = refused.arguments
    assert address == "/yehu" + call
    assert len(reason) < 1100
    assert any(word in reason for word in ("unknown", "plain name", "expected a number"))


def test_near_names_are_looked_for_only_where_they_are_told(still, monkeypatch):
    looked = []
    monkeypatch.setattr(
        difflib, "get_close_matches", lambda *words, **_: looked.append(words) or []
    )
    for number in range(500):
        still.tell(f"/bow/forc{number}", 1.0)
    assert len(errors(still.peer.received())) == clients.ERRORS_AT_ONCE
    assert len(looked) <= 2 * clients.ERRORS_AT_ONCE
