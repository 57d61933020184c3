"""Time tags by OSC: bundles keep their distances to the sample."""

from __future__ import annotations

import itertools
import time
from collections import Counter

import pytest
from wire import errors

from yehu_server.live.osc.limits import OVERHEAD_BYTES, MemoryQuota


def test_bundles_keep_their_distances_to_the_sample_and_their_time(stage, wire):
    stage.pass_time(0.05)
    first = stage.clock.time() + 0.1
    places = [0, 1, 2, 480, 483, 1000, 4801, 9600, 24000]
    for place in reversed(places):
        packet = wire.message("/yehu/bow/position", 0.1 + place * 1e-6)
        stage.take(wire.bundle(first + place / stage.RATE, packet))
    assert stage.handler.waiting == len(places)
    expected = stage.instrument.frame_at(round(1e9 * (first - stage.clock.since_1970)))
    stage.pass_time(0.7)
    frames = stage.frames("/bow/position")
    assert [frame - frames[0] for frame in frames] == places
    assert abs(frames[0] - expected) <= stage.RATE / 1000
    assert stage.late() == 0
    assert stage.handler.waiting == stage.handler.counts.late_bundles == 0


def test_notes_of_bundles_keep_their_distances_beside_notes_of_now(stage, wire):
    stage.pass_time(0.05)
    first = stage.clock.time() + 0.1
    for number in range(40):
        packet = wire.message("/yehu/note", 66.0 + number % 20, 90.0)
        stage.take(wire.bundle(first + 0.01 * number, packet))
    for number in range(60):
        stage.tell("/bend", 0.01 * (number % 7))
        stage.pass_time(0.01)
    frames = sorted(set(stage.frames("/vibrato/onset")))  # begins anew with each note
    assert len(frames) == 40
    assert {after - before for before, after in itertools.pairwise(frames)} == {480}
    assert stage.late() == 0


@pytest.mark.parametrize("block", [512, 1024, 2048])
@pytest.mark.parametrize("address", ["/bow/position", "/bend"])
def test_bundles_keep_their_distances_whatever_the_block(stage_type, wire, block, address):
    stage = stage_type(block)
    stage.tell("/note", 72.0, 90.0)
    stage.pass_time(0.2)
    stage.events.clear()
    first = stage.clock.time() + 0.1
    places = [331 * number for number in range(60)]
    for place in places:
        packet = wire.message("/yehu" + address, 0.5 + place * 1e-5)
        stage.take(wire.bundle(first + place / stage.RATE, packet))
    stage.pass_time(0.7)
    frames = stage.frames({"/bend": "/finger/1/position"}.get(address, address))
    assert [frame - frames[0] for frame in frames] == places
    assert stage.late() == 0


def test_a_bundle_of_the_future_makes_no_other_message_wait(stage, wire):
    stage.pass_time(0.05)
    for number in range(1000):
        packet = wire.message("/yehu/note", 67, 90)
        stage.take(wire.bundle(stage.clock.time() + 1.0 + 0.01 * number, packet))
    arrived = stage.instrument.frame_at(stage.clock.monotonic_ns())
    stage.tell("/bow/position", 0.3)
    stage.tell("/note", 72, 90)
    stage.pass_time(0.05)
    assert stage.player.pitch == 72.0
    for address in ("/bow/position", "/bow/side"):
        frame = stage.frames(address)[0]
        assert 0 <= frame - arrived <= stage.player.delay + 1


# Bundles are handled so long before their time that what arrives then is heard before them.


def ahead_of_its_time(stage, wire, *packets: bytes) -> float:
    """Let the packets of a bundle be handled some milliseconds ahead; return their frame."""
    due_s = stage.clock.time() + 0.03
    stage.take(wire.bundle(due_s, *packets))
    while stage.handler.waiting:
        stage.pass_time(0.001)
    return stage.instrument.frame_at(round(1e9 * (due_s - stage.clock.since_1970)))


def test_a_note_of_now_waits_for_no_note_that_a_bundle_has_sent_ahead(stage, wire):
    stage.pass_time(0.05)
    tagged = ahead_of_its_time(stage, wire, wire.message("/yehu/note", 74, 90))
    arrived = stage.instrument.frame_at(stage.clock.monotonic_ns())
    stage.tell("/note", 67, 90)
    assert tagged - arrived > stage.player.delay + 48
    stage.pass_time(0.05)
    first, second = sorted(set(stage.frames("/vibrato/onset")))  # begins anew with each note
    assert 0 <= first - arrived <= stage.player.delay + 1
    assert abs(second - tagged) <= stage.RATE / 1000
    assert stage.player.pitch == 74.0
    assert stage.late() == 0


@pytest.mark.parametrize(
    ("address", "moved"),
    [
        ("/playing/volume", "/output/level"),  # the player's
        ("/bow/position", "/bow/position"),  # owned
        ("/body/blend", "/body/blend"),  # the engine's
    ],
)
def test_of_values_of_now_and_of_a_bundle_the_one_of_the_later_frame_stays(
    stage, wire, address, moved
):
    stage.pass_time(0.05)
    tagged = ahead_of_its_time(stage, wire, wire.message("/yehu" + address, 0.25))
    arrived = stage.instrument.frame_at(stage.clock.monotonic_ns())
    stage.tell(address, 0.5)
    stage.pass_time(0.05)
    first, second = stage.frames(moved)
    assert 0 <= first - arrived <= stage.player.delay + 1
    assert abs(second - tagged) <= stage.RATE / 1000
    assert stage.target(moved) == (0.25**2 if moved == "/output/level" else 0.25)


def test_a_bundle_that_comes_too_late_plays_at_once_and_is_counted(stage, wire):
    stage.pass_time(0.05)
    for lateness_s in (0.0, 0.001, 5.0, 1e9):
        stage.take(wire.bundle(stage.clock.time() - lateness_s, wire.message("/yehu/note", 67, 90)))
    assert stage.handler.counts.late_bundles == 4
    assert stage.handler.waiting == 0
    stage.pass_time(0.01)
    assert stage.player.pitch == 67.0


def test_a_bundle_for_at_once_is_not_late(stage, wire):
    stage.take(wire.bundle(None, wire.message("/yehu/note", 67, 90)))
    stage.pass_time(0.01)
    assert stage.player.pitch == 67.0
    assert stage.handler.counts.late_bundles == 0


def test_messages_of_a_bundle_are_heard_at_one_frame_and_in_order(stage, wire):
    stage.pass_time(0.05)
    packets = [wire.message("/yehu/bow/position", 0.1 + 0.01 * number) for number in range(20)]
    stage.take(wire.bundle(stage.clock.time() + 0.1, *packets))
    stage.pass_time(0.2)
    moves = [(frame, value) for frame, address, value in stage.events if "position" in address]
    assert len({frame for frame, _ in moves}) == 1
    assert [value for _, value in moves] == sorted(value for _, value in moves)
    assert len(moves) == 20


def test_when_too_much_waits_it_is_told_and_the_rest_plays(stage, wire, monkeypatch):
    monkeypatch.setattr(stage.handler._schedule, "_quota", MemoryQuota(13 * (OVERHEAD_BYTES + 28)))
    later = stage.clock.time() + 0.1
    for number in range(12):
        packet = wire.message("/yehu/bow/position", 0.1 + 0.01 * number)
        stage.take(wire.bundle(later + 0.001 * number, packet))
    assert errors(stage.ear.heard()) == ["/yehu/bow/position"] * 2
    stage.pass_time(0.3)
    assert len(stage.frames("/bow/position")) == 10


def test_errors_in_bundles_are_told_when_their_time_comes(stage, wire):
    stage.take(wire.bundle(stage.clock.time() + 0.1, wire.message("/yehu/nothing")))
    stage.pass_time(0.05)
    assert errors(stage.ear.heard()) == []
    stage.pass_time(0.1)
    assert errors(stage.ear.heard()) == ["/yehu/nothing"]


def test_bundles_to_a_real_server_keep_their_distances(hall, wire):
    client = hall.client()
    steps: Counter[int] = Counter()
    for _ in range(3):  # on a busy machine even the silent clock may stumble
        hall.settle()
        first = time.time() + 0.1
        for number in range(50):
            packet = wire.message("/yehu/bow/position", 0.1 + 0.001 * number)
            client.take(wire.bundle(first + 0.005 * number, packet))
        client.tell("/bow/force", 1.0)
        assert client.wait_for("/bow/force") == [1.0]  # at once
        assert hall.handler.waiting > 0
        time.sleep(0.4)
        moves = [frame for frame, address, _ in hall.settle() if address == "/bow/position"]
        assert len(moves) == 50
        steps = Counter(after - before for before, after in itertools.pairwise(moves))
        if steps == {240: 49}:
            break
    assert steps.most_common(1)[0][0] == 240
    assert steps[240] >= 40
    assert hall.handler.counts.late_bundles == 0
    client.take(wire.bundle(time.time() - 1.0, wire.message("/yehu/ping", 5)))
    assert client.wait_for("/pong") == [5]
    assert hall.handler.counts.late_bundles == 1
