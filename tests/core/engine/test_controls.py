"""From player-level targets to physical controls: ramps, bow force, bow and hand positions."""

import math

import numpy as np
import pytest
from sound import run

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.layout import F_N, FINGER_CONTROLS, V_B, X_B
from yehu_server.params.table import ENGINE, SLOT

RATE = 44100


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
    del targets["/pluck/force"]  # let go by itself, see test_hands.py
    for frames in (1, 500):
        run(instrument, frames)
        assert all_values(instrument).items() >= targets.items()


def test_a_write_that_names_no_ramp_takes_the_parameters_own_smoothing():
    for param in ENGINE:
        instrument, frames = Instrument(InstrumentSpec(RATE)), round(param.smooth_ms * 1e-3 * RATE)
        instrument.write(param.address, param.hi if param.default < param.hi else param.lo)
        run(instrument, frames - 1)
        assert value(instrument, param.address) not in {param.lo, param.hi}, param
        run(instrument, 1)
        assert value(instrument, param.address) in {param.lo, param.hi}, param


def test_a_write_without_a_ramp_acts_on_its_frame(instrument):
    instrument.write("/bow/speed", 0.3, frame=100, ramp_ms=0.0)
    run(instrument, 100)
    assert value(instrument, "/bow/speed") == 0.0
    run(instrument, 1)
    assert value(instrument, "/bow/speed") == 0.3


def test_a_later_write_starts_from_where_the_ramp_has_come(instrument):
    instrument.write("/bow/speed", 1.0, ramp_ms=1e3 * 100 / RATE)
    instrument.write("/bow/speed", -0.5, frame=50, ramp_ms=1e3 * 100 / RATE)
    speeds = []
    for _ in range(150):
        run(instrument, 1)
        speeds.append(value(instrument, "/bow/speed"))
    assert speeds[49] == pytest.approx(0.5)
    assert max(np.abs(np.diff(speeds))) < 0.0101  # neither ramp is steeper than 1/100
    assert speeds[-1] == -0.5


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


def test_bow_force_rises_with_speed_and_vanishes_without(instrument):
    forces = []
    for speed in (0.0, 0.05, 0.1, 0.2, 0.35):
        instrument.write("/bow/side", 1.0, ramp_ms=0.0)
        instrument.write("/bow/speed", speed, ramp_ms=0.0)
        forces.append(controls(instrument)[F_N])
    assert forces[0] == 0.0
    assert all(np.diff(forces) > 0.0)
    # It stays between what 0.3 of the limit and the whole limit are, at every speed.
    for speed, force in zip((0.05, 0.1, 0.2, 0.35), forces[1:], strict=True):
        assert 0.3 < force / schelleng(0, speed, 0.13) < 1.0


def test_without_assist_the_force_is_in_newtons_and_the_side_fades_it_whatever_the_speed(
    instrument,
):
    instrument.write("/bow/assist", 0.0, ramp_ms=0.0)
    instrument.write("/bow/force", 0.8, ramp_ms=0.0)
    for side, speed in ((1.0, 0.0), (0.5, 0.3), (0.0, 0.3), (-0.25, 0.1)):
        instrument.write("/bow/side", side, ramp_ms=0.0)
        instrument.write("/bow/speed", speed, ramp_ms=0.0)
        assert controls(instrument)[F_N] == pytest.approx(0.8 * side)


def test_the_bow_moves_smoothly_when_a_finger_lands(instrument):
    instrument.write("/finger/1/position", 0.15, ramp_ms=0.0)
    instrument.write("/finger/1/press", 1.5, ramp_ms=0.0)
    places = [controls(instrument)[X_B] for _ in range(2000)]
    assert max(np.abs(np.diff(places))) < 1e-4  # m a sample: below 5 m/s


# ---------------------------------------------------------------- the hand


def test_a_finger_that_is_up_waits_near_the_loop(instrument):
    assert controls(instrument)[FINGER_CONTROLS] < 0.02
    instrument.write("/finger/1/position", 0.12, ramp_ms=0.0)
    instrument.write("/finger/1/press", 1.5, ramp_ms=0.0)
    run(instrument, 100)
    instrument.write("/finger/1/press", 0.0, ramp_ms=0.0)
    assert controls(instrument)[FINGER_CONTROLS] == 0.12  # it leaves the string first
    run(instrument, RATE // 10)
    assert controls(instrument)[FINGER_CONTROLS] < 0.02
