"""How wide a vibrato is, and where its middle is, where the body is steep and where it is not."""

import math
from dataclasses import replace

import numpy as np
import pytest
from held_notes import Playing

from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.physics.default_quantities import measured_body
from yehu_server.core.player.vibrato_table import (
    CENTRE,
    DEFAULT_DEPTH_CENTS,
    DEPTH_SHARE,
    MIN_DEPTH_CENTS,
    vibrato_table,
)
from yehu_server.params.articulations import NUMBER

A4, OPEN_NOTES = 440.0, (65, 72)
PEAK = 80.6  # MIDI note, between two rows
SHARP = 0.999  # radius of the pole: some 14 Hz wide


def row_of(pitch: float) -> int:
    return round(2.0 * (pitch - OPEN_NOTES[0]))


def with_peak() -> np.ndarray:
    """The table of a body that radiates at one frequency, and little else."""
    rate = measured_body().radiation_rate
    angle = 2.0 * math.pi * A4 * 2.0 ** ((PEAK - 69.0) / 12.0) / rate
    section = (1.0, 0.0, -2.0 * SHARP * math.cos(angle), SHARP**2)
    body = replace(measured_body(), sections=(section,), direct_gain=0.0)
    return vibrato_table(body, A4, OPEN_NOTES)


def test_a_body_that_radiates_evenly_leaves_a_vibrato_alone():
    body = replace(measured_body(), sections=measured_body().sections[:1], direct_gain=1e6)
    table = vibrato_table(body, A4, OPEN_NOTES)
    assert (table[:, DEPTH_SHARE] == 1.0).all()
    assert (table[:, CENTRE] == 0.0).all()


def test_on_the_flanks_of_a_peak_it_is_narrower_and_off_to_where_it_is_flatter():
    table = with_peak()
    below, above = table[row_of(80.0)], table[row_of(81.0)]
    assert below[DEPTH_SHARE] < 0.8
    assert above[DEPTH_SHARE] < 0.8
    assert below[CENTRE] < 0.0 < above[CENTRE]
    assert table[:, DEPTH_SHARE].min() >= MIN_DEPTH_CENTS / DEFAULT_DEPTH_CENTS


def played(note: int, **values: float) -> tuple[float, float]:
    """Depth (cents) of the vibrato of a note, and where its middle is."""
    playing = Playing(variation=0.0, **values)
    playing.on(note)
    (found,) = playing.play(0.2, "value")
    return found[-1, SLOTS.vibrato_depth], found[-1, SLOTS.vibrato_upward]


def test_the_player_narrows_it_at_a5_alone_of_two_neighbours():
    assert played(82, vibrato=30.0) == (30.0, 0.0)
    depth, upward = played(81, vibrato=30.0)
    assert depth == pytest.approx(15.0)
    assert 0.3 < upward < 0.7


def test_it_is_narrower_where_brilliance_raises_a_harmonic_that_the_body_swings():
    """The body radiates A4 itself evenly, and its second harmonic not."""
    plain = vibrato_table(measured_body(), A4, OPEN_NOTES)
    assert tuple(plain[row_of(69.0)]) == (1.0, 0.0)
    depth, upward = played(69, vibrato=30.0)
    assert depth == pytest.approx(20.0)
    assert upward > 0.3


def test_the_players_own_is_narrower_near_the_nut():
    depths = [played(note, phrasing=0.5)[0] for note in (66, 70, 79)]
    assert depths == pytest.approx([20.0, 28.0, 30.0])
    assert played(66, vibrato=30.0)[0] == 30.0  # what is asked for is not


def test_a_long_open_string_is_stopped_on_the_other_for_its_vibrato():
    """C5, where it is known to last, and phrasing gives it a vibrato."""
    long = {"phrasing": 0.5, "note_length": 0.9}
    ways = {
        "long": long,
        "short": {**long, "note_length": 0.4},
        "of unknown length": {"phrasing": 0.5},
        "as written": {**long, "phrasing": 0.0},
        "on a written string": {**long, "string": 2.0},
        "straight": {**long, "articulation": NUMBER["straight"]},
        "a trill": {**long, "articulation": NUMBER["trill"]},
        "plucked": {**long, "pizzicato": 1.0},
    }
    strings = {}
    for name, values in ways.items():
        playing = Playing(**values)
        playing.on(72)
        playing.play(0.01)
        strings[name] = int(playing.player["string"])
    assert [name for name, string in strings.items() if string == 0] == ["long"]


def test_a_press_vibrato_varies_less_far_up_the_inner_string():
    """Else a hard aftertouch raised B4 and C5 by over a semitone; on the outer string none does."""
    inner = [pressed(note, string=1.0) for note in (66, 68, 69, 71, 72)]
    assert inner[0] == pytest.approx(0.8)
    assert inner == sorted(inner, reverse=True)
    assert max(inner[3:]) <= 0.4
    assert [pressed(note) for note in (74, 81, 89)] == pytest.approx([0.8] * 3)


def test_an_open_string_that_a_press_stops_is_pressed_as_far_up_the_other():
    playing = Playing(string=0.0)
    playing.on(72)
    playing.play(0.4)
    playing.commands.write("/playing/vibrato_press", 0.8)
    (found,) = playing.play(0.3, "value")
    assert found[-1, SLOTS.vibrato_press] <= 0.4


def pressed(note: int, **values: float) -> float:
    """The variation of the finger force that a note is played with, asked for one of 0.8."""
    playing = Playing(vibrato_press=0.8, **values)
    playing.on(note)
    (found,) = playing.play(0.3, "value")
    return float(found[-1, SLOTS.vibrato_press])
