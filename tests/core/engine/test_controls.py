"""From player-level targets to physical controls: ramps, bow, fingers, vibrato, tremolo, pluck."""

import math

import numpy as np
import pytest
from sound import run

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.layout import (
    CONTROLS_PER_FINGER,
    F_N,
    F_PLUCK,
    FINGER_CONTROLS,
    TEXTURE,
    V_B,
    X_B,
    X_PLUCK,
)
from yehu_server.params.table import ENGINE, SLOT

RATE = 44100
BRIDGE_X = 0.30  # m


def value(instrument: Instrument, address: str) -> float:
    return float(instrument._rig["controls"]["value"][0, SLOT[address]])


def all_values(instrument: Instrument) -> dict[str, float]:
    return {param.address: value(instrument, param.address) for param in ENGINE}


def controls(instrument: Instrument) -> np.ndarray:
    """The controls of one more frame."""
    run(instrument, 1)
    return instrument._rig["output"]["controls"][0, 0].copy()


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


# ---------------------------------------------------------------- ramps


def test_every_parameter_starts_at_its_default(instrument):
    assert all_values(instrument) == {param.address: param.default for param in ENGINE}


def test_all_ramps_go_straight_and_end_exactly_on_their_targets(instrument):
    starts = all_values(instrument)
    targets = {p.address: p.lo + 0.7310585786300049 * (p.hi - p.lo) for p in ENGINE}
    for address, target in targets.items():
        instrument.write(address, target, ramp_ms=1e3 * 337 / RATE)
    run(instrument, 100)
    between = {at: start + (targets[at] - start) * 100 / 337 for at, start in starts.items()}
    assert all_values(instrument) == pytest.approx(between)
    run(instrument, 236)
    assert not all_values(instrument).items() & targets.items()
    del targets["/pluck/force"]  # let go by itself, see below
    for frames in (1, 500):
        run(instrument, frames)
        assert all_values(instrument).items() >= targets.items()


def test_a_write_that_names_no_ramp_takes_the_parameters_own_smoothing():
    instrument, now = Instrument(InstrumentSpec(RATE)), 0
    for param in ENGINE:
        instrument.write(param.address, param.hi if param.default < param.hi else param.lo)
    for smooth_ms in sorted({param.smooth_ms for param in ENGINE}):
        for frame, are_there in ((end := round(smooth_ms * 1e-3 * RATE)) - 1, False), (end, True):
            run(instrument, frame - now)
            now = frame
            for param in ENGINE:
                if param.smooth_ms == smooth_ms:
                    found = value(instrument, param.address)
                    assert (found in {param.lo, param.hi}) == are_there, param


def test_a_write_without_a_ramp_acts_on_its_frame(instrument):
    instrument.write("/bow/speed", 0.3, frame=100, ramp_ms=0.0)
    run(instrument, 100)
    assert value(instrument, "/bow/speed") == 0.0
    run(instrument, 1)
    assert value(instrument, "/bow/speed") == 0.3


# ---------------------------------------------------------------- the bow


def schelleng(string: int, speed: float, beta: float) -> float:
    """F_max = 2 Z v / (beta (mu_S - mu_C)), from the paper's table 1 and data set."""
    tension, density, radius = [(50.61, 1250.0, 0.55e-3), (64.29, 1350.0, 0.40e-3)][string]
    impedance = math.sqrt(tension * density * math.pi * radius**2)
    return 2.0 * impedance * speed / (beta * (1.0207 - 0.5071))


@pytest.mark.parametrize(("side", "string", "speed"), [(1.0, 0, 0.02), (-1.0, 1, -0.02)])
def test_bow_force_is_the_asked_share_of_schellengs_limit(instrument, side, string, speed):
    wanted = {"side": side, "speed": speed, "pressure": 0.5, "position": 0.1}
    for name, target in wanted.items():
        instrument.write(f"/bow/{name}", target, ramp_ms=0.0)
    row = controls(instrument)
    # A slow bow: fast ones are given a little more.
    assert row[F_N] == pytest.approx(side * 0.5 * schelleng(string, 0.02, 0.1), rel=0.01)
    assert row[V_B] == speed


@pytest.mark.parametrize(("effort", "share"), [(0.0, 1.0), (0.03, 1.0), (0.09, 0.5), (0.45, 0.1)])
@pytest.mark.parametrize(("side", "string"), [(1.0, 0), (-1.0, 1)])
def test_hair_is_the_less_uneven_the_more_a_bow_presses_beyond_a_soft_one(
    instrument, side, string, effort, share
):
    # 0.045 m/s: speed times share of Schelleng's limit.
    put(instrument, bow_side=side, bow_speed=0.1, bow_position=0.1, bow_noise=0.04)
    put(instrument, bow_assist=0.0, bow_force=schelleng(string, effort, 0.1))
    assert controls(instrument)[TEXTURE] == pytest.approx(0.04 * share, rel=0.01)


def test_the_bow_moves_smoothly_when_a_finger_lands(instrument):
    put(instrument, finger_1_position=0.15, finger_1_press=1.5)
    places = [controls(instrument)[X_B] for _ in range(2000)]
    assert max(np.abs(np.diff(places))) < 1e-4  # m a sample: below 5 m/s


def test_a_bow_leaves_a_string_at_rest_and_meets_the_other_at_half_its_speed(instrument):
    put(instrument, bow_side=1.0, bow_speed=0.2, bow_pressure=0.5)
    speed, force = rows(instrument, 0.01)[-1, [V_B, F_N]]
    instrument.write("/bow/side", -1.0, ramp_ms=40.0)
    instrument.write("/bow/speed", 0.1, ramp_ms=40.0)
    found = rows(instrument, 0.05)
    speeds, forces = found[:, V_B], found[:, F_N]
    half, middle, there, end = (round(1e-3 * ms * RATE) for ms in (10, 20, 30, 40))
    assert speeds[half // 2] == pytest.approx(0.5 * speed, rel=0.02)
    assert np.abs(speeds[half : middle - 1]).max() < 1e-3
    assert forces[half] == pytest.approx(0.5 * 0.5 * 1.5 * force, rel=0.02)
    assert (np.diff(forces[: middle - 1]) < 0.0).all()
    assert forces[middle - 1] == pytest.approx(0.0, abs=1e-4 * force)
    assert speeds[[middle + 1, there, end]] == pytest.approx([0.05, 0.075, 0.1], rel=0.02)
    weights = forces[middle:] / speeds[middle:]  # of the speed's limit, but for FAST_SHARE
    assert weights[half // 2] == pytest.approx(0.5 * weights[half], rel=0.05)
    assert weights[half:] == pytest.approx(weights[-1], rel=0.1)
    assert (np.diff(forces[middle + 1 : end]) <= 0.0).all()


@pytest.mark.parametrize("ramp_ms", [0.0, 20.0])
def test_a_bow_that_turns_back_before_it_has_left_a_string_bows_on(instrument, ramp_ms):
    put(instrument, bow_side=1.0, bow_speed=0.2, bow_pressure=0.5)
    before = rows(instrument, 0.01)[-1, [V_B, F_N]]
    instrument.write("/bow/side", -1.0, ramp_ms=40.0)
    run(instrument, round(0.01 * RATE))
    instrument.write("/bow/side", 1.0, ramp_ms=ramp_ms)
    assert rows(instrument, 0.03)[-1, [V_B, F_N]] == pytest.approx(before)


# ---------------------------------------------------------------- fingers, tremolo, plucking


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
