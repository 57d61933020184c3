"""Time tags by OSC: bundles keep their distances to the sample."""

import itertools
import re
import time
from collections import Counter

import pytest
from wire import errors

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.work_queue import Shares


@pytest.mark.parametrize("block", [128, 2048])
def test_bundles_keep_their_distances_to_the_sample_and_their_time(make_still, wire, block):
    still = make_still(block)
    still.send("/note", 72.0, 90.0)
    still.pass_time(0.2)
    still.events.clear()
    first = still.clock.time() + 0.1
    places = [0, 1, 2, 480, 483, 1000, 4801, 9600, 24000]
    for place in reversed(places):
        for call, value in ("/yehu/bow/position", 0.1), ("/yehu/bend", 0.5):
            packet = wire.message(call, value + place * 1e-5)
            still.take(wire.bundle(first + place / still.RATE, packet))
    assert still.handler.waiting == 2 * len(places)
    expected = still.instrument.frame_at(round(1e9 * (first - still.clock.since_1970)))
    still.pass_time(0.7)
    for address in ("/bow/position", "/finger/1/position"):
        frames = still.frames(address)
        assert [frame - frames[0] for frame in frames] == places
        assert abs(frames[0] - expected) <= still.RATE / 1000
    assert still.late() == 0
    assert still.handler.waiting == still.handler.counts.late_bundles == 0


def test_an_unknown_address_is_answered_before_its_time(still, wire):
    still.take(wire.bundle(still.clock.time() + 30.0, wire.message("/yehu/nots", 67, 90)))
    assert errors(still.peer.received()) == ["/yehu/nots"]
    assert still.handler.waiting == 0


def test_time_tags_minutes_ahead_are_told_once_with_their_sender(still, wire, caplog):
    for seconds in (30.0, 150.0, 200.0):
        packet = wire.message("/yehu/note", 67, 90)
        still.take(wire.bundle(still.clock.time() + seconds, packet))
    assert still.peer.received() == []
    still.take(wire.bundle(still.clock.time() + 2 * 86400.0, packet))
    (refused,) = still.peer.received()
    assert "172800 s ahead, more than an hour: is the clock right?" in refused.arguments[1]
    assert still.handler.waiting == 3
    (line,) = [each.getMessage() for each in caplog.records if "ahead" in each.getMessage()]
    assert re.search(r"time tags of \S+ are 1[45]\d s ahead", line)


def test_a_bundle_of_the_future_makes_no_other_message_wait(still, wire):
    still.pass_time(0.05)
    for number in range(1000):
        packet = wire.message("/yehu/note", 67, 90)
        still.take(wire.bundle(still.clock.time() + 1.0 + 0.01 * number, packet))
    arrived = still.instrument.frame_at(still.clock.monotonic_ns())
    still.send("/bow/position", 0.3)
    still.send("/note", 72, 90)
    still.pass_time(0.05)
    assert still.player.pitch == 72.0
    for address in ("/bow/position", "/bow/side"):
        frame = still.frames(address)[0]
        assert 0 <= frame - arrived <= still.player.delay + 1


# Bundles are handled so long before their time that what arrives then is heard before them.


def ahead_of_its_time(still, wire, *packets: bytes) -> float:
    """Let the packets of a bundle be handled some milliseconds ahead; return their frame."""
    due_s = still.clock.time() + 0.03
    still.take(wire.bundle(due_s, *packets))
    while still.handler.waiting:
        still.pass_time(0.001)
    return still.instrument.frame_at(round(1e9 * (due_s - still.clock.since_1970)))


@pytest.mark.parametrize(
    ("address", "moved"),
    [
        ("/playing/volume", "/output/level"),  # the player's
        ("/bow/position", "/bow/position"),  # player-controlled
        ("/body/blend", "/body/blend"),  # the engine's
    ],
)
def test_of_values_of_now_and_of_a_bundle_the_one_of_the_later_frame_stays(
    still, wire, address, moved
):
    still.pass_time(0.05)
    tagged = ahead_of_its_time(still, wire, wire.message("/yehu" + address, 0.25))
    arrived = still.instrument.frame_at(still.clock.monotonic_ns())
    still.send(address, 0.5)
    still.pass_time(0.05)
    first, second = still.frames(moved)
    assert 0 <= first - arrived <= still.player.delay + 1
    assert abs(second - tagged) <= still.RATE / 1000
    assert still.target(moved) == (0.25**2 if moved == "/output/level" else 0.25)


def test_a_bundle_that_comes_too_late_plays_at_once_and_is_counted(still, wire):
    still.pass_time(0.05)
    for lateness_s in (0.0, 0.001, 5.0, 1e9):
        still.take(wire.bundle(still.clock.time() - lateness_s, wire.message("/yehu/note", 67, 90)))
    assert still.handler.counts.late_bundles == 4
    assert still.handler.waiting == 0
    still.pass_time(0.01)
    assert still.player.pitch == 67.0


def test_when_too_much_waits_it_is_reported_and_the_rest_plays(still, wire, monkeypatch):
    shares = Shares(20 * (limits.OVERHEAD + 28))
    monkeypatch.setattr(still.handler._schedule, "_shares", shares)
    later = still.clock.time() + 0.1
    for number in range(12):
        packet = wire.message("/yehu/bow/position", 0.1 + 0.01 * number)
        still.take(wire.bundle(later + 0.001 * number, packet))
    assert errors(still.peer.received()) == ["/yehu/bow/position"] * 2
    still.pass_time(0.3)
    assert len(still.frames("/bow/position")) == 10


def test_bundles_to_a_real_server_keep_their_distances(live, wire, until):
    client = live.client()
    for _ in range(8):  # on a busy machine the silent clock stumbles
        live.settle()
        late = live.handler.counts.late_bundles
        first = time.time() + 0.5
        for number in range(50):
            packet = wire.message("/yehu/bow/position", 0.1 + 0.001 * number)
            client.take(wire.bundle(first + 0.005 * number, packet))
        client.send("/bow/force", 1.0)
        assert client.wait_for("/bow/force") == [1.0]  # at once
        assert live.handler.waiting > 0
        until(lambda: not live.handler.waiting, "all to be due")
        moves = [frame for frame, address, _ in live.settle() if address == "/bow/position"]
        assert len(moves) == 50
        steps = Counter(after - before for before, after in itertools.pairwise(moves))
        if steps[240] > 24 and live.handler.counts.late_bundles == late:
            break
    else:
        pytest.fail(f"{steps}")
    client.take(wire.bundle(time.time() - 1.0, wire.message("/yehu/ping", 5)))
    assert client.wait_for("/pong") == [5]
    assert live.handler.counts.late_bundles == late + 1
