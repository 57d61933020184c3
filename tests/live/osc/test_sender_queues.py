"""Each sender of OSC has a queue of the callback to itself, as long as there are enough."""

from collections import Counter

from wire import FakePeer

from yehu_server.core.engine.mailbox import SENDER_QUEUES
from yehu_server.live.osc.sender_queues import (
    CROWDED,
    OF_CROWDERS,
    OF_OTHERS,
    QUIET_S,
    SenderQueues,
)
from yehu_server.playing.player import SENDER

RATE = 48000
QUIET = round(QUIET_S * RATE)
OWN = SENDER_QUEUES - 2
PEERS = [FakePeer(port) for port in range(OWN + 5)]


class Part:
    """A part whose instrument has events waiting in some queues."""

    rate = RATE

    def __init__(self) -> None:
        self.queues: Counter[int] = Counter()  # how many events wait in each

    def waiting(self, sender: int) -> int:
        return self.queues[sender]


def test_senders_have_a_queue_each_and_keep_it_and_those_beyond_share_one():
    queues = SenderQueues([Part()])
    found = [queues.queue_of(peer, 0) for peer in PEERS]
    assert sorted(found[:OWN]) == list(range(1, OWN + 1))
    assert found[OWN:] == [OF_OTHERS] * 5
    assert [queues.queue_of(peer, 100) for peer in PEERS[:OWN]] == found[:OWN]


def test_the_queue_of_who_was_quiet_for_longest_goes_to_the_next_once_it_is_drained():
    parts = [Part(), Part()]
    queues = SenderQueues(parts)
    first = [queues.queue_of(PEERS[n], n) for n in range(OWN)]
    queues.queue_of(PEERS[0], 50)  # so that 1 is the quiet one
    parts[1].queues[first[1]] = 1
    assert queues.queue_of(PEERS[OWN], QUIET) == OF_OTHERS  # it was heard a moment ago
    assert queues.queue_of(PEERS[OWN], QUIET + 2) == OF_OTHERS  # it has something waiting
    parts[1].queues.clear()
    assert queues.queue_of(PEERS[OWN], QUIET + 2) == first[1]
    assert queues.queue_of(PEERS[1], QUIET + 3) == first[2]
    assert queues.queue_of(PEERS[0], QUIET + 3) == first[0]


def test_those_who_crowd_the_queue_of_others_have_another_until_it_is_empty():
    part = Part()
    queues = SenderQueues([part])
    _, *flooding, honest = [peer for peer in PEERS if queues.queue_of(peer, 0) == OF_OTHERS]

    def send() -> tuple[set[int], int]:
        floods = {queues.queue_of(peer, 0) for _ in range(20) for peer in flooding}
        return floods, queues.queue_of(honest, 0)

    part.queues[OF_OTHERS] = CROWDED
    assert send() == ({OF_OTHERS}, OF_OTHERS)
    part.queues.update({OF_OTHERS: 1, OF_CROWDERS: 1})
    assert send() == ({OF_CROWDERS}, OF_OTHERS)
    part.queues[OF_OTHERS] = 0
    assert send() == ({OF_CROWDERS}, OF_OTHERS)
    part.queues.clear()
    assert send() == ({OF_OTHERS}, OF_OTHERS)


def test_what_a_sender_plays_waits_in_its_queue_at_once_or_ahead(still, wire, monkeypatch):
    posted = []
    post = still.instrument.post

    def record(kind: int, **event) -> bool:
        posted.append(event["sender"])
        return post(kind, **event)

    monkeypatch.setattr(still.instrument, "post", record)
    one, other = FakePeer(1), FakePeer(2)
    note = wire.message("/yehu/note", 67, 90)
    for peer in (one, other, one):
        still.take(note, peer)
    still.take(wire.bundle(still.clock.time() + 0.1, note), other)
    assert posted == [1, 2, 1]
    still.pass_time(0.2)
    assert posted == [1, 2, 1, 2]
    assert SENDER.get() == 0


def test_messages_of_all_that_are_due_take_turns(still, wire):
    note, due_s = wire.message("/yehu/note", 67, 90), still.clock.time() + 0.1
    one, other = FakePeer(1), FakePeer(2)
    still.take(wire.bundle(due_s, *[note] * 200), one)
    still.take(wire.bundle(due_s + 0.001, note), other)
    still.clock.now += 0.1
    peers = [peer for _, peer, _ in still.handler.due()]
    assert peers == [*[one] * 200, other]
