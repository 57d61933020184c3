"""Beside playing the delay is kept, and what goes wrong is reported in few lines."""

from types import SimpleNamespace

import pytest
from wire import StillTime

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.live import housekeeper
from yehu_server.live.housekeeper import CounterReport, Housekeeper
from yehu_server.playing.delay import Delay

DROPS, LOSSES = "packets were dropped", "the state was lost"


@pytest.fixture
def clock(monkeypatch) -> StillTime:
    clock = StillTime(1000.0)
    monkeypatch.setattr(housekeeper, "time", clock)
    return clock


def test_a_flood_of_one_trouble_is_a_line_at_once_and_one_every_ten_seconds(clock):
    said = []
    seen = CounterReport(said.append)
    for count in range(1, 501):  # 25 seconds
        seen.report(DROPS, count)
        seen.report(LOSSES, count // 10 if count < 15 else 1)
        clock.now += 0.05
    assert said[:2] == [f"{DROPS} (1 so far)", f"{LOSSES} (1 so far)"]  # the flood hides no other
    assert len(said) == 4
    clock.now += 6.0
    seen.report(DROPS, 500)  # and the end of it is not lost
    assert said[4:] == [f"{DROPS} (500 so far)"]
    for count in range(501, 651):  # one that is to be rare
        clock.now += 1.0
        seen.report(DROPS, count, 60.0)
    assert said[5:] == [f"{DROPS} ({count} so far)" for count in (560, 620)]


def test_the_players_delay_follows_the_devices_period_and_mpe_is_named_once(until):
    said, instrument = [], Instrument(InstrumentSpec(48000))
    published = instrument._rig["published"]
    player = SimpleNamespace(
        instrument=instrument, know_programs=lambda: None, finish_remap=lambda: None, seems_mpe=True
    )
    ensemble = SimpleNamespace(lost_states=0, instruments=[instrument], first=instrument)
    keeper = Housekeeper(
        ensemble, [player], Delay(instrument, 128), [], print, lambda: 0, said.append
    )

    def is_followed() -> bool:
        published["ahead_window"] += 1
        published["ahead"] = published["longest"] = 1024
        return instrument.delay > 1024

    keeper.start()
    try:
        until(is_followed, "a delay of more than a period")
    finally:
        keeper.stop()
    assert [line for line in said if "--mpe" in line] == said[:1]
