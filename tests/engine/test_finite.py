"""Every sample is finite and within full scale, whatever the instrument's state is."""

import math

import numpy as np
import pytest
from sound import bow, run

from yehu_server.engine import native
from yehu_server.engine.instrument import Instrument
from yehu_server.params.table import ENGINE, SLOT
from yehu_server.player.rows import ROWS
from yehu_server.player.wishes import BEGIN, KINDS, RAMP

BAD = (math.nan, math.inf, -math.inf, 1e308, -1e308)
STAGES = ("state", "controls", "player", "output")


def fields(stage: str) -> list[str]:
    """The names of a record's floating-point fields."""
    kind = native.RIG[stage]
    return [name for name in kind.names if kind[name].base == np.float64]


@pytest.fixture(scope="module")
def playing() -> np.ndarray:
    """The rig of an instrument in the middle of a stopped note."""
    instrument = Instrument(44100)
    bow(instrument, press=1.5)
    run(instrument, 4410)
    return instrument._rig.copy()


@pytest.fixture(scope="module")
def instrument() -> Instrument:
    return Instrument(44100)


@pytest.mark.parametrize(("stage", "field"), [(s, field) for s in STAGES for field in fields(s)])
def test_whatever_a_stage_holds_every_sample_is_finite(instrument, playing, stage, field):
    for bad in BAD:
        instrument._rig[:] = playing
        instrument._rig[stage][field] = bad
        out = np.full(256, np.nan, np.float32)
        instrument.process(out)
        assert (np.abs(out) <= 1.0).all()  # also refuses NaN
        tape = instrument._rig["tape"][0]
        assert np.isfinite(tape).all()


def test_what_was_no_number_is_counted_and_the_sound_comes_back(instrument, playing):
    instrument._rig[:] = playing
    instrument._rig["output"]["ghost"] = math.nan
    out = np.zeros(44100, np.float32)
    instrument.process(out)
    assert instrument.lost_states == 1
    assert instrument.meters()["lost"] == 1
    assert out[0] == 0.0
    assert np.abs(out[-4410:]).max() > 0.01


@pytest.mark.parametrize("target", [9e18, -9e18, 1e308, math.inf, -math.inf])
@pytest.mark.parametrize("ramp", [0, 1, 4410, 9 * 10**18])
def test_no_ramp_leads_out_of_a_parameters_range(instrument, playing, target, ramp):
    instrument._rig[:] = playing
    start = instrument.frame
    for slot in SLOT.values():
        instrument.post(RAMP, frame=start, index=slot, value=target, other=ramp)
    out = np.zeros(128, np.float32)
    instrument.process(out)
    values = instrument._rig["controls"]["value"][0]
    for param in ENGINE:
        # The last bits: a value goes along its ramp in steps.
        margin = 1e-9 * max(1.0, abs(param.lo), abs(param.hi))
        assert param.lo - margin <= values[SLOT[param.address]] <= param.hi + margin
    assert (np.abs(out) <= 1.0).all()


def test_a_target_that_is_no_number_is_passed_over(instrument, playing):
    instrument._rig[:] = playing
    before = instrument._rig["controls"]["target"].copy()
    for slot in SLOT.values():
        instrument.post(RAMP, index=slot, value=math.nan, other=100)
    instrument.process(np.zeros(64, np.float32))
    assert np.array_equal(instrument._rig["controls"]["target"], before)


@pytest.mark.parametrize("kind", range(len(KINDS)), ids=KINDS)
@pytest.mark.parametrize("sounds", [False, True], ids=["in silence", "in a note"])
def test_whatever_is_wished_for_every_sample_is_finite(instrument, playing, kind, sounds):
    for bad in BAD:
        instrument._rig[:] = playing
        if sounds:
            instrument.post(BEGIN, value=69.0, other=69.0)
        for index in range(ROWS):
            instrument.post(kind, index=index, value=bad, other=bad)
            instrument.post(kind, index=index, value=0.5, other=bad)
            instrument.post(kind, index=index, value=bad, other=0.0)
        instrument.post(BEGIN, value=70.0, other=70.0)
        out = np.full(1024, np.nan, np.float32)
        instrument.process(out)
        assert (np.abs(out) <= 1.0).all()  # also refuses NaN
