"""What the page reads of a snapshot is what the instrument does."""

import json
import math
from typing import Any

import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.snapshot import SNAPSHOT, snapshot
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.schelleng import lower_limit, resistance, upper_limit
from yehu_server.core.player.commands import BEGIN

RATE = 44100.0
E5 = 76.0


@pytest.fixture(scope="module")
def instrument() -> Instrument:
    """One that has played a stopped note on the outer string for half a second."""
    played = Instrument(InstrumentSpec(RATE))
    played.post(BEGIN, value=E5, other=E5)
    played.process(np.zeros(22050, np.float32))
    return played


@pytest.fixture(scope="module")
def seen(instrument) -> Any:
    into = np.zeros(1, SNAPSHOT)
    snapshot.call(instrument.address, into.ctypes.data)
    return into[0]


@pytest.fixture(scope="module")
def snapshots(run_node, seen, page) -> Any:
    """What the page makes of it, and of an instrument at rest."""
    at_rest = np.zeros(1, SNAPSHOT)
    silent = Instrument(InstrumentSpec(RATE))
    snapshot.call(silent.address, at_rest.ctypes.data)
    rows = [np.frombuffer(record.tobytes(), np.float64) for record in (seen, at_rest[0])]
    lines = [[None if math.isnan(x) else x for x in row.tolist()] for row in rows]
    return [*map(json.loads, run_node("looking.mjs", page, lines=lines).splitlines())]


def test_strings_bow_and_fingers_are_where_they_are_and_what_is_heard_is_shown(
    snapshots, instrument, seen
):
    sounding = snapshots[0]
    assert (sounding["frame"], sounding["time"]) == (22050, 0.5)
    assert sounding["pitch"] == seen["pitch"]
    assert sounding["bow"] == {
        "string": 1,
        "speed": seen["speed"],
        "force": seen["force"],
        "beta": seen["beta"],
        "x": seen["bow_x"],
    }
    (finger,) = sounding["fingers"]
    assert (finger["press"], finger["string"]) == (max(seen["finger_press"]), 1)
    assert finger["x"] in seen["finger_x"]
    assert sounding["shape"] == [pytest.approx(shape, abs=1e-9) for shape in seen["shapes"]]
    assert sounding["string"] == {"length": seen["length"]}
    assert sounding["target"] == instrument.target("/bow/position")
    assert sounding["heard"] == {
        "certainty": seen["certainty"],
        "errorCents": seen["error"],
        "slips": seen["slips"],
    }
    heard = seen["frequency"] * 2.0 ** (seen["error"] / 1200.0)
    assert 1.0 / sounding["period"] == pytest.approx(heard)
    assert sounding["level"] == pytest.approx(20.0 * math.log10(seen["rms"]))


def test_the_limits_are_schellengs_at_the_bows_speed_and_place(snapshots, instrument, seen):
    m = instrument._rig["model"][0]
    Z = math.sqrt(m["T"][1] * m["rho_A"][1])
    grip = m["mu_S"] - m["mu_C"]
    speed, beta = abs(seen["speed"]), seen["beta"]
    stop = max(np.flatnonzero(seen["finger_press"]), key=lambda j: seen["finger_x"][j])
    held = seen["finger_x"][stop], seen["finger_press"][stop]
    R = resistance(m, 1, seen["frequency"], *held)
    limits = {"min": lower_limit(Z, grip, R, speed, beta), "max": upper_limit(Z, grip, speed, beta)}
    assert snapshots[0]["schelleng"] == pytest.approx(limits)
    assert limits["min"] < snapshots[0]["bow"]["force"] < limits["max"]


def test_at_rest_the_bow_is_on_no_string(snapshots):
    silent = snapshots[1]
    assert silent["bow"]["string"] == -1
    assert silent["pitch"] is None  # NaN
    assert silent["fingers"] == []
    assert silent["level"] == -160
