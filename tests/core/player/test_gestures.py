"""Articulations: what the hands do at which time of a note."""

from collections.abc import Callable
from itertools import pairwise, product
from typing import Any

import numpy as np
import pytest
from held_notes import HOP, RATE, Playing

from yehu_server.core.controls.slots import FINGER_POSITION, FINGER_PRESS, SLOTS
from yehu_server.core.player.right_hand import QUICK_SHARE
from yehu_server.params.articulations import ARTICULATIONS, NUMBER


def played(name: str, note: float = 74, seconds: float = 1.0, **values: float) -> np.ndarray:
    """The values of the controls while a note of an articulation is held."""
    return held(name, note, **values).play(seconds, "value")[0]


def held(name: str, note: float = 74, **values: float) -> Playing:
    """A player who holds a note of an articulation."""
    playing = Playing(articulation=NUMBER[name], **{"variation": 0.0, "listening": 0.0} | values)
    playing.on(note)
    return playing


def every_5_ms(playing: Playing, seconds: float, read: Callable[[Any], float]) -> np.ndarray:
    """What is read of the player's record while it plays on."""
    found = []
    for _ in range(round(seconds / 0.005)):
        playing.play(0.005)
        found.append(float(read(playing.player)))
    return np.array(found)


def bends(name: str, seconds: float = 1.0, note: float = 74, **values: float) -> np.ndarray:
    """Where the finger is from the pitch of the note (semitones), every 5 ms."""
    return every_5_ms(held(name, note, **values), seconds, lambda p: p["gesture"]["bend"])


def at(seconds: float) -> int:
    return round(seconds * RATE / HOP)


def test_every_articulation_plays_finite_sound_and_ends(everything):
    wrong, lengths = [], (0.0, 0.08, 1.0)
    for number, articulation in enumerate(ARTICULATIONS):
        for length in lengths if everything else (lengths[number % 3],):
            playing = Playing(articulation=NUMBER[articulation.name], note_length=length)
            for note in (65, 76):
                playing.on(note)
                values = playing.play(0.15, "value")[0]
                playing.off(note)
                after = playing.play(0.2, "value")[0]
                if not np.isfinite(values).all() or after[-1, SLOTS.bow_side] != 0.0:
                    wrong.append((articulation.name, length, note))
    assert wrong == []


def test_a_sprung_bow_leaves_the_string_and_a_stopped_one_stands_on_it():
    sprung, stopped = played("spiccato"), played("staccato")
    assert abs(sprung[at(0.04), SLOTS.bow_side]) > 0.9
    assert sprung[at(0.15), SLOTS.bow_side] == sprung[at(0.9), SLOTS.bow_side] == 0.0
    assert abs(stopped[at(0.9), SLOTS.bow_side]) == 1.0
    assert stopped[at(0.9), SLOTS.bow_speed] == 0.0


def test_a_thrown_bow_bounces_five_times_and_ever_sooner():
    side = np.abs(played("ricochet", seconds=1.2)[:, SLOTS.bow_side]) > 0.5
    begins = np.flatnonzero(side[1:] & ~side[:-1]) * HOP / RATE
    gaps = np.diff(begins)
    assert len(begins) in (4, 5)  # the first may lie before the first that is seen
    assert (np.diff(gaps) < 0.003).all()
    assert gaps[-1] < 0.8 * gaps[0]


def test_slides_begin_away_and_end_on_the_pitch():
    wrong = []
    for name, begins in (("slide-up", -2.0), ("large-slide-up", -4.0), ("slide-down", 2.0)):
        bend = bends(name)
        steps = np.diff(bend) * np.sign(-begins)
        if bend[1] != begins or bend[-1] != 0.0 or (steps < 0.0).any() or steps.max() > 0.4:
            wrong.append((name, bend))
    assert wrong == []
    turning = bends("turning-slide")
    assert turning[0] == turning[-1] == 0.0
    assert turning.max() == pytest.approx(2.0, abs=0.02)


def test_a_slide_or_a_trill_in_a_note_stays_on_one_string():
    """Also on the open C5, which is stopped on the F string, or where its finger would not fit."""
    wrong = []
    slides = ("passed-slide", "fall", "turning-slide", "sliding-vibrato")
    trills = ("trill", "wide-trill", "mordent")
    for names, first, notes in ((slides, 76, (71, 72, 79)), (trills, 70, (71, 72, 73, 76))):
        for name, note in product(names, notes):
            playing = held(name, first)
            playing.play(0.2)
            playing.on(note)
            strings = every_5_ms(playing, 0.4, lambda player: player["string"])
            if len(set(strings)) != 1 or (name in slides and not playing.player["position"] > 0.0):
                wrong.append((name, note))
    assert wrong == []


def test_a_slide_goes_over_to_another_string_with_another_finger():
    for first, second in ((70, 79), (79, 70)):
        playing = held("ordinary", first, portamento=1.0, portamento_time=200.0)
        playing.play(0.2)
        playing.on(second)
        fingered = []
        for _ in range(60):
            playing.play(0.005)
            assert playing.player["position"] > 0.0
            fingered.append((int(playing.player["string"]), int(playing.player["finger"])))
        assert {string for string, _ in fingered} == {0, 1}
        for (string, finger), (next_string, next_finger) in pairwise(fingered):
            assert (string != next_string) == (finger != next_finger)


def test_a_finger_touches_the_node_of_a_harmonic_and_no_other_note():
    lengths = {}
    for note in (77, 84, 79, 74):
        playing = Playing(articulation=NUMBER["flageolet"], variation=0.0, listening=0.0)
        playing.on(71)
        playing.play(0.1)
        playing.on(note)
        playing.play(0.05)
        playing.commands.write("/playing/speed", 0.15)
        values = playing.play(0.1, "value")[0][-1]
        down = np.flatnonzero(values[FINGER_PRESS] > 0.0)
        assert len(down) == 1
        press, place = values[FINGER_PRESS[down[0]]], values[FINGER_POSITION[down[0]]]
        lengths[note] = (int(playing.player["string"]), round(press, 3), round(place, 3))
        playing.on(76)
        values = playing.play(0.1, "value")[0][-1]
        assert (values[FINGER_PRESS] > 0.5).sum() == 1
        assert np.count_nonzero(values[FINGER_PRESS]) == 1
    half, third = round(0.2986 / 2, 3), round(0.2986 / 3, 3)
    assert lengths[77] == (0, 0.02, half)
    assert lengths[84] == (1, 0.02, half)
    assert lengths[79] == (1, 0.02, third)
    assert lengths[74][1] > 0.5


def test_strokes_in_a_hurry_come_sooner_and_lighter():
    wrong = []
    for since, is_hurried in ((0.4, False), (0.2, False), (0.08, True)):
        playing = Playing(variation=0.0, listening=0.0)
        playing.on(74)
        playing.play(since)
        before = float(playing.controls["target"][SLOTS.bow_pressure])
        playing.off(74)
        playing.on(74)
        speed = np.abs(playing.play(0.025, "value")[0][-1, SLOTS.bow_speed])
        arrived = speed > 0.95 * abs(float(playing.controls["target"][SLOTS.bow_speed]))
        lighter = float(playing.controls["target"][SLOTS.bow_pressure]) < 0.9 * before
        if (arrived, lighter) != (is_hurried, is_hurried):
            wrong.append((since, arrived, lighter))
    assert wrong == []


def test_a_bow_that_turns_takes_less_than_a_third_of_the_attack_and_one_from_rest_more():
    took = []
    for rest in (0.0, 1.0):
        playing = Playing(variation=0.0, listening=0.0, phrasing=0.5, attack=40.0)
        playing.on(74)
        playing.play(0.4)
        playing.off(74)
        playing.play(rest)
        playing.on(74)
        playing.play(0.005)
        took.append((HOP + int(playing.controls["remaining"][SLOTS.bow_speed])) / RATE)
    assert took[0] < 0.04 / 3.0 < 0.04 < took[1]


def test_a_low_note_in_a_hurry_has_as_many_periods_to_begin_in_as_a_middle_one():
    took = {}
    for key in (65, 70, 82, 89):
        playing = Playing(variation=0.0, listening=0.0)
        playing.on(key)
        playing.play(0.08)
        playing.off(key)
        playing.on(key)
        playing.play(0.005)
        took[key] = HOP + int(playing.controls["remaining"][SLOTS.bow_speed])
    assert took[70] / took[65] == pytest.approx(2.0 ** (-5 / 12), rel=0.02)
    assert took[89] == took[82] < took[70]


def test_a_quick_stroke_on_the_outer_string_turns_as_heavily_as_it_may_and_a_heavy_one_as_it_is():
    wrong = []
    for key, attack, asked, heavier in (
        *((76, 20.0, 0.4, True), (76, 200.0, 0.4, False), (67, 20.0, 0.4, False)),
        (76, 20.0, 0.8, False),
    ):
        playing = Playing(variation=0.0, listening=0.0, phrasing=0.0, attack=attack, pressure=asked)
        playing.on(key)
        playing.play(0.4)
        playing.off(key)
        playing.on(key)
        speed, pressure = playing.play(0.12, "value")[0][:, [SLOTS.bow_speed, SLOTS.bow_pressure]].T
        turned = int(np.argmax(speed * speed[0] < 0.0))
        is_heavier = pressure[turned] > 2.0 * pressure[-1] and pressure[0] < 0.8 * pressure[turned]
        if is_heavier != heavier or pressure.max() > max(QUICK_SHARE, 1.05 * pressure[-1]):
            wrong.append((key, attack, asked, pressure[[0, turned, -1]]))
    assert wrong == []


def test_a_trill_beats_a_second_above_some_seven_times_a_second_and_a_mordent_once():
    bend = bends("trill", 2.0)
    assert set(np.round(bend, 6)) == {0.0, 2.0}
    beats = np.count_nonzero((bend[1:] == 2.0) & (bend[:-1] == 0.0))
    assert 13 <= beats <= 22
    assert np.count_nonzero(np.diff(bends("mordent")) != 0.0) == 2


def test_a_trill_is_its_note_for_longer_than_the_beats_however_quick_they_come_and_at_its_end():
    for length in (0.0, 0.4, 0.9, 2.0):
        is_up = bends("wide-trill", length or 3.0, note_length=length) > 0.0
        turns = np.flatnonzero(np.diff(is_up)) + 1
        spans = np.diff([0, *turns, is_up.size])
        for beat, after in zip(spans[1::2], spans[2:-1:2], strict=False):
            assert after >= beat, (length, spans)
        assert length == 0.0 or not is_up[-1], (length, spans)


def test_a_portamento_is_a_smooth_curve_that_lasts_its_time():
    playing = held("ordinary", 69, portamento=1.0, portamento_time=200.0)
    playing.play(0.3)
    playing.on(76)  # over C5: all on the F string
    bend = every_5_ms(playing, 0.21, lambda player: player["gesture"]["bend"])
    assert playing.player["string"] == 0
    assert bend[0] == pytest.approx(-7.0, abs=0.2)
    assert bend[37] != 0.0
    assert bend[-1] == 0.0


def test_a_vibrato_fades_with_the_last_note_and_comes_in_anew_with_the_next():
    playing = Playing(vibrato=30.0, vibrato_delay=500.0, variation=0.0, listening=0.0)
    playing.on(74)
    playing.play(1.0)
    playing.off(74)
    playing.play(0.05)
    playing.on(76)
    onset = playing.play(0.7, "value")[0][:, SLOTS.vibrato_onset]
    assert onset[: at(0.1)].max() < 0.3
    assert onset[-1] == 1.0
    playing.off(76)
    assert playing.play(1.0, "value")[0][-1, SLOTS.vibrato_onset] == 0.0


def leaving_s(length: float, **values: float) -> float:
    """How long after a note the bow moves on, until a tenth of its speed is left."""
    playing = Playing(variation=0.0, **values)
    playing.on(74)
    playing.play(length)
    playing.off(74)
    (found,) = playing.play(0.4, "value")
    speed = np.abs(found[:, SLOTS.bow_speed])
    return float((speed > 0.1 * speed[0]).sum() * HOP / RATE)


def test_the_bow_leaves_a_long_note_more_slowly_by_phrasing():
    """Else there were holes of some 28 dB between phrases."""
    assert leaving_s(1.5, phrasing=0.5) > 1.4 * leaving_s(0.15, phrasing=0.5)
    assert leaving_s(1.5, phrasing=0.0) == leaving_s(0.15, phrasing=0.0)
