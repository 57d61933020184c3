"""Every sample is finite and within full scale, whatever the instrument's state is."""

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pytest
from sound import bow, run

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import BEGIN, KINDS
from yehu_server.core.player.parameter_indices import PARAMETER_COUNT
from yehu_server.core.stage.directivity import SIDES
from yehu_server.core.stage.late_field import LATE_FIELD
from yehu_server.core.stage.seat import SEAT

RATE = 22050  # of those in a room
BAD = (math.nan, math.inf, -math.inf, 1e308, -1e308)
STAGES = ("state", "controls", "player", "output")


def of_floats(kind: np.dtype) -> list[str]:
    """The names of a record's floating-point fields."""
    return [name for name in kind.names if kind[name].base == np.float64]


def tried(names: Iterable[Any], everything: bool) -> Iterator[tuple[Any, float]]:
    """What is no number in each of these, and one of all else too; with --all, all of it."""
    for number, name in enumerate(names):
        for bad in BAD if everything else (math.nan, BAD[1 + number % (len(BAD) - 1)]):
            yield name, bad


@pytest.fixture(scope="module")
def playing() -> np.ndarray:
    """The rig of an instrument in the middle of a stopped note."""
    instrument = Instrument(InstrumentSpec(44100))
    bow(instrument, press=1.5)
    run(instrument, 4410)
    return instrument._rig.copy()


@pytest.fixture(scope="module")
def instrument() -> Instrument:
    return Instrument(InstrumentSpec(44100))


@pytest.mark.parametrize("stage", STAGES)
def test_whatever_a_stage_holds_every_sample_is_finite(instrument, playing, stage, everything):
    for field, bad in tried(of_floats(RIG[stage]), everything):
        instrument._rig[:] = playing
        instrument._rig[stage][field] = bad
        out = np.full(256, np.nan, np.float32)
        instrument.process(out)
        assert (np.abs(out) <= 1.0).all(), (field, bad)  # also refuses NaN
        assert np.isfinite(instrument._stage["tape"]).all(), (field, bad)


# ---------------------------------------------------------------- on a stage with a room


@pytest.fixture(scope="module")
def duet() -> tuple[Ensemble, np.ndarray]:
    """Two who bow in a room, and their memory in the middle of a note."""
    ensemble = Ensemble([InstrumentSpec(RATE, body=body) for body in range(2)])
    for instrument in ensemble.instruments:
        bow(instrument, press=1.5)
    ensemble.process(np.zeros((RATE // 10, 2), np.float32))
    return ensemble, ensemble.memory.copy()


# Fields that are only prepared at the start: what they lose does not come back.
PREPARED = {
    *("rate", "crossfade_step", "move_step", "open_step", "close_step"),
    *("c_1", "c_2", "pass_a", "pass_b"),
}


@pytest.mark.parametrize("kind", [SEAT, SIDES, LATE_FIELD], ids=["a seat", "sides", "a room"])
def test_whatever_a_stage_holds_the_mix_is_finite_and_comes_back(duet, kind, everything):
    ensemble, memory = duet
    fields = {
        SEAT: ensemble.instruments[1]._rig["seat"],
        SIDES: ensemble.instruments[0]._rig["seat"]["sides"],
        LATE_FIELD: ensemble._stage["room"],
    }[kind]
    for field, bad in tried(of_floats(kind), everything):
        ensemble.memory[:] = memory
        fields[field] = bad
        check_it_comes_back(ensemble, field, bad)


def check_it_comes_back(ensemble: Ensemble, field: str, bad: float) -> None:
    """The mix is finite; and sounds again, unless what was lost is only prepared at the start."""
    out = np.full((3 * RATE // 10, 2), np.nan, np.float32)
    before = int(ensemble._stage["invalid_samples"])
    for start in range(0, len(out), RATE // 10):
        ensemble.process(out[start : start + RATE // 10])
    assert (np.abs(out) <= 1.0).all(), (field, bad)  # also refuses NaN
    if field not in PREPARED:
        assert np.abs(out[-RATE // 10 :]).max() > 0.05, (field, bad)
        room = ensemble._stage["room"]
        assert np.isfinite(room["row"]).all(), (field, bad)
        # All begins anew at once, wherever a block begins: what was computed ahead is lost too.
        assert ensemble._stage["invalid_samples"] - before <= 2 * CHUNK, (field, bad)


@pytest.mark.parametrize("sounds", [False, True], ids=["in silence", "in a note"])
def test_whatever_is_asked_for_every_sample_is_finite(instrument, playing, sounds, everything):
    for kind, bad in tried(range(len(KINDS)), everything):
        instrument._rig[:] = playing
        if sounds:
            instrument.post(BEGIN, value=69.0, other=69.0)
        for index in range(PARAMETER_COUNT):
            instrument.post(kind, index=index, value=bad, other=bad)
            instrument.post(kind, index=index, value=0.5, other=bad)
            instrument.post(kind, index=index, value=bad, other=0.0)
        instrument.post(BEGIN, value=70.0, other=70.0)
        out = np.full(1024, np.nan, np.float32)
        instrument.process(out)
        assert (np.abs(out) <= 1.0).all(), (KINDS[kind], bad)  # also refuses NaN
