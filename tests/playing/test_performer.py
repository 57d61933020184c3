"""The player's decisions for notes: strings, fingers, strokes, variation, level."""

import math

import pytest
from hands import Checked, Move, Watched, ideal

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.velocity import NEUTRAL_VELOCITY
from yehu_server.params.articulations import NUMBER
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.part_state import Key
from yehu_server.playing.tuning import RangePolicy

YEHU = Quantities()


def key(note: int, channel: int = 0) -> Key:
    return Key(channel, note)


# ---------------------------------------------------------------- strings and fingers


def test_a_note_below_c5_is_stopped_on_the_f_string_and_one_above_on_the_c_string():
    for note in (*range(66, 72), *range(73, 90)):
        listener = Watched(calibration=ideal())
        Checked(listener).note_on(key(note))
        string, stop = listener.where()
        assert (string, round(stop)) == (("F", note - 65) if note < 72 else ("C", note - 72))


def hands(variation: float = 0.0, **options) -> tuple[Checked, Watched]:
    """A player on an ideal instrument, without random variation."""
    listener = Watched(calibration=ideal(), **options)
    player = Checked(listener)
    player.write("/playing/variation", variation)
    return player, listener


def test_a_finger_stays_on_its_string_for_a_near_note_and_goes_to_the_other_for_a_far_one():
    """74 is 12 cm up the F string, and 4 cm up the C string."""
    for notes, where in {
        **{(*before, 65): ("F", None) for before in ((), (70,), (80,))},  # open strings
        **{(*before, 72): ("C", None) for before in ((), (70,), (80,))},
        (71, 74): ("F", 9),  # from 9 cm
        (66, 74): ("C", 2),  # from 2 cm
        (71, 65, 74): ("C", 2),  # a finger that is up has no way to go
        (84, 77): ("C", 5),  # on the F string it would not have to move at all
        (71, 74, 76): ("F", 11),
        (71, 74, 76, 78): ("C", 6),  # no note is played far up the F string
    }.items():
        player, listener = hands()
        for note in notes:
            player.note_on(key(note))
        assert listener.where() == where, notes


def test_a_string_may_be_asked_for():
    sliding = "sliding-vibrato"  # which goes below the open C string
    for command, note, articulation, where in [
        (1.0, 72, "ordinary", ("F", 7)),
        (1.0, 79, "ordinary", ("F", 14)),
        (1.0, 65, "ordinary", ("F", None)),
        (2.0, 74, "ordinary", ("C", 2)),
        (2.0, 72, "ordinary", ("C", None)),
        (2.0, 70, "ordinary", ("F", 5)),  # the C string has no such note
        (0.0, 74, "ordinary", ("F", 9)),
        (0.0, 72, sliding, ("F", 7)),
        (2.0, 72, sliding, ("C", None)),
    ]:
        player, listener = hands()
        player.note_on(key(71))  # from here the F string would be nearer for 74
        player.write("/playing/string", command)
        player.write("/playing/articulation", float(NUMBER[articulation]))
        player.note_on(key(note))
        assert listener.where() == where, (command, note, articulation)


def test_strokes_go_in_turn_or_the_way_that_is_asked_for():
    for command, expected in ((0.0, [1, -1, 1, -1]), (1.0, [1] * 4), (-1.0, [-1] * 4)):
        player, listener = hands()
        player.write("/playing/direction", command)
        signs = []
        for note in (66, 73, 66, 65):
            player.note_on(key(note))
            signs.append(listener["/bow/speed"] / 0.2)
            player.note_off(key(note))
        assert signs == expected


def test_without_calibration_fingers_go_to_where_an_ideal_string_is_in_tune():
    calibration = calibration_for(44100.0)
    listener = Watched(quantities=calibration.tuned(YEHU), calibration=calibration)
    player = Checked(listener)
    player.write("/playing/variation", 0.0)
    player.note_on(key(79))
    measured = listener.position
    player.write("/engine/calibration", 0.0)
    by_itself = listener.position
    player.write("/engine/calibration", 0.5)
    assert min(measured, by_itself) < listener.position < max(measured, by_itself)
    player.write("/engine/calibration", 1.0)
    assert listener.position == measured
    silk, tension = YEHU.strings[1], calibration.tensions[1]
    hz = 440.0 * 2 ** (10 / 12)
    sounding = math.sqrt(tension / silk.rho_A) / (2.0 * hz)
    assert by_itself == pytest.approx(YEHU.bridge_x - sounding, abs=1e-9)
    assert 1e-4 < abs(measured - by_itself) < 0.01


def test_a_finger_lands_before_the_one_before_it_leaves(player, listener):
    player.note_on(key(66))
    player.note_on(key(68))
    (landing,) = listener.of("/finger/2/press")
    lifting = listener.of("/finger/1/press")[-1]
    assert (landing.value, lifting.value) == (1.5, 0.0)
    assert landing.ramp_ms < lifting.ramp_ms


# ---------------------------------------------------------------- one note at a time


def test_the_last_note_wins_and_a_held_one_returns_when_it_ends(player, listener):
    for note in (66, 68, 70):
        player.note_on(key(note))
    for note in (70, 68, 66):
        assert player.sounding == key(note)
        assert listener.where() == ("F", note - 65)
        player.note_off(key(note))
    assert player.sounding is None
    assert (listener["/bow/speed"], listener["/bow/side"]) == (0.0, 0.0)


def test_the_end_of_a_note_that_does_not_sound_changes_nothing_and_of_all_ends_every_one(
    player, listener
):
    player.note_on(key(66))
    player.note_on(key(68))
    player.note_on(key(70))
    heard = len(listener.moves)
    player.note_off(key(66))
    player.note_off(key(89))
    assert len(listener.moves) == heard
    player.notes_off(player.held())
    assert player.sounding is None
    assert (listener["/bow/speed"], listener["/bow/side"]) == (0.0, 0.0)
    assert not listener.silenced
    player.note_on(key(80))
    player.note_off(key(80))  # brings none back
    assert player.sounding is None


def test_all_sound_off_silences_the_instrument_at_its_frame_and_lifts_the_hand(player, listener):
    player.note_on(key(71))
    player.notes_off(player.held(), frame=4711)
    player.stop_sound(frame=4711)
    assert player.sounding is None
    assert listener.silenced == [4711]
    assert listener.press == 0.0
    player.note_on(key(74))  # 12 cm up the F string, where the hand no longer is
    assert listener.where() == ("C", 2)


# ---------------------------------------------------------------- strokes


def test_overlapping_notes_share_one_stroke_across_the_strings_too(player, listener):
    held = None
    for note in (66, 73, 70, 72):
        player.note_on(key(note))
        assert listener["/bow/speed"] == 0.2
        if held:
            player.note_off(held)
        assert listener["/bow/speed"] == 0.2
        held = key(note)


def test_a_stroke_begins_and_ends_in_the_times_set_for_it(player, listener):
    player.write("/playing/attack", 80.0)
    player.write("/playing/release", 300.0)
    for struck in range(2):  # again while it sounds: the bow turns, on the string
        player.note_on(key(66))
        assert len(listener.of("/bow/speed")) == 1 + struck
        assert listener.of("/bow/speed")[-1].ramp_ms == 80.0
        listener.wait(0.4)
    player.note_off(key(66))
    assert listener.of("/bow/speed")[-1].ramp_ms == 300.0
    assert listener.of("/bow/side")[-1].ramp_ms == 300.0


def test_a_lifted_bow_takes_its_time_for_a_gentle_note_and_bites_for_a_hard_one():
    took: dict[float, float] = {}
    for velocity in (0.0, NEUTRAL_VELOCITY, 1.0):
        player, listener = hands()
        player.write("/playing/attack", 80.0)
        player.write("/playing/velocity", velocity)
        player.note_on(key(66))
        took[velocity] = listener.of("/bow/speed")[-1].ramp_ms
        force = listener.of("/bow/side")[-1]  # it is there before the speed
        assert (force.value, force.ramp_ms) == (1.0, pytest.approx(took[velocity] / 4.0, abs=0.1))
    assert took[NEUTRAL_VELOCITY] == 80.0
    assert took[0.0] > 1.5 * 80.0
    assert took[1.0] < 0.75 * 80.0


def test_the_bow_stays_still_and_the_finger_up_when_no_note_sounds(player, listener):
    player.write("/playing/speed", 0.3)
    player.write("/playing/press", 3.0)
    player.write("/playing/bend", 1.0)
    assert listener.of("/bow/speed") == []
    assert all(move.value == 0.0 for move in listener.of("/finger/1/press"))
    assert listener.of("/finger/1/position") == []


# ---------------------------------------------------------------- bending


def test_a_bend_moves_the_finger_along_its_string_as_far_as_it_goes(subtests):
    for note, string, bends in [
        (75, 0.0, {1.5: ("C", 4.5), -2.0: ("C", 1), 0.01: ("C", 3.01), 0.0: ("C", 3)}),
        (65, 0.0, {1.0: ("F", 1), 0.0: ("F", None)}),  # an open string, stopped and open again
        (66, 0.0, {-7.0: ("F", None)}),  # nothing is below it
        (71, 0.0, {5.0: ("F", 11), 7.0: ("C", 6)}),  # on the other where that goes on
        (71, 1.0, {7.0: ("F", 13)}),  # unless this one is asked for
    ]:
        with subtests.test(note=note, string=string):
            player, listener = hands()
            player.write("/playing/string", string)
            player.note_on(key(note))
            for bend, where in bends.items():
                player.write("/playing/bend", bend)
                assert listener.where() == where, bend


# ---------------------------------------------------------------- vibrato on an open string


def test_an_open_string_is_stopped_on_the_other_for_a_vibrato(subtests):
    """C5 is, where it lasts long enough; the lowest note, F4, has no other place."""
    for asked in ({"vibrato": 30.0}, {"vibrato_press": 0.4}, {"vibrato_press": 0.01}):
        with subtests.test(asked=asked):
            stopped = ("C", None) if asked == {"vibrato_press": 0.01} else ("F", 7)
            player, listener = hands()
            player.note_on(key(72))
            assert listener.where() == ("C", None)
            for name, value in asked.items():  # while it sounds: aftertouch, a wheel
                player.write(f"/playing/{name}", value)
            assert listener.where() == stopped
            player.note_off(key(72))
            listener.wait(1.0)
            player.note_on(key(72))
            assert listener.where() == stopped
            player.note_on(key(65))
            assert listener.where() == ("F", None)


def test_a_fast_passage_uses_the_open_string_with_a_vibrato_too():
    player, listener = hands()
    player.write("/playing/vibrato", 30.0)
    for note in (74, 72, 71, 72):
        player.note_on(key(note))
        assert note != 72 or listener.where() == ("C", None)
        player.note_off(key(note))
        listener.wait(0.2)
    for length_s, where in ((0.3, ("C", None)), (0.8, ("F", 7))):
        player.write("/playing/note_length", length_s)
        player.note_on(key(72))
        assert listener.where() == where
        player.note_off(key(72))


# ---------------------------------------------------------------- out of range


def by_octaves(note: int) -> int:
    while note < 65:
        note += 12
    while note > 89:
        note -= 12
    return note


@pytest.mark.parametrize(
    ("policy", "expected"),
    [
        (RangePolicy.TRANSPOSE, by_octaves),
        (RangePolicy.CLAMP, lambda note: 65 if note < 65 else min(note, 89)),
        (RangePolicy.SKIP, lambda note: note if 65 <= note <= 89 else None),
    ],
)
def test_notes_out_of_range_go_where_the_policy_says(policy, expected):
    above, calibration = {"F": 65, "C": 72}, ideal()
    for note in (0, 53, 64, 65, 66, 71, 72, 88, 89, 90, 101, 127):
        listener = Watched(calibration=calibration)
        player = Checked(listener, policy)
        player.write("/playing/variation", 0.0)
        heard = len(listener.moves)
        player.note_on(key(note))
        outside = not 65 <= note <= 89
        assert player.notes_out_of_range == outside
        assert player.notes_played == (expected(note) is not None)
        if expected(note) is None:
            assert player.sounding is None
            assert len(listener.moves) == heard
        else:
            string, stop = listener.where()
            assert above[string] + (stop or 0) == expected(note)
            player.note_off(key(note))
        assert player.sounding is None


# ---------------------------------------------------------------- variation


def phrase(variation: float, seed: int) -> list[Move]:
    player, listener = hands(variation, seed=seed)
    for _ in range(4):
        player.note_on(key(75))
        player.note_off(key(75))
        listener.wait(0.2)  # a stroke that comes sooner is hurried
    return listener.moves


def place(string: int, pitch: float) -> float:
    """Where (m) an ideal string is stopped at a pitch."""
    silk = YEHU.strings[string]
    frequency = 440.0 * 2.0 ** ((pitch - 69.0) / 12.0)
    return YEHU.bridge_x - math.sqrt(silk.T / silk.rho_A) / (2.0 * frequency)


def test_without_variation_every_note_is_the_same_but_for_its_stroke():
    heard = phrase(0.0, 1)
    assert heard == phrase(0.0, 2)
    assert {abs(move.value) for move in heard if move.address == "/bow/speed"} == {0.2, 0.0}
    assert {move.value for move in heard if move.address == "/bow/pressure"} == {0.4}
    (position,) = {move.value for move in heard if move.address == "/finger/1/position"}
    assert position == pytest.approx(place(1, 75.0))


def test_with_variation_no_two_notes_are_alike_and_all_are_close():
    """And the same for the same seed."""
    heard = phrase(0.25, 3)
    assert heard == phrase(0.25, 3) != phrase(0.25, 4)
    usual = {"/bow/speed": 0.2, "/bow/pressure": 0.4, "/finger/1/position": place(1, 75.0)}
    for address, value in usual.items():
        values = [abs(move.value) for move in heard if move.address == address and move.value]
        assert len(set(values)) == 4
        assert values == pytest.approx([value] * 4, rel=0.15)


# ---------------------------------------------------------------- level


def test_volume_and_expression_multiply_and_loudness_is_their_square(player, listener):
    for name, value, level in (
        ("volume", 0.5, 0.25),
        ("expression", 0.5, 0.0625),
        ("volume", 1, 0.25),
    ):
        player.write(f"/playing/{name}", value)
        assert listener["/output/level"] == pytest.approx(level)
