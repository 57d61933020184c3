"""Gaps in the sound are told: while they happen, at the end, and first in the status line."""

from __future__ import annotations

import pytest
from wire import StillTime

from yehu_server.cli.report import status_line
from yehu_server.live import housekeeper
from yehu_server.live.housekeeper import UNDER_RUNS_EVERY_S, UnderRunReport

STATUS = {
    "note": -1.0, "bow_speed": 0.0, "device": "a device with a long name", "peak_db": -160.0,
    "load": 0.1, "missed_deadlines": 0, "underruns": 0, "midi_ports": "", "recording": "",
}  # fmt: skip


@pytest.fixture
def clock(monkeypatch) -> StillTime:
    clock = StillTime(1000.0)
    monkeypatch.setattr(housekeeper, "time", clock)
    return clock


def test_there_is_a_line_at_once_and_then_one_a_minute(clock) -> None:
    said: list[str] = []
    report = UnderRunReport(said.append)
    for second in range(150):
        clock.now = 1000.0 + second
        report.look(2 * second)
    assert [line.partition(":")[0] for line in said] == [
        "2 under-runs", f"120 under-runs in the last {UNDER_RUNS_EVERY_S:.0f} s",
        "120 under-runs in the last 60 s"
    ]  # fmt: skip
    assert "(242 so far)" in said[-1]
    assert "--blocksize" in said[0]


def test_nothing_is_said_where_there_are_none(clock) -> None:
    del clock
    said: list[str] = []
    report = UnderRunReport(said.append)
    report.look(0)
    report.sum_up(0, 0)
    assert said == []


def test_the_end_has_the_sum(clock) -> None:
    said: list[str] = []
    report = UnderRunReport(said.append)
    report.look(1)
    clock.now += 30.0
    report.look(5)
    report.sum_up(5, 1)
    assert said[1:] == ["5 under-runs and 1 missed deadline in 30 s"]


def test_the_status_line_begins_with_them_where_there_are_any() -> None:
    assert status_line(STATUS).startswith("a device")
    assert "under-runs 0" in status_line(STATUS)
    line = status_line(STATUS | {"underruns": 16_600})
    assert line.startswith("under-runs 16600 | missed 0 | a device")
    assert line.count("under-runs") == 1
