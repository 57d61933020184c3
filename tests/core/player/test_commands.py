"""The player itself keeps commands within range: programs without Python can post anything."""

import math

import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import BEGIN, DRAW, EXPRESS, HOLD, KINDS, SLIDE, WRITE
from yehu_server.core.player.note_range import HIGHEST_NOTE, LOWEST_NOTE
from yehu_server.params.table import SLOT, TABLE, find


def after(*commands: tuple[int, int, float, float]):
    """The player's record, and the controls', after some commands."""
    instrument = Instrument(InstrumentSpec(44100.0))
    for kind, index, value, other in commands:
        assert instrument.post(kind, index=index, value=value, other=other)
    instrument.process(np.zeros(64, np.float32))
    return instrument._rig["player"][0].copy(), instrument._rig["controls"][0].copy()


def test_a_number_that_is_not_finite_changes_nothing():
    untouched = [record.tobytes() for record in after()]
    numbers = ((math.nan, 0.0), (0.5, math.nan), (math.inf, 0.5))
    wrong = [(kind, 1, *each) for kind in range(len(KINDS)) for each in numbers]
    assert [record.tobytes() for record in after(*wrong)] == untouched


def test_a_value_beyond_its_range_becomes_the_ranges_end():
    some = [
        (index, param)
        for index, param in enumerate(TABLE)
        if not param.player_controlled and not param.address.startswith("/engine")
    ]
    for kind in (WRITE, HOLD, EXPRESS):
        for beyond in (-1e308, 1e308):
            player, _ = after(*((kind, index, beyond, 0.0) for index, _ in some))
            ends = {param.address: param.lo if beyond < 0.0 else param.hi for _, param in some}
            found = {param.address: player["value"][index] for index, param in some}
            assert found == ends, (kind, beyond)


@pytest.mark.parametrize(("pitch", "played"), [(-1e9, LOWEST_NOTE), (1e9, HIGHEST_NOTE)])
def test_a_pitch_beyond_the_range_becomes_its_end(pitch, played):
    assert after((BEGIN, 0, 60.0, pitch))[0]["held_pitch"][0] == played
    assert after((SLIDE, 0, pitch, 0.0))[0]["finger_pitch"] == played


def test_a_bow_drawn_too_fast_and_too_hard_is_drawn_as_it_can_be():
    player, controls = after((DRAW, 0, 1e6, 1e6))
    assert player["speed"] == find("/bow/speed").hi
    assert controls["target"][SLOT["/bow/force"]] == find("/bow/force").hi
