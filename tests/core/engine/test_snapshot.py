"""What pictures are drawn from is what the instrument does."""

import math

import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.snapshot import NO_STRING, SNAPSHOT, snapshot
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.layout import V_B, X_B
from yehu_server.core.player.commands import BEGIN, HOLD
from yehu_server.core.player.parameter_indices import INDEX

RATE = 44100.0


def seen(instrument: Instrument):
    into = np.zeros(1, SNAPSHOT)
    snapshot.call(instrument.address, into.ctypes.data)
    return into[0]


def play(instrument: Instrument, frames: int) -> np.ndarray:
    out = np.zeros(frames, np.float32)
    instrument.process(out)
    return out


def test_at_rest_nothing_sounds_and_nothing_touches_a_string():
    found = seen(Instrument(InstrumentSpec(RATE)))
    assert (found["frame"], found["rate"]) == (0, RATE)
    assert found["string"] == NO_STRING
    assert math.isnan(found["pitch"])
    assert found["force"] == 0.0
    assert not found["finger_press"].any()
    assert not found["shapes"].any()


def test_of_a_bowed_note_it_tells_pitch_bow_fingers_and_strings():
    instrument = Instrument(InstrumentSpec(RATE))
    instrument.post(BEGIN, value=79.0, other=79.0)  # on the C string
    out = play(instrument, 22050)
    found = seen(instrument)
    assert found["frame"] == 22050
    assert found["pitch"] == pytest.approx(79.0, abs=0.05)  # it varies from note to note
    assert found["frequency"] == pytest.approx(440.0 * 2.0 ** ((found["pitch"] - 69.0) / 12.0))
    assert found["string"] == 1
    controls = instrument._rig["output"]["controls"][0]
    last = (22050 - 1) % 64  # of a chunk of the callback
    assert abs(found["speed"]) == pytest.approx(abs(controls[last, V_B]))
    assert found["bow_x"] == pytest.approx(controls[last, X_B])
    speed, beta = abs(found["speed"]), found["beta"]  # within Schelleng's limits
    assert found["lower"] * speed / beta**2 < found["force"] < found["upper"] * speed / beta
    assert np.count_nonzero(found["finger_press"]) == 1
    stopped = found["finger_x"][found["finger_press"] > 0.0][0]
    assert 0.0 < stopped < found["bow_x"] < found["length"]
    assert found["certainty"] > 0.9
    assert found["slips"] == pytest.approx(1.0, abs=0.2)
    assert found["peak"] == pytest.approx(np.abs(out[-735:]).max(), rel=0.2)
    moving = np.abs(found["shapes"]).max(axis=1)
    assert (moving > 1e-5).all()  # the body moves the other one
    assert (moving < 1e-2).all()


@pytest.mark.parametrize("length", [0.7, 0.3])
def test_the_string_is_at_its_place_on_the_hair_and_goes_as_the_bow_is_drawn(length):
    """To the tip and back, within a bow that turns before its ends."""
    instrument = Instrument(InstrumentSpec(RATE))
    instrument.post(HOLD, index=INDEX["/playing/bow_length"], value=length)
    instrument.post(BEGIN, value=69.0, other=69.0)
    snapshots = np.zeros(200, SNAPSHOT)
    for number in range(len(snapshots)):
        play(instrument, 1102)
        snapshots[number] = seen(instrument)
    places, speeds = snapshots["hair_place"], snapshots["speed"]
    assert set(snapshots["hair_length"]) == {length}
    assert 0.0 < places.min() < 0.25 * length
    assert 0.75 * length < places.max() < length
    steady = np.abs(np.diff(speeds)) < 0.01
    expected = speeds[1:] * 1102 / RATE
    assert np.diff(places)[steady] == pytest.approx(expected[steady], abs=5e-4)
