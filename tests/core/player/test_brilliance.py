"""A harder bow, or one nearer to the bridge, makes a note's centroid rise by a law."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hands import Watched, ideal

from yehu_server.core.player.brilliance import HARDER, NEARER, PLAIN_EFFORT, PLAIN_PLACE
from yehu_server.core.player.note_tables import ABOVE, GAINS, PITCHES
from yehu_server.playing.part_state import Key
from yehu_server.playing.player import Player

PLAIN_HZ = 600.0
CENTROIDS = np.array([0.9, 1.0, 1.2, 1.5, 2.0]) * PLAIN_HZ
LOUDER = (1.0, 0.0, -1.0, 2.0, 5.0)
PITCH = 67


def tables(row):
    return tuple(tuple(tuple(row) for _ in (0, *pitches)) for pitches in PITCHES)


def bowed(effort: float, place: float = PLAIN_PLACE, **settings: float) -> Watched:
    """An instrument whose notes all brighten alike, bowed with an effort (m/s)."""
    calibration = replace(ideal(), centroids=tables(CENTROIDS), louder=tables(LOUDER))
    instrument = Watched(calibration=calibration)
    commands = Player(instrument)
    pressure = effort / instrument.requested("/playing/speed")
    settings |= {"pressure": pressure, "bow_position": place, "variation": 0.0}
    for name, value in settings.items():
        commands.write(f"/playing/{name}", value)
    commands.note_on(Key(0, PITCH))
    return instrument


def gain_for(effort: float, place: float = PLAIN_PLACE) -> float:
    octaves = HARDER * math.log2(effort / PLAIN_EFFORT) - NEARER * math.log2(place / PLAIN_PLACE)
    return float(np.interp(PLAIN_HZ * 2.0**octaves, CENTROIDS, GAINS))


@pytest.mark.parametrize(
    ("effort", "place"), [(0.02, 0.13), (0.046, 0.13), (0.08, 0.13), (0.3, 0.13), (0.08, 0.07)]
)
def test_the_shelf_raises_the_centroid_as_far_as_the_law_says(effort, place):
    instrument = bowed(effort, place)
    assert instrument.target("/body/brilliance") == pytest.approx(gain_for(effort, place), abs=0.01)
    assert instrument.target("/body/brilliance_frequency") == ABOVE * PLAIN_HZ


def test_a_bow_that_leans_harder_in_mid_note_is_brighter_and_as_loud():
    instrument = bowed(PLAIN_EFFORT)
    louder = 0.3 / instrument.requested("/playing/speed")
    Player(instrument).write("/playing/pressure", louder)
    brighter = bowed(0.3)
    for address in ("/body/brilliance", "/output/balance"):
        assert instrument.target(address) == pytest.approx(brighter.target(address), abs=1e-9)


def test_an_instrument_that_nobody_measured_is_as_the_model():
    instrument = Watched()
    Player(instrument).note_on(Key(0, PITCH))
    assert instrument.target("/body/brilliance") == 0.0
