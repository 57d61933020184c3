"""Gestures that are varied."""

import numpy as np
import pytest

from yehu_lab.regimes.columns import REGIMES
from yehu_lab.regimes.judge import judge
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_server.errors import ParameterError
from yehu_server.simulation.run import simulate

GESTURE = {
    "duration": 0.15,
    "controls": {
        "bow_force": [[0, 0.0], [0.02, 0.7]],
        "bow_velocity": [[0, 0.0], [0.03, 0.2]],
        "finger_position": 0.1,
        "press_force": 1.5,
    },
}


def study(**vary):
    return study_of({"gesture": GESTURE, "vary": vary})


@pytest.mark.parametrize(
    "vary",
    [
        {"bow_force": [0.4, -0.4, 0.7]},
        {"controls.bow_velocity": [0.1, 0.25], "instrument.bow.mu_S": [0.9, 1.0]},
        # Within a regime: at its border, another rounding leads to another one.
        {"bow_acceleration": [2.0, 12.0], "bow_position": [0.258, 0.267]},
        {"duration": [0.12, 0.15], "sample_rate": [44100, 48000]},
    ],
    ids=",".join,
)
def test_a_stroke_is_the_gesture_that_simulate_runs(vary):
    varied = study(**vary)
    result = sweep(varied, workers=2)
    assert len(result) == np.prod(varied.shape)
    instruments, strokes, _ = varied.bow.strokes(varied.axes, result.index)
    for at in range(len(result)):
        gesture = varied.bow.gesture(varied.axes, result.index[at].tolist())
        run = simulate(gesture).arrays
        sound = run["pressure"], gesture.sample_rate, float(strokes["frequency_hz"][at])
        finding = judge(run["relative_velocity"], run["bow_velocity"], *sound)
        assert REGIMES[result.columns["regime"][at]] == finding.regime
        # To the sample: what is before has not had the time to drift apart.
        assert result.columns["first_slip_s"][at] == pytest.approx(
            finding.first_slip_s, abs=2.5 / gesture.sample_rate
        )
    assert len(instruments.models) == len(instruments.rests)


def test_an_open_string_tells_no_direction_of_a_mirrored_bow():
    gesture = {"duration": 0.15, "controls": {"bow_velocity": [[0, 0.0], [0.02, 1.0]]}}
    vary = {"bow_velocity": [0.8, -0.8], "bow_force": [0.7, 2.5], "bow_position": [0.235, 0.27]}
    result = sweep(study_of({"gesture": gesture, "vary": vary}), workers=1)
    for name in ("regime", "slips", "level_db", "brightness_hz"):
        one, mirrored = result.grid(name)
        np.testing.assert_array_equal(one, mirrored)


def test_the_note_of_a_gesture_is_that_of_its_string_and_finger():
    varied = study(bow_force=[0.5, -0.5], finger_position=[0.1, 0.15])
    strokes = varied.bow.strokes(varied.axes, np.array([[0, 0], [0, 1], [1, 0], [1, 1]]))[1]
    # c / 2 (x_c - x_f) of each string, without stiffness; [Yehu] table 1.
    speeds = [
        (50.61 / (1250 * np.pi * 0.55e-3**2)) ** 0.5,
        (64.29 / (1350 * np.pi * 0.4e-3**2)) ** 0.5,
    ]
    expected = [c / (2 * (0.3 - x)) for c in speeds for x in (0.1, 0.15)]
    assert strokes["frequency_hz"] == pytest.approx(expected)
    open_string = {"gesture": {"duration": 0.1, "controls": {"bow_velocity": 0.2}}}
    varied = study_of(open_string | {"vary": {"bow_force": [0.5]}})
    strokes = varied.bow.strokes(varied.axes, np.array([[0]]))[1]
    assert strokes["frequency_hz"][0] == pytest.approx(345, rel=0.02)


def test_what_cannot_be_varied_is_reported(subtests):
    for vary, wrong in [
        ({"bow_force": [0.1, 99.0]}, "bow_force: 99.0 is not within"),
        ({"bow_farce": [1.0]}, r"bow_farce: unknown entry; did you mean bow_force\?"),
        ({"instrument.bow.nothing": [1.0]}, "nothing: unknown entry"),
        ({"duration.x": [1.0]}, "no such entry"),
        ({"duration": [0.01]}, "too short to judge"),
        ({"bow_acceleration": [0.0]}, "bow_acceleration: 0.0 is not within"),
        ({"finger_position": [0.1, 0.39]}, "is not between the loop"),
        ({"bow_force": ["much"]}, "bow_force"),
    ]:
        with subtests.test(vary=vary, wrong=wrong), pytest.raises(ParameterError, match=wrong):
            study(**vary)
