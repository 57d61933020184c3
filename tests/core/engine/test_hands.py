"""Four fingers, vibrato, tremolo and plucking, as the engine turns them into controls."""

import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.layout import (
    CONTROLS_PER_FINGER,
    F_N,
    F_PLUCK,
    FINGER_CONTROLS,
    V_B,
    X_B,
    X_PLUCK,
)

RATE = 44100
BRIDGE_X = 0.30  # m


@pytest.fixture
def instrument() -> Instrument:
    return Instrument(InstrumentSpec(RATE))


def put(instrument: Instrument, **values: float) -> None:
    """Set parameters at once; a name's underscores are slashes."""
    for name, value in values.items():
        instrument.write("/" + name.replace("_", "/"), value, ramp_ms=0.0)


def rows(instrument: Instrument, seconds: float) -> np.ndarray:
    """Controls of the next seconds [shape=(frames, columns)]."""
    found = []
    for _ in range(round(seconds * RATE / 63)):
        instrument.process(np.zeros(63, np.float32))
        found.append(instrument._rig["output"]["controls"][0, :63].copy())
    return np.concatenate(found)


def place(number: int) -> int:
    return FINGER_CONTROLS + CONTROLS_PER_FINGER * (number - 1)


def test_each_finger_is_where_it_is_put(instrument):
    for number in (1, 2, 3, 4):
        put(instrument, **{f"finger_{number}_position": 0.04 * number})
        put(instrument, **{f"finger_{number}_press": 0.5 * number})
    row = rows(instrument, 0.01)[-1]
    for number in (1, 2, 3, 4):
        assert tuple(row[place(number) : place(number) + 2]) == (0.04 * number, 0.5 * number)


def test_the_bow_follows_the_finger_nearest_to_it_that_is_down(instrument):
    put(instrument, bow_position=0.1, finger_1_position=0.05, finger_1_press=1.0)
    put(instrument, finger_2_position=0.15, finger_2_press=1.0, finger_3_position=0.2)
    put(instrument, finger_4_position=0.03, finger_4_press=1.0)
    assert rows(instrument, 0.2)[-1][X_B] == pytest.approx(BRIDGE_X - 0.1 * 0.15, abs=1e-6)
    put(instrument, finger_2_press=0.0)
    assert rows(instrument, 0.2)[-1][X_B] == pytest.approx(BRIDGE_X - 0.1 * 0.25, abs=1e-6)
    put(instrument, finger_1_press=0.0, finger_4_press=0.0)
    assert rows(instrument, 0.2)[-1][X_B] == pytest.approx(BRIDGE_X - 0.1 * BRIDGE_X, abs=1e-6)


def test_vibrato_rocks_the_fingers_that_are_down_by_so_many_cents(instrument):
    put(instrument, finger_1_position=0.05, finger_1_press=1.0, finger_2_position=0.15)
    put(instrument, vibrato_depth=30.0, vibrato_rate=6.0)
    controls = rows(instrument, 1.05)
    length = BRIDGE_X - controls[:, place(1)]
    cents = -1200.0 * np.log2(length / 0.25)
    assert cents.max() == pytest.approx(30.0, abs=0.1)
    assert cents.min() == pytest.approx(-30.0, abs=0.1)
    rising = (cents[1:] > 0.0) & (cents[:-1] <= 0.0)
    assert rising.sum() == 6
    assert len(set(controls[2000:, place(2)])) == 1  # not one that is up
    assert np.ptp(controls[8000:, X_B]) < 1e-5  # nor the bow


def test_vibrato_may_press_instead(instrument):
    put(instrument, finger_1_press=2.0, vibrato_press=0.25, vibrato_rate=5.0)
    controls = rows(instrument, 1.0)
    press = controls[:, place(1) + 1]
    assert (press.min(), press.max()) == pytest.approx((1.5, 2.5), abs=1e-3)
    assert len(set(controls[:, place(1)])) == 1


def test_vibrato_comes_in_after_a_while_and_gently(instrument):
    put(instrument, finger_1_press=1.0, vibrato_depth=40.0, vibrato_onset=0.0)
    instrument.write("/vibrato/onset", 1.0, ramp_ms=1000.0)
    away = np.abs(rows(instrument, 1.5)[:, place(1)] - 0.05)
    at = [away[round(s * RATE) : round((s + 0.1) * RATE)].max() for s in (0.2, 0.5, 0.7, 1.2)]
    assert at[0] == 0.0
    assert 0.0 < at[1] < 0.3 * at[3]
    assert at[1] < at[2] < at[3]


def test_tremolo_turns_the_bow_so_often_and_its_force_with_it(instrument):
    put(instrument, bow_side=1.0, bow_speed=0.2, bow_tremolo=10.0)
    controls = rows(instrument, 1.0)
    speed = controls[:, V_B]
    assert (speed.min(), speed.max()) == pytest.approx((-0.2, 0.2))
    assert (np.diff(np.sign(speed)) != 0).sum() in (10, 20)  # a turn may touch zero
    slow = np.abs(speed) < 0.01
    assert slow.any()
    assert controls[slow, F_N].max() < 0.1 * controls[:, F_N].max()
    assert np.abs(np.diff(speed)).max() < 0.2 * 3.2 * np.pi * 10.0 / RATE


def test_after_tremolo_the_bow_goes_its_way_again(instrument):
    put(instrument, bow_speed=0.2, bow_tremolo=10.0)
    rows(instrument, 0.13)
    put(instrument, bow_tremolo=0.0)
    assert rows(instrument, 0.3)[-1][V_B] == 0.2
    assert set(rows(instrument, 0.2)[:, V_B]) == {0.2}


def test_a_pluck_pulls_and_lets_go_by_itself(instrument):
    instrument.write("/pluck/force", -2.0, ramp_ms=10.0)
    controls = rows(instrument, 0.02)
    pulled = controls[:, F_PLUCK]
    top = int(pulled.argmin())
    assert pulled[top] == -2.0
    assert top == round(0.01 * RATE) - 1
    assert np.flatnonzero(pulled[top:] == 0.0)[0] <= 0.001 * RATE
    assert pulled[-1] == 0.0
    assert controls[0, X_PLUCK] == pytest.approx(BRIDGE_X - 0.3 * BRIDGE_X)
