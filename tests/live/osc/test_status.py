"""The status by OSC: asked for, and subscribed to."""

from __future__ import annotations

import pytest
from wire import values

from yehu_server.live.osc.status import STATUS


def test_the_status_is_asked_for_like_any_value(still):
    assert values(still.ask("/get", "/yehu/status/load")) == {"/yehu/status/load": 0.5}
    assert values(still.ask("/get", "/status/recordin[g]")) == {"/yehu/status/recording": ""}
    heard = values(still.ask("/get", "/status/*"))
    assert set(heard) == {f"/yehu/status/{value.name}" for value in STATUS}


@pytest.mark.parametrize(
    ("asked", "reason"),
    [
        ("/status/zither", "unknown status value '/status/zither'"),
        ("/status/nota", "unknown status value '/status/nota'; did you mean /status/note?"),
    ],
)
def test_an_unknown_status_value_is_told_without_nonsense(still, asked, reason):
    assert still.ask("/get", asked)[0].arguments[1] == reason
    assert still.ask(asked, 1.0)[0].arguments[1] == reason


def test_the_status_cannot_be_set(still):
    (refused,) = still.ask("/status/note", 60.0)
    assert refused.arguments == [
        "/yehu/status/note",
        "the status cannot be set; ask for it by /yehu/get",
    ]


def test_who_subscribes_to_the_status_is_told_it_at_once_and_then_each_change(still):
    heard = values(still.ask("/subscribe/status", 2.0))
    assert heard.pop("/yehu/subscribed") == 2.0
    assert set(heard) == {f"/yehu/status/{value.name}" for value in STATUS}
    still.pass_time(0.5)
    assert still.peer.received() == []
    still.services.names.append("take")
    still.tell("/playing/vibrato", 5.0)  # which it did not subscribe to
    still.pass_time(0.3)
    heard = values(still.peer.received())
    assert heard.pop("/yehu/playing/vibrato") == 5.0  # but is told of what it sets
    assert heard == {"/yehu/status/recording": "take"}
    assert still.handler.clients.subscribers == 1
    still.pass_time(2.0)
    still.services.names.append("another")
    still.pass_time(0.5)
    assert still.peer.received() == []
    assert still.handler.clients.subscribers == 0


def test_who_subscribes_to_both_is_told_of_both_until_it_unsubscribes(still):
    still.ask("/subscribe", 60.0)
    still.ask("/subscribe/status", 60.0)
    still.player.write("/playing/attack", 50.0, frame=0)
    still.services.names.append("take")
    still.pass_time(0.3)
    heard = values(still.peer.received())
    assert heard == {"/yehu/playing/attack": 50.0, "/yehu/status/recording": "take"}
    still.ask("/unsubscribe")
    still.player.write("/playing/attack", 60.0, frame=0)
    still.services.names.append("another")
    still.pass_time(0.5)
    assert still.peer.received() == []


def test_status_is_told_line_by_line(shared_server):
    client = shared_server.client()
    client.tell("/status")
    heard = values(client.all())
    status = shared_server.server.status()
    assert set(heard) == {f"/yehu/status/{name}" for name in status}
    assert heard["/yehu/status/rate"] == 48000.0
    assert heard["/yehu/status/osc_buffer_bytes"] == shared_server.ports.traffic.buffer_bytes
