"""The output stage: gain, level, limiter."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sound import bow, run

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.limiter import CEILING, limit
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.rendering.to_files import TruePeak

RATE = 44100
KNEE = 10.0 ** (-3.0 / 20.0)

sizes = st.floats(allow_nan=False)
knees = st.sampled_from([KNEE, 0.063, 0.5, 1.0])


@settings(max_examples=100)
@given(st.floats(-1.0, 1.0), knees)
def test_the_limiter_leaves_what_is_below_its_knee(share, knee):
    x = share * min(knee, CEILING)
    assert limit(x, knee) == x


@settings(max_examples=100)
@given(sizes | st.floats(-3.0, 3.0), knees)
def test_the_limiter_is_odd_and_never_exceeds_its_ceiling(x, knee):
    assert abs(limit(x, knee)) <= CEILING
    assert limit(-x, knee) == -limit(x, knee)


def test_the_limiter_has_no_corner():
    x = np.linspace(0.6, 1.5, 9001)
    y = np.array([limit(value, KNEE) for value in x])
    slopes = np.diff(y) / np.diff(x)
    assert slopes.max() < 1.0 + 1e-9
    assert np.abs(np.diff(slopes)).max() < 1e-3
    assert (np.diff(slopes) < 1e-9).all()  # it only ever bends down


def bowed(**values: float) -> np.ndarray:
    """Half a second of the bowed string; names of parameters have two underscores for a slash."""
    instrument = Instrument(InstrumentSpec(RATE))
    for name, value in values.items():
        instrument.write("/" + name.replace("__", "/"), value, ramp_ms=0.0)
    bow(instrument)
    return run(instrument, RATE // 2)


@pytest.fixture(scope="module")
def soft() -> np.ndarray:
    out = bowed(output__gain=-12.0)
    assert 0.001 < np.abs(out).max() < 0.3
    return out


@pytest.mark.parametrize(
    ("gain_db", "level", "factor"),
    [(-6.0, 1.0, 10 ** (6 / 20)), (-12.0, 0.25, 0.25), (-12.0, 0.0, 0.0), (-60.0, 1.0, 10**-2.4)],
)
def test_gain_is_in_decibels_and_level_in_amplitude(soft, gain_db, level, factor):
    found = bowed(output__gain=gain_db, output__level=level)
    np.testing.assert_allclose(found, factor * soft, rtol=1e-5, atol=1e-9)


def test_a_loud_instrument_is_bent_from_where_the_limiter_begins_and_clipped_at_0_db(soft):
    as_it_is = 10 ** (36 / 20) * soft.astype(float)
    for limiter_db in (-3.0, -20.0):
        knee = 10 ** (limiter_db / 20)
        loud, peak = bowed(output__gain=24.0, output__limiter=limiter_db), TruePeak()
        peak.add(loud)
        assert knee < np.abs(loud).max() < peak.finish() < 1.0
        np.testing.assert_allclose(loud, [limit(x, knee) for x in as_it_is], atol=1e-5)
    cut = bowed(output__gain=24.0, output__limiter=0.0)
    np.testing.assert_allclose(cut, np.clip(as_it_is, -CEILING, CEILING), atol=1e-5)


def test_the_blend_goes_from_the_body_to_the_bridge():
    body, half, bridge = (
        bowed(body__blend=blend)[RATE // 5 :].astype(float) for blend in (0.0, 0.5, 1.0)
    )
    assert half == pytest.approx(0.5 * (body + bridge), abs=1e-6)
    assert 0.1 < body.std() / bridge.std() < 10.0  # about as loud
    # F4's fundamental is weak in what the body radiates.
    fundamental = np.exp(-2j * np.pi * 346.7 * np.arange(len(body)) / RATE) * np.hanning(len(body))
    shares = [abs(x @ fundamental) / x.std() for x in (body, bridge)]
    assert shares[1] > 2.0 * shares[0]
