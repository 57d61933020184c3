"""Sounds of a data set: what they are, and what is told of them."""

import numpy as np
import pytest

from yehu_lab.dataset.description import description_of
from yehu_lab.dataset.notes import melody, stroke
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.errors import ParameterError

# Well between Schelleng's limits; then with hardly any force, and with far too much.
ORDINARY = {"bow_velocity": 0.2, "bow_force": 0.7, "bow_position": 0.12, "stop": 2.0}


def sound(**draw):
    return stroke(description_of({"draw": ORDINARY | draw}), 0)


def test_an_ordinary_stroke_is_helmholtz_at_its_pitch():
    made = sound(duration=0.6)
    labels = made.labels
    assert labels["regime"] == labels["last_regime"] == "helmholtz"
    assert labels["pitch_hz"] == pytest.approx(392.0, rel=0.03)  # two semitones above F4
    assert labels["slips"] == pytest.approx(1.0, abs=0.05)
    assert 0.0 < labels["helmholtz_s"] < 0.3
    assert np.array_equal(made.audio, made.arrays["pressure"].astype(np.float32))
    open_string = sound(stop=0.0)
    assert not open_string.arrays["press_force"].any()
    assert open_string.labels["pitch_hz"] == pytest.approx(349.23, rel=0.02)


def test_the_hidden_controls_are_what_was_drawn():
    made = sound(string=2, duration=0.5, bow_velocity_end=0.1, attack=0.05, force_attack=0.0)
    arrays = made.arrays
    assert arrays["bow_force"].tolist() == [-0.7] * 22050  # the outer string, by its sign
    at = round(0.05 * 44100)
    assert arrays["bow_velocity"][at] == pytest.approx(0.2, abs=1e-3)
    assert arrays["bow_velocity"][-1] == pytest.approx(0.1, abs=1e-3)
    assert arrays["bow_velocity"][at // 2] == pytest.approx(0.1, abs=1e-3)
    length = Quantities().bridge_x - arrays["finger_position"][0]
    assert (Quantities().bridge_x - arrays["bow_position"][0]) / length == pytest.approx(0.12)
    # Two semitones shorten an ideal string by 2 ** (-2 / 12).
    assert length == pytest.approx(Quantities().bridge_x * 2.0 ** (-2 / 12), rel=0.02)
    assert arrays["press_force"][0] == 1.5


def test_a_slide_is_judged_at_the_pitch_of_the_moment():
    found = sound(duration=0.6, stop_end=2.3).found
    asked = found["asked_hz"]
    assert asked[0] == pytest.approx(392.0, rel=5e-3)
    assert asked[-1] == pytest.approx(392.0 * 2.0 ** (0.3 / 12.0), rel=5e-3)
    assert (np.diff(asked) > 0.0).all()


def test_the_player_plays_the_notes_that_were_drawn():
    notes = {"notes": 2, "pitch": {"choose": [69, 74]}, "length": {"from": 0.3, "to": 0.5}}
    draw = notes | {"gap": 0.1, "/playing/pressure": 0.4}
    drawn = description_of({"kind": "notes", "draw": draw})
    number = next(n for n in range(50) if drawn.draw(n, "pitch") != drawn.draw(n, "pitch", 1))
    made = melody(drawn, number)
    first, second = made.drawn["notes"]
    assert second["begin"] == pytest.approx(first["end"] + 0.1)
    times, asked = made.found["regime_time"], made.found["asked_hz"]
    for note in (first, second):
        middle = np.searchsorted(times, 0.5 * (note["begin"] + note["end"]))
        hertz = 440.0 * 2.0 ** ((note["pitch"] - 69.0) / 12.0)
        assert asked[middle] == pytest.approx(hertz, rel=5e-3)  # hands vary a little
    assert made.labels["regime"] == "helmholtz"
    assert made.arrays["finger_position"].shape == (len(made.audio), 4)
    unbowed = made.found["regime"][times > second["end"] + 0.25]
    assert not unbowed.any()


WRONG = {
    "kind: 'x' is not one of strokes, notes": {"kind": "x"},
    "count: expected a whole number": {"count": 0},
    "sound: unknown entry": {"sound": 1},
    "draw.bow_pressure: unknown entry": {"draw": {"bow_pressure": 1.0}},
    "draw.bow_force: -1 to -1 is not within 0 to 50": {"draw": {"bow_force": -1.0}},
    "draw.string: whole numbers only": {"draw": {"string": {"from": 1, "to": 2}}},
    "keep.signals: 'pressur' is not one of": {"keep": {"signals": ["pressur"]}},
    "keep.every: expected a whole number": {"keep": {"every": 0}},
    "split: a/b: is not a plain folder name": {"split": {"a/b": 1}},
    "split: names that differ": {"split": {"a": 1, "A": 1}},
    "split: weights must be 0 or more": {"split": {"a": 0}},
    "instrument": {"instrument": {"x": 1}},
    "rate": {"sample_rate": 1},
    "/playing/x": {"kind": "notes", "draw": {"/playing/x": 1}},
}


def test_a_wrong_description_is_refused_by_its_entry(subtests):
    for wrong, entries in WRONG.items():
        with subtests.test(wrong=wrong):
            with pytest.raises(ParameterError) as error:
                description_of(entries)
            assert wrong in str(error.value)
            assert "\n" not in str(error.value)
