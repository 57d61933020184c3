"""Who is sent what: echoes, changes, errors, and how often."""

from collections import Counter
from types import SimpleNamespace

import pytest
from wire import FakePeer

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.change_publisher import MESSAGES_A_STEP
from yehu_server.live.osc.clients import SLICE_S, Clients


@pytest.fixture
def values() -> SimpleNamespace:
    """Some parameters."""
    return SimpleNamespace(now={"/a": 0.0, "/b": 0.0, "/c": 0.0})


@pytest.fixture
def clients(still_time, values) -> Clients:  # noqa: ARG001 - its clock stands still
    return Clients(lambda _group="": dict(values.now), "/yehu")


@pytest.fixture
def play(still_time, clients):
    """Let time pass, in milliseconds; something may happen in each."""

    def play(ms: int, happens=lambda: None) -> None:
        for _ in range(ms):
            still_time.now += 0.001
            happens()
            clients.flush()

    return play


def sent_to(peer) -> list[tuple[str, list[float]]]:
    return [(message.address, message.arguments) for message in peer.received()]


def test_another_server_that_tells_us_its_values_is_not_answered_for_as_long(
    clients, values, play, peer
):
    clients.mute(peer, 0.5)
    for _ in range(4):
        clients.echo(peer, ["/a"])
        clients.send_error(peer, "/x", "unknown")
        play(100)
    assert sent_to(peer) == []
    clients.subscribe(peer, 10.0)  # it still gets what it asks for
    values.now["/a"] = 1.0
    play(20)
    assert ("/yehu/a", [1.0]) in sent_to(peer)
    play(200)
    clients.echo(peer, ["/b"])
    play(20)
    assert sent_to(peer) == [("/yehu/b", [0.0])]


# ---------------------------------------------------------------- echoes


def test_who_sets_something_is_sent_its_value_once(clients, values, play, peer):
    other = FakePeer(2)
    values.now["/a"] = 0.5
    assert clients.wait_s() is None
    clients.echo(peer, ["/a"])
    assert 0.0 <= clients.wait_s() <= 1.0 / 60.0
    play(100)
    assert sent_to(peer) == [("/yehu/a", [0.5])]
    assert sent_to(other) == []
    play(100)
    assert sent_to(peer) == []
    assert clients.wait_s() is None


def test_many_who_set_something_at_once_are_all_answered(clients, play):
    peers = [FakePeer(port) for port in range(limits.PEERS + 100)]
    for peer in peers:
        clients.echo(peer, ["/a"])
    play(17)
    assert sum(len(peer.packets) for peer in peers) in (
        limits.CHANGES_AT_ONCE,
        2 * limits.CHANGES_AT_ONCE,
    )
    play(60)
    assert {len(peer.packets) for peer in peers} == {1}


def test_all_hear_in_turn_where_there_is_more_to_say_than_goes(clients, values, play):
    peers = [FakePeer(port) for port in range(40)]
    values.now = {f"/{number}": 0.0 for number in range(limits.CHANGES_AT_ONCE // 10)}
    for peer in peers:
        assert clients.subscribe(peer, 60.0)
    play(1000)
    for peer in peers:
        peer.packets.clear()

    def turn() -> None:
        values.now = {address: value + 1.0 for address, value in values.now.items()}

    play(1000, turn)
    counts = [len(peer.packets) for peer in peers]
    assert sum(counts) <= 61 * limits.CHANGES_AT_ONCE
    assert min(counts) > 0.8 * max(counts)


# ---------------------------------------------------------------- changes


def test_a_subscriber_is_sent_all_and_then_what_changes(clients, values, play, peer):
    assert clients.subscribe(peer, 10.0)
    play(20)
    assert sent_to(peer) == [("/yehu/a", [0.0]), ("/yehu/b", [0.0]), ("/yehu/c", [0.0])]
    play(100)
    assert sent_to(peer) == []
    values.now["/b"] = 1.0
    play(100)
    assert sent_to(peer) == [("/yehu/b", [1.0])]


def test_a_subscriber_is_sent_a_value_sixty_times_a_second_at_most(clients, values, play, peer):
    def turn() -> None:
        values.now["/a"] += 1.0
        values.now["/b"] -= 1.0
        clients.echo(peer, ["/a"])

    clients.subscribe(peer, 10.0)
    play(20)
    peer.received()
    play(1000, turn)
    play(20)
    heard = sent_to(peer)
    counts = Counter(address for address, _ in heard)
    assert 50 <= min(counts.values()) <= max(counts.values()) <= 61
    assert heard[-2:] == [("/yehu/a", [1000.0]), ("/yehu/b", [-1000.0])]


def test_a_subscription_is_renewed_and_not_doubled_and_ends(clients, values, play, peer):
    for _ in range(2):
        clients.subscribe(peer, 0.5)
        play(400)
    assert clients.subscribers == 1
    peer.received()
    values.now["/a"] = 1.0
    play(50)
    assert sent_to(peer) == [("/yehu/a", [1.0])]
    play(100)
    assert clients.subscribers == 0
    values.now["/a"] = 2.0
    play(100)
    assert sent_to(peer) == []
    assert clients.wait_s() is None


@pytest.mark.parametrize("end", [Clients.unsubscribe, Clients.forget])
def test_who_unsubscribes_or_is_gone_is_sent_no_more(clients, values, play, peer, end):
    clients.subscribe(peer, 10.0)
    play(20)
    peer.received()
    end(clients, peer)
    values.now["/a"] = 1.0
    play(100)
    assert sent_to(peer) == []
    assert clients.subscribers == 0


def test_there_is_room_for_so_many_subscribers_and_for_more_when_some_are_gone(clients, play):
    peers = [FakePeer(port) for port in range(limits.SUBSCRIBERS + 1)]
    assert all(clients.subscribe(peer, 1.0) for peer in peers[:-1])
    assert not clients.subscribe(peers[-1], 1.0)
    assert clients.subscribe(peers[0], 1.0)  # a subscriber keeps its place
    clients.unsubscribe(peers[3])
    assert clients.subscribe(peers[-1], 1.0)
    play(1100)
    assert clients.subscribers == 0
    tenants = [FakePeer(port, "192.0.2.1") for port in range(limits.SUBSCRIBERS_A_HOST + 1)]
    assert [clients.subscribe(peer, 60.0) for peer in tenants].count(
        True
    ) == limits.SUBSCRIBERS_A_HOST
    assert clients.subscribe(FakePeer(7), 60.0)  # one host leaves places for others
    clients.unsubscribe(tenants[0])
    assert clients.subscribe(tenants[-1], 60.0)


def test_only_so_many_are_remembered_and_subscribers_not_forgotten_for_them(
    clients, values, play, peer
):
    clients.subscribe(peer, 10.0)
    play(20)
    peer.received()
    for port in range(2, 3 * limits.PEERS):
        clients.send_error(FakePeer(port), "/x", "no")
        assert len(clients._clients) <= limits.PEERS
    values.now["/a"] = 1.0
    play(20)
    assert sent_to(peer) == [("/yehu/a", [1.0])]


# ---------------------------------------------------------------- errors


def test_errors_are_reported_with_their_reason_and_rarely_to_who_makes_many(clients, play, peer):
    patient = FakePeer(2)
    play(10_000, lambda: clients.send_error(peer, "/x", "no"))
    assert 100 <= len(peer.packets) <= 125
    assert all(heard == ("/yehu/error", ["/x", "no"]) for heard in sent_to(peer))
    clients.send_error(patient, "/x", "no")
    assert len(patient.packets) == 1  # others need not wait
    play(5000)
    clients.send_error(peer, "/x", "no")
    assert len(peer.packets) == 1


# ---------------------------------------------------------------- in slices


class Slow(FakePeer):
    """A peer that it takes a quarter of a slice to send to."""

    def __init__(self, clock, port: int = 2) -> None:
        super().__init__(port)
        self._clock = clock

    def send(self, *packets: bytes) -> None:
        self._clock.now += 0.25 * SLICE_S * len(packets)
        super().send(*packets)


def test_who_is_sent_much_is_sent_in_slices_between_which_others_are_served(
    clients, values, still_time
):
    slow = Slow(still_time)
    values.now = {f"/{number}": float(number) for number in range(100)}
    clients.subscribe(slow, 60.0)
    still_time.now += 1.0
    flushes = 0
    while clients.wait_s() == 0.0:
        before = len(slow.packets)
        clients.flush()
        flushes += 1
        assert len(slow.packets) - before <= 2 * MESSAGES_A_STEP
    assert sent_to(slow) == [(f"/yehu/{number}", [float(number)]) for number in range(100)]
    assert flushes >= 100 // (2 * MESSAGES_A_STEP)
    assert clients.wait_s() > 0.0  # until the next round


@pytest.mark.parametrize("end", ["ignore", "forget"])
def test_what_is_ended_between_slices_is_sent_no_more(clients, values, still_time, end):
    slow = Slow(still_time)
    values.now = {f"/{number}": 0.0 for number in range(100)}
    for address in values.now:
        clients.listen(slow, address)
    still_time.now += 1.0
    clients.flush()
    assert 0 < len(slow.packets) < 10
    slow.packets.clear()
    if end == "forget":
        clients.forget(slow)
        clients.listen(slow, "/99")
    else:
        for number in range(99):
            clients.ignore(slow, f"/{number}")
    for _ in range(100):
        still_time.now += 0.001
        clients.flush()
    assert sent_to(slow) == [("/yehu/99", [0.0])]


# ---------------------------------------------------------------- listeners


def test_a_listener_is_sent_its_address_now_and_once_for_each_change(clients, values, play, peer):
    clients.listen(peer, "/status/none")
    clients.ignore(peer, "/status/none")
    clients.listen(peer, "/b")
    play(20)
    assert sent_to(peer) == [("/yehu/b", [0.0])]
    values.now |= {"/a": 1.0, "/b": 2.0}
    clients.echo(peer, ["/b"])
    play(50)
    assert sent_to(peer) == [("/yehu/b", [2.0])]
    play(1000)
    values.now["/b"] = 3.0
    clients.ignore(peer, "/b")
    play(20)
    assert sent_to(peer) == []


def test_the_status_is_looked_at_only_for_listeners_and_seldom(still_time, values, peer):
    readings = []

    def status(_group: str) -> dict[str, float | str]:
        readings.append(still_time.now)
        return {"load": float(len(readings)), "device": "null"}

    clients = Clients(lambda _group="": dict(values.now), "/yehu", status)
    clients.subscribe(peer, 60.0)

    def play(ms: int) -> None:
        for _ in range(ms):
            still_time.now += 0.001
            clients.flush()

    play(1000)
    assert readings == []
    sent_to(peer)
    clients.listen(peer, "/status/load")
    clients.listen(peer, "/status/device")
    play(20)
    assert sorted(sent_to(peer)) == [
        ("/yehu/status/device", ["null"]),
        ("/yehu/status/load", [1.0]),
    ]
    play(1000)
    assert 3 <= len(readings) - 1 <= 5
    assert {address for address, _ in sent_to(peer)} == {"/yehu/status/load"}


def test_who_has_nothing_to_hear_is_forgotten(clients, play, peer):
    clients.subscribe(FakePeer(2), 1.0)
    clients.listen(FakePeer(3), "/a")
    clients.echo(peer, ["/a"])
    clients.send_error(FakePeer(4), "/x", "why")
    play(20)
    assert len(clients._clients) == 4
    play(4000)
    assert [peer.port for peer in clients._clients] == [3]
