"""An instrument with torsion and wide hair, played by the same callback as others."""

import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.errors import ParameterError

RATE = 44100
REFINED = override(Quantities(), {"torsion": "on", "bow": {"width": 0.008}})


def played(quantities, block, frames=6000):
    """A bowed string, computed in blocks of so many frames; and the instrument."""
    instrument = Instrument(InstrumentSpec(RATE, quantities))
    for name, value in (("side", 1.0), ("speed", 0.2)):
        instrument.write(f"/bow/{name}", value, ramp_ms=0.0)
    out = np.zeros(frames, np.float32)
    for start in range(0, frames, block):
        instrument.process(out[start : start + block])
    return out, instrument


def test_torsion_and_width_are_heard_the_same_in_blocks_of_any_size():
    plain, _ = played(Quantities(), 6000)
    at_once, instrument = played(REFINED, 6000)
    in_blocks, _ = played(REFINED, 61)
    np.testing.assert_array_equal(in_blocks, at_once)
    assert np.abs(at_once - plain).max() > 0.01 * np.abs(plain).max() > 0.0
    assert instrument.lost_states == 0
    instrument.come_to_rest()
    assert not instrument._rig["refined"]["twist"].any()
    instrument.reset()
    again = np.zeros_like(at_once)
    for name, value in (("side", 1.0), ("speed", 0.2)):
        instrument.write(f"/bow/{name}", value, ramp_ms=0.0)
    instrument.process(again)
    np.testing.assert_array_equal(again, at_once)


def test_they_are_not_played_live_where_another_process_has_the_sound():
    with pytest.raises(
        ParameterError, match="torsion, wide hair, hyperbolic and viscous friction are not played"
    ):
        Instrument(InstrumentSpec(RATE, REFINED), is_live=True)
