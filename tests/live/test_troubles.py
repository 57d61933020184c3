"""What is done beside playing: the delay is kept, what goes wrong is told in few lines."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.live import housekeeper
from yehu_server.live.housekeeper import CounterReport, Housekeeper
from yehu_server.playing.delay import Delay

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


def test_the_players_delay_follows_the_devices_period(until):
    instrument = Instrument(InstrumentSpec(48000))
    told = instrument._rig["published"]
    player = SimpleNamespace(delay=0, know_programs=lambda: None)
    ensemble = SimpleNamespace(lost_states=0, instruments=[instrument], first=instrument)
    keeper = Housekeeper(ensemble, [player], Delay(instrument, 128), [], lambda: 0, print)

    def is_followed() -> bool:
        told["ahead_window"] += 1
        told["ahead"] = told["longest"] = 1024
        return player.delay > 1024

    keeper.start()
    try:
        until(is_followed, "a delay of more than a period")
    finally:
        keeper.stop()
