"""What goes wrong while playing is told in few lines."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from yehu_server.live import housekeeper
from yehu_server.live.housekeeper import CounterReport

DROPS, LOSSES = "packets were dropped", "the state was lost"


@pytest.fixture
def clock(monkeypatch):
    clock = SimpleNamespace(now=1000.0)
    monkeypatch.setattr(housekeeper, "time", SimpleNamespace(monotonic=lambda: clock.now))
    return clock


def test_a_flood_of_one_trouble_is_a_line_at_once_and_one_every_ten_seconds(clock):
    said = []
    seen = CounterReport(said.append)
    for count in range(1, 501):  # 25 seconds
        seen.look({DROPS: count, LOSSES: 0})
        clock.now += 0.05
    assert said[0] == f"{DROPS} (1 so far)"
    assert len(said) == 3


def test_what_came_in_between_is_told_when_the_flood_is_over(clock):
    said = []
    seen = CounterReport(said.append)
    for count in (1, 7, 7):
        seen.look({DROPS: count})
        clock.now += 6.0
    assert said == [f"{DROPS} (1 so far)", f"{DROPS} (7 so far)"]


def test_a_flood_of_one_trouble_hides_no_other(clock):
    said = []
    seen = CounterReport(said.append)
    for count in range(1, 11):
        seen.look({DROPS: count, LOSSES: count // 10})
        clock.now += 0.05
    assert said == [f"{DROPS} (1 so far)", f"{LOSSES} (1 so far)"]
