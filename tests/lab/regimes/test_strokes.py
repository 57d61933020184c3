"""Whole strokes in one compiled call."""

import numpy as np
import pytest

from yehu_lab.regimes.columns import FINDING, HELMHOLTZ, REGIMES
from yehu_lab.regimes.judge import judge
from yehu_lab.regimes.strokes import find, value_at
from yehu_lab.sweeps.study import limits_of, study_of
from yehu_server.simulation.run import simulate

DATA = {
    "duration": 0.15,
    "stroke": {"string": 1, "note": 75, "speed": 0.2, "acceleration": 20.0, "noise": 0.05},
    "vary": {"force": [0.06, 0.5, 0.8, 6.0], "position": [0.1, 0.16], "seed": [0, 1]},
}


def batch(data=DATA):
    study = study_of(data)
    index = np.stack(np.unravel_index(np.arange(np.prod(study.shape)), study.shape), axis=1)
    return study, index, study.bow.strokes(study.axes, index)


@pytest.fixture(scope="module")
def findings():
    return find(*batch()[2])


def test_strokes_find_the_same_in_any_order_and_number_to_the_bit(findings):
    _, _, (instruments, strokes, hands) = batch()
    order = np.random.default_rng(1).permutation(len(strokes))
    again = np.zeros_like(findings)
    for part in np.array_split(order, 3):
        again[part] = find(instruments, strokes[part], hands)
    for name in FINDING.names:  # by bytes, in which NaN is the same as NaN
        assert again[name].tobytes() == findings[name].tobytes()


def test_a_stroke_is_judged_as_its_simulation(findings):
    study, index, _ = batch()
    helmholtz = np.flatnonzero(findings["regime"] == HELMHOLTZ)
    assert len(helmholtz) >= 4
    for at in helmholtz[:2]:
        gesture = study.bow.gesture(study.axes, index[at].tolist())
        run = simulate(gesture).arrays
        sound = run["pressure"], gesture.sample_rate, 440.0 * 2 ** (6 / 12)
        finding = judge(run["relative_velocity"], run["bow_velocity"], *sound)
        assert finding.regime == REGIMES[HELMHOLTZ]
        # The model is chaotic, and controls differ by rounding.
        assert finding.pitch_hz == pytest.approx(float(findings["pitch_hz"][at]), rel=0.003)
        assert finding.level_db == pytest.approx(float(findings["level_db"][at]), abs=1.5)


def test_the_pitch_is_that_of_the_note_and_nothing_slips_before_the_bow_sets_off(findings):
    data = DATA | {"stroke": {"string": 2, "note": 79}, "vary": {"force": [0.5]}}
    for note, found in ((75, findings), (79, find(*batch(data)[2]))):
        helmholtz = found[found["regime"] == HELMHOLTZ]
        assert len(helmholtz) > 0
        cents = 1200 * np.log2(helmholtz["pitch_hz"] / (440.0 * 2 ** ((note - 69) / 12)))
        assert np.abs(cents).max() < 60.0  # hard strokes are flat
        assert (helmholtz["first_slip_s"] > 0.03).all()


def test_a_curve_is_held_before_its_first_point_and_after_its_last():
    times, values = np.array([1.0, 2.0]), np.array([0.2, 0.6])
    for time, value in ((-3.0, 0.2), (1.0, 0.2), (1.5, 0.4), (2.0, 0.6), (9.0, 0.6)):
        at = 0 if time < 2.0 else 1
        assert value_at(times, values, at, 1, time) == pytest.approx(value), time


def test_schellengs_limits_are_his_formulas_and_bracket_helmholtz_motion():
    """Between them it holds; far beyond them it does not. On the F string, away from its modes."""
    stroke = {"string": 2, "note": 79, "speed": 0.25, "position": 0.11}
    limits = limits_of(study_of({"stroke": stroke, "vary": {"seed": [0]}}), {})
    assert limits.beta == pytest.approx(0.11)
    assert limits.frequency_hz == pytest.approx(440.0 * 2 ** (10 / 12))
    # Wave impedance of the C string 0.209 kg/s; coefficients of friction 1.0207 and 0.5071.
    assert limits.upper == pytest.approx(2 * 0.209 * 0.25 / (0.11 * 0.5136), rel=0.02)
    base = {"duration": 0.3, "stroke": {"string": 1, "note": 75, "acceleration": 10.0}}
    for beta in (0.13, 0.16, 0.2):
        limits = limits_of(study_of(base | {"vary": {"position": [beta]}}), {})
        middle = (limits.lower * limits.upper) ** 0.5
        forces = [limits.lower / 5, middle, limits.upper * 8]
        study = base | {"vary": {"position": [beta], "force": forces}}
        is_helmholtz = find(*batch(study)[2])["regime"] == HELMHOLTZ
        assert is_helmholtz.tolist() == [False, True, False], beta


@pytest.mark.parametrize("kind", [{"scheme": "modal"}, {"directions": "two"}])
def test_strokes_of_modal_strings_and_in_two_directions_are_those_of_their_simulation(kind):
    stroke = {"string": 2, "note": 79, "acceleration": 20.0}
    instrument = {"instrument": kind, "duration": 0.1}
    study, index, strokes = batch({**instrument, "stroke": stroke, "vary": {"force": [0.5, 0.8]}})
    found = find(*strokes)
    run = simulate(study.bow.gesture(study.axes, index[0].tolist())).arrays
    sound = run["pressure"], 44100.0, 440.0 * 2 ** (10 / 12)
    finding = judge(run["relative_velocity"], run["bow_velocity"], *sound)
    assert finding.first_slip_s == pytest.approx(float(found["first_slip_s"][0]), abs=1e-4)
    assert finding.level_db == pytest.approx(float(found["level_db"][0]), abs=1.5)
    assert not found["faults"].any()
