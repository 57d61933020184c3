"""The running instrument: blocks, silence, lost states, parameters."""

import math
import random

import numpy as np
import pytest
from sound import bow, rms, run, run_for

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import APPLIED_AT_ONCE
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities, StringQuantities
from yehu_server.errors import ParameterError
from yehu_server.params.table import ENGINE, TABLE

RATE = 44100


def level(samples: np.ndarray) -> float:
    """Peak in dB of full scale."""
    return 20.0 * math.log10(max(float(np.abs(samples).max()), 1e-12))


# ---------------------------------------------------------------- blocks


def busy(instrument: Instrument) -> None:
    """A second in which everything happens."""
    chance = random.Random(7)
    bow(instrument, press=1.5, frame=11)
    for number in range(60):
        frame = chance.randrange(2000, RATE)
        param = chance.choice(ENGINE)
        target = chance.choice([param.lo, param.hi, 0.0, *[chance.uniform(param.lo, param.hi)] * 3])
        if param.address == "/output/gain":
            target = min(target, 6.0)
        ramp = chance.choice([None, 0.0, 0.3, 5.0, 80.0])
        instrument.write(param.address, target, frame=frame, ramp_ms=ramp)
        if number % 10 == 0:
            instrument.write("/bow/side", chance.choice([-1.0, 1.0]), frame=frame)
            instrument.write("/bow/speed", 0.2, frame=frame)
    for number in range(3 * APPLIED_AT_ONCE):  # so that some have to wait
        instrument.write("/bow/speed", 0.2 + 0.001 * number, frame=15_000)
    instrument.silence(frame=20_000)
    bow(instrument, press=1.5, frame=20_500)


def played(block: int, rate: float = RATE) -> np.ndarray:
    instrument = Instrument(InstrumentSpec(rate))
    busy(instrument)
    out = run(instrument, RATE, block)
    assert instrument.frame == RATE
    assert instrument.lost_states == 0
    assert (np.abs(out) <= 1.0).all()  # also refuses NaN
    return out


@pytest.fixture(scope="module")
def whole() -> np.ndarray:
    return played(RATE)


@pytest.mark.parametrize("block", [1, 100, 4096])
def test_what_is_heard_does_not_depend_on_the_size_of_blocks(whole, block):
    assert rms(whole) > 0.001
    np.testing.assert_array_equal(played(block), whole)


def test_whatever_is_written_the_output_is_finite_and_within_full_scale_at_other_rates_too():
    for rate in (22050, 96000):
        assert rms(played(4096, rate)) > 0.001, rate


def test_a_block_with_gaps_in_memory_is_refused():
    """Other data lies between its samples and would be overwritten."""
    wider = np.zeros((64, 2), np.float32)
    with pytest.raises(TypeError, match="contiguous"):
        Instrument(InstrumentSpec(RATE)).process(wider[:, 0])
    assert not wider.any()


def test_after_a_reset_it_plays_as_if_new(whole):
    instrument = Instrument(InstrumentSpec(RATE))
    bow(instrument, press=3.0)
    instrument.write("/output/gain", 12.0)
    instrument.write("/bow/speed", 1.0, frame=RATE)  # still to come
    run_for(instrument, 0.5)
    instrument.reset()
    assert instrument.frame == 0
    busy(instrument)
    np.testing.assert_array_equal(run_for(instrument, 1.0), whole)


# ---------------------------------------------------------------- sound and silence


@pytest.mark.parametrize("rate", [22050, 44100, 96000])
def test_a_bowed_string_sounds_and_a_lifted_bow_lets_it_ring_out(rate):
    instrument = Instrument(InstrumentSpec(rate))
    bow(instrument)
    assert rms(run_for(instrument, 0.5)[rate // 4 :]) > 0.01
    instrument.write("/bow/side", 0.0)
    instrument.write("/bow/speed", 0.0)
    assert level(run_for(instrument, 4.0)[-rate // 2 :]) < -60.0


@pytest.mark.parametrize("press", [0.0, 1.5, 5.0])
def test_silence_ends_the_sound_within_five_milliseconds_and_puts_the_model_to_rest(press):
    instrument = Instrument(InstrumentSpec(RATE))
    bow(instrument, press)
    before = run_for(instrument, 0.5)
    assert level(before[-2000:]) > -40.0
    # The bow is lifted and the finger up at the same moment: nothing is left to sound.
    for address in ("/bow/speed", "/bow/side", "/finger/1/press"):
        instrument.write(address, 0.0, ramp_ms=0.0)
    for later in (0, 130):  # asked for again after 3 ms it comes no later
        instrument.silence(frame=len(before) + later)
    out = run_for(instrument, 0.5)
    end = round(0.005 * RATE)
    assert abs(float(out[0]) - float(before[-1])) < 0.05  # a fade, not a cut
    assert np.abs(out[end - 10 : end]).max() < 0.1 * np.abs(before[-2000:]).max()
    assert level(out[end + 1 :]) < -80.0
    motion = instrument._rig["state"][0]["motion"]
    assert not any(motion[name].any() for name in ("u", "q", "zeta"))
    assert (motion["U"][:, 0] == 0.5e-3).all()  # the finger at its rest height (m)


# ---------------------------------------------------------------- lost states


def spoil(instrument: Instrument, where: str, value: float) -> None:
    """Lose a part of the state, as far as it moves."""
    part = instrument._rig["state"]["motion"][where]
    part[...] = np.where(part == 0.0, part, value)


@pytest.mark.parametrize("press", [0.0, 5.0])
@pytest.mark.parametrize("where", ["u", "q", "zeta", "z", "U", "s_1"])
def test_a_lost_state_fades_is_counted_and_the_instrument_speaks_again(press, where):
    instrument = Instrument(InstrumentSpec(RATE))
    bow(instrument, press)
    before = run_for(instrument, 1.0)
    loud = rms(before[RATE // 2 :])
    step = float(np.abs(np.diff(before[RATE // 2 :])).max())
    spoil(instrument, where, math.nan)
    after = run_for(instrument, 1.0)
    assert np.isfinite(after).all()
    assert instrument.lost_states == 1
    joint = np.concatenate([before[-100:], after[:1000]])
    assert float(np.abs(np.diff(joint)).max()) < 2.0 * step + 0.01  # no click
    assert rms(after[RATE // 2 :]) == pytest.approx(loud, rel=0.3)


# ---------------------------------------------------------------- what it accepts


def test_every_parameter_of_the_engine_answers_and_is_clamped():
    instrument = Instrument(InstrumentSpec(RATE))
    for param in ENGINE:
        wanted = param.hi, param.lo, 0.5 * (param.lo + param.hi)
        given = 1e9, -1e9, wanted[2]
        assert tuple(instrument.write(param.address, value) for value in given) == wanted, param


def test_what_the_engine_does_not_know_or_cannot_reckon_with_is_refused():
    instrument = Instrument(InstrumentSpec(RATE))
    for address, value in [
        ("/bow/speeed", 0.1),
        ("", 0.1),
        ("/bow/speed", math.nan),
        ("/bow/speed", math.inf),
        ("/bow/speed", True),
        ("/bow/speed", "0.1"),
        *((param.address, param.default) for param in TABLE if param not in ENGINE),
    ]:
        with pytest.raises(ParameterError):
            instrument.write(address, value)
    assert not run_for(instrument, 0.01).any()


def test_a_rate_or_a_string_the_model_is_not_made_for_is_refused():
    for rate in (0.0, -44100.0, 8000.0, 22049.0, 192001.0, math.nan, math.inf):
        with pytest.raises(ParameterError, match="sample rate"):
            Instrument(InstrumentSpec(rate))
    stiff = StringQuantities(r=5e-3, E=1e12)
    with pytest.raises(ParameterError, match="grid"):
        Instrument(InstrumentSpec(22050.0, Quantities(string_1=stiff)))
