"""Subscriptions by OSC: to parameters and the status, by UDP and by streams."""

import contextlib
import socket
import time

import pytest
from wire import f32, values

from yehu_server.live.osc.status import STATUS
from yehu_server.params.table import TABLE, find


def are_still(*servers):
    """Whether nothing comes to some servers for a while."""
    heard = [server.ports.traffic.packets for server in servers]
    time.sleep(0.25)
    return heard == [server.ports.traffic.packets for server in servers]


def test_a_subscriber_may_hear_of_zero_to_one(still):
    sent = values(still.ask("/subscribe/unit", 60.0))
    speed = still.player.value("/playing/speed")
    assert sent["/yehu/playing/speed/unit"] == f32(find("/playing/speed").to_unit(speed))
    assert {f"/yehu{param.address}/unit" for param in TABLE} <= set(sent)
    still.player.set("/playing/speed", find("/playing/speed").from_unit(0.7), frame=0)
    still.pass_time(0.1)
    assert values(still.peer.received()) == {"/yehu/playing/speed/unit": pytest.approx(0.7)}


def test_another_server_may_follow_and_neither_answers_the_other(live, make_live, until):
    follower, client = make_live(), live.client()
    client.send("/subscribe", 30, follower.ports.port)
    client.send("/playing/volume", 0.3)
    client.wait_for("/playing/volume")
    until(lambda: follower.player.value("/playing/volume") == f32(0.3), "it to follow")
    until(lambda: are_still(live, follower), "both to have said all")
    assert live.handler.counts.messages == 2  # the client's alone
    assert follower.handler.counts.errors == 0


@pytest.mark.parametrize("is_ended_by_who_began_it", [True, False])
def test_a_client_names_the_port_it_listens_on(live, is_ended_by_who_began_it):
    speaks, listens, other = live.client(), live.client(), live.client()
    ends = speaks if is_ended_by_who_began_it else other
    speaks.send("/subscribe", 30, listens.port)
    assert listens.wait_for("/subscribed") == speaks.wait_for("/subscribed") == [30.0]
    listens.all()
    other.send("/playing/volume", 0.25)
    assert listens.wait_for("/playing/volume") == [0.25]
    assert speaks.all() == []
    ends.send("/unsubscribe", *[listens.port] * (ends is other))
    for hears in (ends, listens):
        assert hears.wait_for("/unsubscribed") == []
    other.send("/playing/volume", 0.5)
    other.wait_for("/playing/volume")
    assert listens.all() == []


def test_who_named_a_port_is_answered_there_too(live):
    speaks, listens, other = live.client(), live.client(), live.client()
    speaks.send("/subscribe", 30, listens.port)
    listens.wait_for("/subscribed")
    listens.all()
    for one in (speaks, other):  # as does another of its host, such as a command of a shell
        one.send("/playing/volum", 1.0)
        for hears in (one, listens):
            assert hears.wait_for("/error")[0] == "/yehu/playing/volum"
        one.send("/ping", 5)
        assert listens.wait_for("/pong") == one.wait_for("/pong") == [5]
        one.send("/playing/volume", 99.0)
        assert listens.wait_for("/playing/volume") == one.wait_for("/playing/volume") == [1.0]
    other.send("/subscribe", 30)  # it listens for itself from now on
    other.wait_for("/subscribed")
    other.send("/ping", 6)
    other.wait_for("/pong")
    speaks.send("/unsubscribe", listens.port)
    listens.wait_for("/unsubscribed")
    speaks.send("/ping", 7)
    speaks.wait_for("/pong")
    assert not [one for one in listens.all() if one.address == "/yehu/pong"]


def test_who_subscribes_and_hangs_up_at_once_is_no_subscriber(live, until, wire):
    stream = live.stream()
    packets = [wire.message("/yehu/note/off", 67)] * 3000
    stream.socket.sendall(b"".join(map(stream.wrap, packets)))
    stream.send("/subscribe", 3600)
    stream.close()
    until(lambda: live.handler.counts.messages == 3001, "all to be heard")
    until(lambda: live.ports.traffic.connections == 0, "the connection to be gone")
    live.wait_frames(4800)
    assert live.handler.clients.subscribers == 0


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0", "this machine's"])  # noqa: S104
def test_a_server_never_talks_to_itself(make_live, kit, until, host):
    live = make_live(osc=("127.0.0.1" if host == "127.0.0.1" else "0.0.0.0", 0))  # noqa: S104
    if host == "this machine's":
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
            with contextlib.suppress(OSError):
                any_socket.connect(("192.0.2.1", 9))  # sends nothing
            host = any_socket.getsockname()[0]
        if host in ("0.0.0.0", "127.0.0.1"):  # noqa: S104
            pytest.skip("this machine has no other address")
    client = kit.Client(live.ports.port, host if host != "0.0.0.0" else "127.0.0.1")  # noqa: S104
    client.send("/subscribe", 0.1, live.ports.port)
    time.sleep(0.2)
    until(lambda: are_still(live), "it to have said all")
    client.close()
    assert live.handler.counts.messages == 1  # the client's alone


def test_none_end_what_is_not_subscribed(still):
    for call, words in ("/unsubscribe", ()), ("/unsubscribe", (7400,)), ("/subscribe", (0,)):
        (refused,) = still.ask(call, *words)
        assert refused.arguments[1].startswith("nothing is subscribed")
    for begun, *ended in ((60, 7400), "/unsubscribe"), ((60,), "/subscribe", 0):
        still.ask("/subscribe", *begun)
        assert still.handler.clients.subscribers == 1
        assert "/yehu/unsubscribed" in [one.address for one in still.ask(*ended)]
        assert still.handler.clients.subscribers == 0


# ---------------------------------------------------------------- the status


def test_who_subscribes_to_the_status_is_sent_it_at_once_and_then_each_change(still):
    heard = values(still.ask("/subscribe/status", 2.0))
    assert heard.pop("/yehu/subscribed") == 2.0
    assert set(heard) == {f"/yehu/status/{value.name}" for value in STATUS}
    still.pass_time(0.5)
    assert still.peer.received() == []
    still.services.names.append("take")
    still.send("/playing/vibrato", 5.0)  # which it did not subscribe to
    still.pass_time(0.3)
    heard = values(still.peer.received())
    assert heard.pop("/yehu/playing/vibrato") == 5.0  # but is sent what it sets
    assert heard == {"/yehu/status/recording": "take"}
    assert still.handler.clients.subscribers == 1
    still.pass_time(2.0)
    still.services.names.append("another")
    still.pass_time(0.5)
    assert still.peer.received() == []
    assert still.handler.clients.subscribers == 0
