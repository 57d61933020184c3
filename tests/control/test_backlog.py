"""The backlog: a sender's packets in order, and senders in turn, whatever one of them sends."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yehu_server.live.osc import backlog
from yehu_server.live.osc.backlog import (
    GUARANTEED_BYTES,
    MOST_BYTES,
    MOST_KNOWN,
    MOST_SENDERS,
    NEW_SENDER_NS,
    RESCALE_NS,
    SILENT_NS,
    SLICE_NS,
    TURN_NS,
    USE_HALF_LIFE_NS,
    Backlog,
)

SHORT_NS, LONG_NS = SLICE_NS // 100, SLICE_NS + SLICE_NS // 2


class Clock:
    """Advances with each step of work; stands in for the module ``time``."""

    def __init__(self) -> None:
        self.now_ns = 0

    def monotonic_ns(self) -> int:
        return self.now_ns

    thread_time_ns = monotonic_ns


class Named(str):
    """A peer, named by its host and, after an @, its sender."""

    __slots__ = ()

    @property
    def host(self) -> str:
        return self.partition("@")[0]


class Done:
    """Records what is handled; a packet takes one step for each letter."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.steps: list[str] = []
        self.ended: list[str] = []
        self.backlog = Backlog(self._handle, self.ended.append)

    def _handle(self, packet: bytes, peer: str, arrived_ns: int) -> Iterator[None]:
        del arrived_ns
        for letter in packet.decode():
            if letter == "!":
                raise RuntimeError("as asked")
            self.clock.now_ns += LONG_NS if letter.isupper() else SHORT_NS
            self.steps.append(peer + letter)
            yield

    def add(self, peer: str, letters: str | None, size: int = 0) -> bool:
        packet = None if letters is None else letters.encode()
        return self.backlog.add(packet, Named(peer), 0, size)

    def work(self) -> str:
        """Handle everything; return what was handled, in order."""
        for _ in range(10_000):
            if not self.backlog:
                break
            self.backlog.work()
        return " ".join(self.steps)


@pytest.fixture
def clock(monkeypatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(backlog, "time", clock)
    return clock


@pytest.fixture
def done(clock) -> Done:
    return Done(clock)


def test_what_is_short_is_handled_in_turn(done):
    for peer, letters in (("1", "ab"), ("2", "c"), ("3", "d")):
        done.add(peer, letters)
    assert done.work() == "1a 1b 2c 3d"


def test_what_is_long_goes_on_after_the_others_and_before_what_its_peer_says_next(done):
    done.add("1", "ABC")
    done.add("1", "d")
    done.add("1", None)
    done.add("2", "e")
    done.work()
    assert done.steps == ["1A", "2e", "1B", "1C", "1d"]
    assert done.ended == ["1"]


def test_no_more_is_done_at_a_time_than_a_turn_takes(done):
    for peer in "12345678":
        done.add(peer, "ABC")
    done.backlog.work()
    assert len(done.steps) == -(-TURN_NS // LONG_NS)


def test_of_many_with_much_to_do_each_gets_its_turn(done):
    done.add("1", "ABCD")
    done.add("2", "ABCD")
    steps = done.work().split()
    assert steps.index("2A") < steps.index("1C")
    assert steps.index("1B") < steps.index("2D")


def test_who_takes_little_goes_before_who_takes_much(done, clock):
    for _ in range(2):
        for peer in "12":
            done.add(peer, "a")
        done.work()
        clock.now_ns += NEW_SENDER_NS + 1
    for _ in range(20):
        done.add("1", "A")
        done.add("2", "a")
        done.backlog.work()
    before = len(done.steps)
    done.add("1", "A")
    done.add("2", "b")
    done.work()
    assert done.steps.index("2b") < before + 2


def test_what_one_took_is_forgiven(done, clock):
    done.add("1", "AAAA")
    done.add("2", "a")
    done.work()
    clock.now_ns += 30 * USE_HALF_LIFE_NS
    done.add("2", "AA")
    done.work()
    before = len(done.steps)
    done.add("2", "c")
    done.add("1", "b")
    assert done.work().split()[before:] == ["1b", "2c"]


def test_what_is_large_waits_for_what_is_small(done):
    done.add("1", "a", 60_000)
    done.add("2", "b", 100)
    assert done.work() == "2b 1a"


def test_who_has_been_here_goes_before_strangers(done, clock):
    done.add("1", "a")
    clock.now_ns += NEW_SENDER_NS + 1
    done.add("1", "b")
    done.work()
    for number in range(100):
        done.add(f"stranger {number} ", "x")
    done.add("1", "c")
    assert done.work().split()[:3] == ["1a", "1b", "1c"]


def test_many_senders_of_one_host_are_no_better_than_one(done, clock):
    crowd = [f"crowd@{number} " for number in range(50)]
    for _ in range(2):
        for peer in (*crowd, "player"):
            done.add(peer, "a")
        done.work()
        clock.now_ns += NEW_SENDER_NS + 1
    for _ in range(20):
        for peer in crowd:
            done.add(peer, "aaaaa")
        for _ in range(10):  # more than each of them takes
            done.add("player", "a")
        done.backlog.work()
    done.steps.clear()
    done.add("player", "b")
    done.backlog.work()
    assert "playerb" in done.steps[:20]


def test_years_do_not_change_who_goes_first(done, clock):
    done.add("1", "a")
    done.add("1", "A" * 5)
    for _ in range(5):
        clock.now_ns += RESCALE_NS + 1
        done.add("1", "a")
        done.add("2", "a")
        done.backlog.work()
    for sender in done.backlog._senders.values():
        assert 0.0 <= sender.took < 1e200
        assert 0.0 <= sender.host.took < 1e200
    assert done.work().count("2a") == 5


def test_one_gets_no_more_room_than_is_left_for_others_and_some_is_always_left(done):
    size = MOST_BYTES // 64
    taken = dict.fromkeys("1234", 0)
    for peer in taken:
        while done.add(peer, "", size):
            taken[peer] += 1
    assert taken["1"] in (31, 32)
    assert taken["2"] in (15, 16)
    assert taken["4"] > 0
    assert done.backlog.bytes <= MOST_BYTES
    done.work()
    assert done.backlog.bytes == 0
    assert done.add("4", "", size)


def test_who_has_been_here_finds_room_for_a_little_however_many_strangers_take_it(done, clock):
    done.add("player", "")
    clock.now_ns += NEW_SENDER_NS + 1
    done.add("player", "")
    done.work()
    for number in range(4000):
        done.add(f"stranger {number}", "", GUARANTEED_BYTES)
    assert not done.add("another", "", GUARANTEED_BYTES)
    assert done.add("player", "n")
    assert done.backlog.bytes <= MOST_BYTES + GUARANTEED_BYTES


def test_of_strangers_who_are_done_nothing_is_kept(done, clock):
    done.add("player", "")
    clock.now_ns += NEW_SENDER_NS + 1
    done.add("player", "")
    for number in range(5 * MOST_SENDERS):
        done.add(f"stranger {number}", "")
        done.work()
        assert len(done.backlog._senders) <= MOST_SENDERS
    assert "player" in done.backlog._senders
    assert len(done.backlog._hosts) <= MOST_SENDERS + 1


def test_there_are_places_for_so_many_who_are_known_and_they_are_given_on(done, clock):
    crowds = []
    for crowd in "ab":
        for _ in range(2):
            for number in range(MOST_KNOWN + 1):
                done.add(f"{crowd}{number}", "")
                done.work()
            clock.now_ns += NEW_SENDER_NS + 1
        crowds.append(len(done.backlog._known))
        clock.now_ns += SILENT_NS
    assert crowds == [MOST_KNOWN, MOST_KNOWN]


def test_what_is_forgotten_is_not_done_and_leaves_its_room(done):
    done.add("1", "ABC")
    done.add("1", "d")
    done.add("2", "e", 2000)
    done.backlog.work()
    done.backlog.clear()
    assert (len(done.backlog), done.backlog.bytes) == (0, 0)
    before = len(done.steps)
    done.add("1", "f")
    assert done.work().split()[before:] == ["1f"]


def test_one_may_forget_all_that_waits_while_it_is_done(done):
    def clear(packet: bytes, peer: str, _when: int) -> Iterator[None]:
        done.steps.append(peer)
        done.backlog.clear()
        done.steps.append(packet.decode())
        yield

    done.backlog._handle = clear
    for peer in "112":
        done.add(peer, "a")
    assert done.work() == "1 a"
    assert (len(done.backlog), done.backlog.bytes) == (0, 0)


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
    done = Done(Clock())
    for peer, letters, is_large in said:
        done.add(peer, letters, 2000 if is_large else 0)
    done.work()
    for peer in "123":
        letters = "".join(step[1] for step in done.steps if step[0] == peer)
        assert letters == "".join(text for one, text, _ in said if one == peer)
    assert (len(done.backlog), done.backlog.bytes) == (0, 0)


def test_the_time_of_a_lone_senders_short_packets_is_measured_once(done, clock):
    # To measure it takes as long as to read a short packet.
    measured = []
    clock.thread_time_ns = lambda: measured.append(None) or clock.now_ns
    for _ in range(20):
        done.add("a", "x")
    assert done.work() == " ".join(20 * ["ax"])
    assert len(measured) == 2


def test_short_packets_of_two_senders_are_handled_in_turn(done):
    for peer in ("a", "b"):
        for _ in range(10):
            done.add(peer, "x")
    assert done.work() == " ".join(10 * ["ax", "bx"])
