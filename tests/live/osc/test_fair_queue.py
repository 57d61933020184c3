"""The queue of packets: a sender's in order, senders in turn; how much one holds, how often."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wire import FakePeer

from yehu_server.live.osc import fair_queue
from yehu_server.live.osc.fair_queue import (
    LITTLE_BYTES,
    LONG_BYTES,
    MOST_BYTES,
    OVERHEAD_BYTES,
    SLICE_NS,
    TURN_NS,
    FairQueue,
    MemoryQuota,
)
from yehu_server.util.token_bucket import TokenBucket

SHORT_NS, LONG_NS = SLICE_NS // 100, SLICE_NS + SLICE_NS // 2


class Clock:
    """Advances with each step of work; stands in for the module ``time``."""

    def __init__(self) -> None:
        self.now_ns = 0

    def monotonic_ns(self) -> int:
        return self.now_ns


@dataclass(frozen=True)
class Named:
    """A peer, named by its host and, after an @, its port."""

    name: str

    @property
    def host(self) -> str:
        return self.name.partition("@")[0]


class Done:
    """Records what is handled; a packet takes one step for each letter, a long one for capitals."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.steps: list[str] = []
        self.queue = FairQueue(self._handle)

    def _handle(self, packet: str, peer: Named, arrived_ns: int) -> Iterator[None]:
        del arrived_ns
        for letter in packet:
            if letter == "!":
                raise RuntimeError("as asked")
            if letter == "0":
                self.queue.clear()
            self.clock.now_ns += LONG_NS if letter.isupper() else SHORT_NS
            self.steps.append(peer.name + letter)
            yield

    def add(self, peer: str, letters: str, size: int = 0) -> bool:
        return self.queue.add(letters, Named(peer), 0, size)

    def work(self) -> str:
        """Handle everything; return what was handled, in order."""
        for _ in range(10_000):
            if not self.queue:
                break
            self.queue.work()
        return " ".join(self.steps)


@pytest.fixture
def done(monkeypatch) -> Done:
    clock = Clock()
    monkeypatch.setattr(fair_queue, "time", clock)
    return Done(clock)


def test_what_is_large_waits_for_what_is_small(done):
    done.add("1", "a", LONG_BYTES + 1)
    done.add("2", "b", LONG_BYTES)
    assert done.work() == "2b 1a"


def test_peers_are_heard_in_turn_and_what_is_long_goes_on_after_the_others(done):
    for said, order in [
        ([("1", "ab"), ("2", "c"), ("3", "d")], "1a 1b 2c 3d"),
        ([("1", "ABC"), ("1", "d"), ("2", "e")], "1A 2e 1B 1C 1d"),
    ]:
        done.steps.clear()
        for words in said:
            done.add(*words)
        assert done.work() == order


def test_no_more_is_done_at_a_time_than_a_turn_takes(done):
    for peer in "12345678":
        done.add(peer, "ABC")
    done.queue.work()
    assert len(done.steps) == -(-TURN_NS // LONG_NS)


@pytest.mark.parametrize("crowd", [["flood"], [f"here@{port}" for port in range(100)]])
@pytest.mark.parametrize("size", [0, 16_000])
def test_who_sends_little_is_heard_soon_whatever_others_have_waiting(done, crowd, size):
    for peer in crowd:
        for _ in range(4000 // len(crowd)):
            done.add(peer, "A", size)
    while len(done.steps) < 250:  # by then all have had a turn
        done.queue.work()
    for _ in range(20):
        done.steps.clear()
        for letter in "abc":
            done.add("here@player", letter)
        done.queue.work()
        ended = done.steps.index("here@playerc")
        assert done.steps[ended - 2 : ended] == ["here@playera", "here@playerb"]
        assert ended <= 2 + 2  # one turn of each other line


def test_no_crowd_of_those_who_send_little_keeps_one_with_much_to_do_waiting(done):
    done.add("much", "A" * 20, 2000)
    for _ in range(20):
        for port in range(50):  # more than can be handled
            done.add(f"crowd@{port}", "A")
        done.queue.work()
    assert done.steps.count("muchA") == 20


def test_many_ports_of_one_host_get_no_more_turns_than_one_of_another(done):
    for port in range(50):
        done.add(f"crowd@{port}", "ABCD")
    done.add("other", "ABCDE")
    steps = done.work().split()
    assert steps.index("otherE") < 20


@given(st.lists(st.tuples(st.sampled_from("123"), st.text("abA", max_size=3), st.booleans())))
def test_what_one_peer_says_keeps_its_order_whoever_else_speaks(said):
    with pytest.MonkeyPatch.context() as patch:
        clock = Clock()
        patch.setattr(fair_queue, "time", clock)
        done = Done(clock)
        for peer, letters, is_large in said:
            done.add(peer, letters, 2000 if is_large else 0)
        done.work()
    for peer in "123":
        letters = "".join(step[1] for step in done.steps if step[0] == peer)
        assert letters == "".join(text for one, text, _ in said if one == peer)
    assert (len(done.queue), done.queue.bytes) == (0, 0)


def test_what_is_dropped_is_not_done_and_leaves_its_room(done):
    done.add("1", "ABC")
    done.add("1", "d")
    done.add("2", "e", 2000)
    done.add("2", "f")
    done.queue.work()
    done.queue.drop(lambda packet: packet in ("ABC", "f"))
    before = len(done.steps)
    assert done.work().split()[before:] == ["1d"]
    assert (len(done.queue), done.queue.bytes) == (0, 0)


def test_one_may_drop_all_that_waits_while_it_is_done(done):
    done.add("1", "a0b")
    done.add("1", "c")
    done.add("2", "d")
    assert done.work() == "1a 10 1b"
    assert (len(done.queue), done.queue.bytes) == (0, 0)
    done.add("1", "e")
    assert done.work().split()[3:] == ["1e"]


def test_what_goes_wrong_is_not_tried_again_and_loses_nothing_else(done):
    for peer, letters in (("1", "Aa!b"), ("1", "c"), ("2", "!"), ("2", "d")):
        done.add(peer, letters)
    for _ in range(50):
        try:
            done.work()
        except RuntimeError:
            continue
    assert sorted(done.steps) == ["1A", "1a", "1c", "2d"]
    assert (len(done.queue), done.queue.bytes) == (0, 0)


# ---------------------------------------------------------------- room


def fill(queue: FairQueue, peers: list[str], size: int) -> int:
    """Add packets of peers in turn until there is room for none; return the bytes they hold."""
    before = queue.bytes
    while sum(queue.add("", Named(peer), 0, size - OVERHEAD_BYTES) for peer in peers):
        pass
    return queue.bytes - before


def test_one_peer_gets_half_of_the_room_and_other_hosts_the_more_the_fewer_they_are(done):
    shares = [fill(done.queue, [peer], 16_000) / MOST_BYTES for peer in "1234"]
    assert shares == pytest.approx([1 / 2, 1 / 4, 1 / 8, 1 / 16], abs=0.01)
    done.work()
    assert done.queue.bytes == 0
    assert not done.queue._quota._by_peer
    assert not done.queue._quota._by_host


@pytest.mark.parametrize("size", [LITTLE_BYTES, 16_256])
def test_who_has_little_waiting_finds_room_beside_all_ports_of_its_host_and_so_does_another_host(
    done, size
):
    crowd = [f"here@{port}" for port in range(500)]
    assert fill(done.queue, crowd, size) < 0.67 * MOST_BYTES
    assert done.add("here@player", "note", 28)
    little = fill(done.queue, [f"here@{port}" for port in range(10**4)], 300)
    assert 0.1 * MOST_BYTES < little < 0.2 * MOST_BYTES
    assert done.add("there", "note", 16_000)


def test_a_burst_is_allowed_and_after_it_what_each_second_brings():
    bucket = TokenBucket(2.0, 5.0)
    assert [bucket.takes(1000.0) for _ in range(7)] == [True] * 5 + [False] * 2
    assert [bucket.takes(1001.0) for _ in range(4)] == [True] * 2 + [False] * 2
    assert [bucket.takes(1e6) for _ in range(7)] == [True] * 5 + [False] * 2
    # Who spends more than there is waits until it is gained again.
    bucket = TokenBucket(10.0, 20.0)
    assert bucket.left(0.0) == 20.0
    bucket.spend(30.0)
    assert [bucket.left(now) for now in (0.5, 1.0, 1.5)] == [-5.0, 0.0, 5.0]


def test_there_is_always_room_for_a_peer_that_is_limited_otherwise():
    quota = MemoryQuota(1000)
    assert quota.take(FakePeer(1), 400)
    assert not quota.take(FakePeer(2), 700)
    assert quota.take(FakePeer(2), 700, always=True)
    assert quota.taken_bytes == 1100
