"""What waits to be handled: in order, and nobody's long work before others' short."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yehu_server.control.backlog import OLD_NS, TURN_NS, Backlog

LONG_S = 1.5e-9 * TURN_NS


class Done:
    """Keeps what was handled: a packet is as many steps as it has letters."""

    def __init__(self) -> None:
        self.steps: list[str] = []
        self.ended: list[str] = []
        self.backlog = Backlog(self._handle, self.ended.append)

    def _handle(self, packet: bytes, peer: str, arrived_ns: int) -> Iterator[None]:
        del arrived_ns
        for letter in packet.decode():
            if letter == "!":
                raise RuntimeError("as asked")
            if letter.isupper():  # these take long
                time.sleep(LONG_S)
            self.steps.append(peer + letter)
            yield

    def add(self, peer: str, letters: str | None, age_ns: int = 0) -> None:
        packet = None if letters is None else letters.encode()
        self.backlog.add(packet, peer, time.monotonic_ns() - age_ns)

    def work(self) -> str:
        """Handle all of it; what was handled, in order."""
        for _ in range(10_000):
            if not self.backlog:
                break
            self.backlog.work()
        return " ".join(self.steps)


@pytest.fixture
def done() -> Done:
    return Done()


def test_what_is_short_is_handled_in_the_order_it_came(done):
    for peer, letters in (("1", "ab"), ("2", "c"), ("1", "d"), ("3", "e")):
        done.add(peer, letters)
    assert done.work() == "1a 1b 2c 1d 3e"


def test_what_is_long_goes_on_after_the_others_and_before_what_its_peer_says_next(done):
    done.add("1", "ABC")
    done.add("1", "d")
    done.add("1", None)
    done.backlog.work()
    assert done.steps[0] == "1A"
    done.add("2", "e")
    done.backlog.work()
    assert done.ended == []
    done.work()
    assert done.steps.index("2e") < done.steps.index("1C")
    assert [step for step in done.steps if step[0] == "1"] == ["1A", "1B", "1C", "1d"]
    assert done.ended == ["1"]


def test_of_many_with_much_to_do_each_gets_its_turn(done):
    done.add("1", "ABCD")
    done.add("2", "ABCD")
    steps = done.work().split()
    assert steps.index("2A") < steps.index("1D")
    assert steps.index("1B") < steps.index("2D")


def test_who_has_just_come_need_not_wait_for_one_who_keeps_all_waiting(done):
    for _ in range(100):
        done.add("1", "A", age_ns=2 * OLD_NS)
    done.add("2", "b")
    done.backlog.work()
    assert "2b" in done.steps[:3]
    assert len(done.work().split()) == 101


def test_what_goes_wrong_is_not_tried_again_and_loses_nothing_else(done):
    done.add("1", "Aa!b")
    done.add("1", "c")
    done.add("2", "!")
    done.add("2", "d")
    for _ in range(50):
        try:
            done.work()
        except RuntimeError:
            continue
    assert sorted(done.steps) == ["1A", "1a", "1c", "2d"]
    assert (len(done.backlog), done.backlog.bytes) == (0, 0)


@given(st.lists(st.tuples(st.sampled_from("123"), st.text("ab", max_size=3), st.booleans())))
def test_what_one_peer_says_keeps_its_order_whoever_else_speaks(said):
    done = Done()
    for peer, letters, is_old in said:
        done.add(peer, letters, age_ns=2 * OLD_NS if is_old else 0)
    done.work()
    for peer in "123":
        letters = "".join(step[1] for step in done.steps if step[0] == peer)
        assert letters == "".join(text for one, text, _ in said if one == peer)
    assert (len(done.backlog), done.backlog.bytes) == (0, 0)
