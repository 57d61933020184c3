"""Garbage and hostile senders neither stop the server nor cost or leave a note nor make it grow.

tests/fuzz makes the packets, and fuzzes them one by one.
"""

import contextlib
import os
import random
import time
from collections.abc import Iterator
from pathlib import Path

import hostile
import pytest
from fuzz.target import Program
from hostile import Served, measured

PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
GROWTH_BYTES = 64 << 20


def resident_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE


@pytest.mark.parametrize("kind", ["udp", "prefixed", "slip"])
def test_garbage_over_the_wire_neither_ends_nor_fills_the_server(live, until, kind):
    from fuzz.targets.osc_calls import packet  # with all targets, which takes long

    chance = random.Random(f"garbage by {kind}")
    sender = live.client() if kind == "udp" else live.stream(slip=kind == "slip")
    listener = live.client()
    sizes = []
    for _ in range(4):
        for number in range(300):
            try:
                sender.take(packet(Program(chance.randbytes(200)), time.time()))
            except ConnectionError:  # what begins as no OSC does ends a stream
                sender = live.stream(slip=kind == "slip")
            if number % 50 == 49:
                with contextlib.suppress(AssertionError):
                    sender.all(0.001)
        until(lambda: not live.ports._queue, "all to be handled")
        listener.sync()
        if Path("/proc/self/statm").exists():
            sizes.append(resident_bytes())
    if kind != "udp":  # what a stream has sent is handled a part at a time
        sender.close()
        until(lambda: not live.ports._streams, "all streams to be read to their end")
    time.sleep(0.15)  # the last bundles' time comes
    listener.send("/panic")
    listener.sync()
    live.settle()
    assert live.is_at_rest()
    assert live.is_well()
    assert live.level() < 1e-6
    assert not sizes or sizes[-1] - sizes[0] < GROWTH_BYTES
    listener.send("/reset")  # whatever was set
    listener.send("/note", 67, 90)
    listener.sync()
    live.settle()
    assert live.player.pitch == pytest.approx(67.0, abs=0.5)


# ---------------------------------------------------------------- beside a player

# A short version of bench/hostile.py, with bounds that hold on a busy machine of two cores, where
# the time of a ping depends more on the machine than on the server. When one sender is faster than
# Python reads, the system drops packets of all senders.
SECONDS = 0.7
RECOVERS_S = 15.0  # a ping that the system dropped is never answered
PING_MS = 1000.0  # median
GROWTH_MB = 64.0
KINDS = [
    "web_page",
    "two_thousand",
    "many_long",
    "many_streams",
    "slip_without_end",
    "idle",
    "questions",
    "tables",
    "subscriptions",
    "due_never",
]
USUAL = ("two_thousand",)  # the others with --all


@pytest.fixture
def served() -> Iterator[Served]:
    served = Served()  # one for each test: an attack may leave work for a minute
    yield served
    served.stop()


@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=[pytest.mark.slow] * (kind not in USUAL)) for kind in KINDS]
)
def test_beside_a_hostile_sender_a_player_loses_no_note(served, kind, monkeypatch):
    monkeypatch.setattr(hostile, "RECOVERS_S", RECOVERS_S)
    figures = measured(kind, SECONDS, served)
    assert figures.notes > 50
    dropped = figures.system_dropped
    assert figures.lost <= dropped
    assert figures.unanswered <= dropped
    assert figures.hostile_notes == 0
    assert figures.growth_mb < GROWTH_MB
    assert figures.ping_median_ms < PING_MS or dropped
