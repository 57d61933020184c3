"""Strokes are planned for the length of the bow, and turn at its ends."""

import numpy as np
import pytest
from held_notes import HOP, RATE, Playing

from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.player.bow_length import END_FRACTION, MIN_SPEED_FACTOR

LENGTH, SPEED = 0.7, 0.2


def drawn(playing: Playing, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """The bow's speed (m/s) and the hair's place (m), every 5 ms."""
    values, place = playing.play(seconds, "value", "bow_displacement")
    return values[:, SLOTS.bow_speed], place


def turns(speed: np.ndarray) -> np.ndarray:
    """Times (s) at which the bow changes its direction."""
    side = np.sign(speed[speed != 0.0])
    return np.flatnonzero(np.diff(side)) * HOP / RATE


def test_a_bow_that_comes_to_its_end_turns_there():
    playing = Playing(variation=0.0)
    playing.on(74)
    speed, place = drawn(playing, 12.0)
    assert len(turns(speed)) in (3, 4)
    assert place.min() >= 0.0
    assert place.max() <= LENGTH
    between = np.diff(turns(speed))
    assert between == pytest.approx((1.0 - 2.0 * END_FRACTION) * LENGTH / SPEED, rel=0.1)


def test_a_change_within_a_note_is_a_dip_and_no_click():
    playing = Playing(variation=0.0)
    playing.commands.write("/bow/noise", 0.0)
    playing.on(74)
    sound = playing.sound(4.0).astype(float)
    window = RATE // 200
    level = 20.0 * np.log10(np.sqrt(np.convolve(sound**2, np.ones(window) / window, "same")) + 1e-9)
    steady = np.median(level[RATE:])
    dip = level[RATE : -RATE // 10]
    assert -30.0 < dip.min() - steady < -4.0
    assert (dip < steady - 6.0).sum() / RATE < 0.06  # s
    steps = np.abs(np.diff(sound))
    assert steps[RATE:].max() < 2.0 * np.quantile(steps[RATE : 2 * RATE], 0.999)


def test_short_notes_alternate():
    playing = Playing(variation=0.0)
    directions = []
    for _ in range(12):
        playing.on(74)
        speed, _ = drawn(playing, 0.15)
        directions.append(np.sign(speed[-1]))
        playing.off(74)
        playing.play(0.02)
    assert directions == [1.0, -1.0] * 6


def test_a_note_that_is_known_to_be_long_is_bowed_more_slowly():
    playing = Playing(variation=0.0, note_length=5.0)
    playing.on(74)
    speed, _ = drawn(playing, 5.0)
    assert len(turns(speed)) == 0
    assert MIN_SPEED_FACTOR * SPEED <= speed.max() < 0.7 * SPEED


def test_a_note_that_needs_more_hair_than_is_left_goes_the_other_way():
    # Long notes down and short ones up: in the end a down-bow has no hair left.
    playing = Playing(variation=0.0)
    for _ in range(6):
        for length in (1.5, 0.2):
            playing.commands.write("/playing/note_length", length)
            playing.on(74)
            speed, place = drawn(playing, length)
            assert len(turns(speed[10:])) == 0  # the note is one stroke
            assert place.min() >= 0.0
            assert place.max() <= LENGTH
            playing.off(74)
            playing.play(0.01)


def test_a_slur_that_has_no_hair_left_begins_a_new_stroke():
    playing = Playing(variation=0.0, note_length=1.2)
    playing.on(74)
    speed, _ = drawn(playing, 1.2)
    down = np.sign(speed[-1])
    signs = []
    for note in (76, 77, 79):
        playing.on(note)
        speed, _ = drawn(playing, 1.2)
        assert len(turns(speed[20:])) == 0  # it turns as a note begins, and not within
        signs.append(np.sign(speed[-1]))
    assert -down in signs


def test_a_bow_that_somebody_else_draws_has_no_end():
    playing = Playing(variation=0.0)
    playing.commands.write("/bow/side", -1.0)
    playing.commands.write("/bow/speed", 0.3)
    speed, place = drawn(playing, 5.0)
    assert len(turns(speed)) == 0
    assert place[-1] > 1.4


@pytest.mark.parametrize(("note", "lighter"), [(70, True), (76, False)])
def test_a_stroke_on_the_inner_string_begins_lighter(note, lighter):
    """Under a heavy bow B flat 4 begins half a semitone flat."""
    playing = Playing(variation=0.0, listening=0.0)
    playing.on(note)
    share = playing.play(0.4, "value")[0][:, SLOTS.bow_pressure]
    assert (share[15] < 0.9 * share[-1]) == lighter  # after 75 ms
    assert share[40] == pytest.approx(share[-1])
