"""The queue of work: a sender's in order, senders in turn; how much one holds."""

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from wire import FakePeer

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.work_queue import (
    LONGEST_IN_ORDER_NS,
    SLICE_NS,
    TURN_NS,
    Shares,
    WorkQueue,
)
from yehu_server.system import clocks

SHORT_NS, LONG_NS = SLICE_NS // 100, SLICE_NS + SLICE_NS // 2
ONE, TWO, THREE = (FakePeer(port) for port in (1, 2, 3))
BESIDE = FakePeer(4, ONE.host)


class Done:
    """Records what is done: a step for each letter, a long one for capitals.

    It stands in for the module ``time``, too, whose clock advances with each step.
    """

    def __init__(self) -> None:
        self.now_ns = 0
        self.steps: list[str] = []
        self.queue = WorkQueue()

    def monotonic_ns(self) -> int:
        return self.now_ns

    def _steps(self, letters: str, peer: FakePeer) -> Iterator[None]:
        for letter in letters:
            if letter == "!":
                raise RuntimeError("as asked")
            self.now_ns += LONG_NS if letter.isupper() else SHORT_NS
            self.steps.append(f"{peer.port}{letter}")
            yield

    def add(self, peer: FakePeer, letters: str, size: int = 0) -> bool:
        return self.queue.add(self._steps(letters, peer), peer, size)

    def work(self) -> str:
        """Do everything; return what was done, in order."""
        while self.queue:
            self.queue.work()
        return " ".join(self.steps)


@pytest.fixture
def done(monkeypatch) -> Done:
    done = Done()
    monkeypatch.setattr(clocks, "monotonic_ns", done.monotonic_ns)
    return done


def test_senders_take_turns_and_what_is_long_goes_on_after_the_others(done):
    for said, order in [
        ([(ONE, "ab"), (TWO, "c"), (THREE, "d")], "1a 1b 2c 3d"),
        ([(ONE, "ABC"), (ONE, "d"), (TWO, "e")], "1A 2e 1B 1C 1d"),
    ]:
        done.steps.clear()
        for words in said:
            done.add(*words)
        assert done.work() == order


def test_what_one_host_sends_from_several_ports_keeps_its_order_unless_one_sends_much(done):
    left, right = (FakePeer(port, "here") for port in (1, 2))
    for number in range(40):
        done.add(left, "a" if number < 39 else "b")
        done.add(right, "a" if number < 39 else "c")
    assert done.work() == "1a 2a " * 39 + "1b 2c"
    done.steps.clear()
    for much, soon in [(["A"] * 4000, 1), (["A" * 100], LONGEST_IN_ORDER_NS // LONG_NS + 1)]:
        for letters in much:
            done.add(left, letters)
        done.add(right, "b")
        done.add(left, "c")
        done.work()
        assert done.steps.index("2b") <= soon
        assert done.steps[-1] == "1c"
        done.steps.clear()
    for peer, letters in ((left, "a"), (right, "b"), (left, "c")):
        done.add(peer, letters)
    assert done.work() == "1a 2b 1c"


def test_no_more_is_done_at_a_time_than_a_turn_takes(done):
    for port in range(8):
        done.add(FakePeer(port), "ABC")
    done.queue.work()
    assert len(done.steps) == -(-TURN_NS // LONG_NS)


@pytest.mark.parametrize("size", [0, 16_000])
def test_who_sends_little_is_served_soon_whatever_others_have_waiting(done, size):
    for peer in (TWO, THREE):
        for _ in range(4000):
            done.add(peer, "A", size)
    for _ in range(20):
        done.steps.clear()
        for letter in "abc":
            done.add(ONE, letter)
        done.queue.work()
        ended = done.steps.index("1c")
        assert done.steps[ended - 2 : ended] == ["1a", "1b"]
        assert ended <= 2 + 2  # one turn of each other


@given(st.lists(st.tuples(st.sampled_from((ONE, TWO, BESIDE)), st.text("abA", max_size=9))))
def test_what_one_sends_keeps_its_order_whoever_else_sends(said):
    with pytest.MonkeyPatch.context() as patch:
        done = Done()
        patch.setattr(clocks, "monotonic_ns", done.monotonic_ns)
        for peer, letters in said:
            done.add(peer, letters)
        done.work()
    for peer in (ONE, TWO, BESIDE):
        letters = "".join(step[1] for step in done.steps if step[0] == str(peer.port))
        assert letters == "".join(text for one, text in said if one == peer)
        assert done.queue.held(peer) == 0


def test_what_goes_wrong_is_not_tried_again_and_loses_nothing_else(done):
    for peer, letters in ((ONE, "Aa!b"), (ONE, "c"), (TWO, "!"), (TWO, "d")):
        done.add(peer, letters)
    failures = 0
    while done.queue:
        try:
            done.work()
        except RuntimeError:
            failures += 1
    assert failures == 2
    assert sorted(done.steps) == ["1A", "1a", "1c", "2d"]
    assert done.queue.held(ONE) == done.queue.held(TWO) == 0


# ---------------------------------------------------------------- shares


def test_one_may_hold_as_much_as_it_leaves_free_and_there_is_always_room_for_the_next():
    shares, size = Shares(limits.WAITING), 16_000
    peers, held = [FakePeer(port) for port in range(4)], []
    for peer in peers:
        while shares.take(peer, size):
            pass
        held.append(shares.held(peer) / limits.WAITING)
    assert held == pytest.approx([1 / 2, 1 / 4, 1 / 8, 1 / 16], abs=0.01)
    assert shares.take(ONE, size, always=True)  # one that waits by itself
    for peer in (*peers, ONE):
        shares.give_back(peer, shares.held(peer))
    assert not shares._held
    assert shares._free == limits.WAITING


def test_one_may_hold_exactly_what_it_leaves_free():
    for most, taken in ((8, [4]), (7, [3]), (12, [4, 2])):
        shares = Shares(most)
        for size in taken:
            assert shares.take(ONE, size)
        assert not shares.take(ONE, 1)
        assert shares.held(ONE) == sum(taken)
        assert shares.take(TWO, 1)
    assert not Shares(7).take(ONE, 4)
