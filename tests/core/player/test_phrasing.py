"""What the player does to plain notes by itself."""

import numpy as np
from held_notes import Playing

from yehu_server.core.controls.slots import FINGER_POSITION, FINGER_PRESS, SLOTS
from yehu_server.params.articulations import ARTICULATIONS, NUMBER


def test_a_long_note_gets_a_vibrato_that_comes_late_if_phrased_and_none_was_asked_for():
    def vibrato(note: float, seconds: float, **values: float) -> np.ndarray:
        """Depth (cents) and onset of the vibrato, every 5 ms."""
        playing = Playing(**values)
        playing.on(note)
        return playing.play(seconds, "value")[0][:, [SLOTS.vibrato_depth, SLOTS.vibrato_onset]].T

    depth, onset = vibrato(79, 2.0, phrasing=0.5)
    assert depth[-1] == 30.0
    assert onset[40] < 0.4 < onset[80]  # none after 0.2 s, some after 0.4 s
    assert onset[-1] == 1.0
    assert (vibrato(74, 1.0)[0] == 0.0).all()
    requested = vibrato(74, 0.5, phrasing=1.0, vibrato=10.0, vibrato_delay=0.0)
    assert requested[:, -1].tolist() == [10.0, 1.0]


def slide_s(phrasing: float, first: int, second: int, held_s: float = 0.5) -> float:
    """How long (s) the finger moves from one note to the next."""
    playing = Playing(phrasing=phrasing, variation=0.0, listening=0.0)
    playing.on(first)
    playing.play(held_s)
    playing.on(second)
    (values,) = playing.play(0.3, "value")
    places = values[:, FINGER_POSITION]
    moves = (np.abs(np.diff(places, axis=0)) > 0.0).sum(axis=0)
    return float(moves.max()) * 0.005


def test_a_leap_from_a_long_note_slides():
    assert 0.06 < slide_s(0.5, 74, 79) < 0.12
    assert slide_s(1.0, 74, 79) > slide_s(0.5, 74, 79)


def test_a_light_finger_shifts_while_the_bow_is_off_and_else_the_next_one_steps():
    wrong = []
    for note, rest_s, values, shifts in (
        (78, 0.15, {}, True),
        (88, 0.15, {}, True),
        (66, 0.15, {}, True),  # on the other string
        (78, 0.01, {}, True),  # the bow is still leaving
        (86, 0.15, {}, False),  # the same again
        (78, 0.0, {}, False),  # legato
        (78, 0.15, {"pizzicato": 1.0}, False),
    ):
        playing = Playing(variation=0.0, listening=0.0, phrasing=0.0, **values)
        playing.on(86)
        playing.play(0.3)
        before = int(playing.player["finger"])
        if rest_s > 0.0:
            playing.off(86)
            playing.play(rest_s)
        playing.on(note)
        (moving,) = playing.play(0.03, "value")
        press = moving[:, FINGER_PRESS[before]]
        is_light = press.min() < 0.5 and playing.player["finger"] == before
        down = moving[-1, FINGER_PRESS]
        if is_light != shifts or (down > 0.0).sum() != 1 or down.max() < 1.0:
            wrong.append((note, rest_s, values, press))
    assert wrong == []


def first_bend(leap: float, **values: float) -> float:
    """Where the finger is from the pitch of a note (semitones) as that begins after a long one."""
    playing = Playing(phrasing=1.0, variation=0.0, listening=0.0)
    playing.on(76.0 - leap)
    playing.play(0.35)
    for name, value in values.items():
        playing.commands.write(f"/playing/{name}", value)
    playing.on(76)
    playing.play(0.005)
    return float(playing.player["gesture"]["bend"])


def test_a_leap_slides_only_where_bow_and_finger_are_free_for_it():
    """Not under a bow that stops or leaves the string, nor where the finger moves otherwise."""
    slide = {
        "ordinary", "tremolo", "padded", "sforzando", "swell", "straight", "rolling-vibrato",
        "pressing-vibrato", "sliding-vibrato",
    }  # fmt: skip
    found = {
        row.name
        for row in ARTICULATIONS
        if first_bend(7.0, articulation=NUMBER[row.name])
        != first_bend(2.0, articulation=NUMBER[row.name])
    }
    assert found == slide
    assert first_bend(7.0, pizzicato=1.0) == first_bend(7.0, bend=-2.0) == 0.0
    assert first_bend(7.0, bend=0.5) < -5.0  # a pitch between the keys
