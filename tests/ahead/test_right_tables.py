"""Which tables are taken: all that Python writes, and none that lead astray."""

import math
from itertools import product

import pytest
from ahead.tables import TUNINGS, are_right, some_tables

from yehu_server.ahead.interface import use_tables
from yehu_server.ahead.table_checks import FIELDS
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi import tables as layout
from yehu_server.core.midi.tables import KEY_COUNT, MAX_BINDS, MAX_POINTS, TABLES
from yehu_server.core.player.parameter_indices import INDEX, PARAMETER_COUNT
from yehu_server.params.spec import Curve
from yehu_server.params.table import find
from yehu_server.playing.bind import Bind, Breakpoints
from yehu_server.playing.mapping import Mapping, load, shipped_mappings
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import RangePolicy

SPEED = find("/playing/speed")
BINDS = (
    Bind("cc 1", "/playing/speed", (0.1, 0.3), Curve.EXP),
    Bind("cc 1", "/playing/volume", None, Breakpoints(((0.0, 0.0), (0.5, 1.0), (1.0, 0.2)))),
    Bind("bend", "/playing/bend"),
    Bind("/fader", "/playing/volume"),
)
EXPONENTIAL, POINTED, BEND = range(3)  # binds


@pytest.fixture
def right():
    """Tables with something in every field."""
    return make_tables(
        Mapping("", BINDS),
        Controls(),
        start=[("/playing/volume", 0.5)],
        tuning=TUNINGS[1],
        a4=440.0,
        policy=RangePolicy.CLAMP,
        received={0, 15},
        programs=Presets().programs(),
    )


def test_all_that_python_writes_is_right(right):
    made = [right, layout.plain_tables(), *some_tables(5, 300)]
    for name in shipped_mappings():
        how = {"tuning": TUNINGS[0], "a4": 440.0, "policy": RangePolicy.SKIP}
        made.append(make_tables(load(name), Controls(), **how))
    assert all(map(are_right, made))


def test_no_field_has_a_wild_number(right):
    assert set(FIELDS) == set(TABLES.names or ())  # a rule holds for each
    taken = []
    for field, wrong in product(FIELDS, (math.nan, math.inf, -math.inf, -1e308)):
        made = right.copy()
        made[field].reshape(-1)[0] = wrong
        if are_right(made):
            taken.append((field, str(wrong)))
    # These stand for none.
    assert set(taken) == {(name, "nan") for name in ("first_switch", "pitch", "program_row")}


WRONG = [
    ("binds", 0, MAX_BINDS + 1),
    ("binds", 0, 1.5),
    ("source", BEND, 160),  # no pair
    ("source", BEND, 205),
    ("source", BEND, layout.NRPN + (1 << 14)),
    ("source", BEND, 100.5),
    ("source", BEND, 1),  # whose first bind is another
    ("first", POINTED, 1),
    ("first", BEND, MAX_BINDS),
    ("target", BEND, PARAMETER_COUNT),
    ("target", BEND, -1),
    ("lo", EXPONENTIAL, SPEED.lo - 1e-9),
    ("hi", EXPONENTIAL, SPEED.hi + 1e-9),
    ("lo", EXPONENTIAL, 0.0),  # of a curve of equal ratios
    ("curve", BEND, layout.POINTS + 1),
    ("curve", BEND, layout.EXPONENTIAL),
    ("first_point", POINTED, MAX_POINTS - 2),
    ("first_point", POINTED, 1),
    ("points", POINTED, 1),
    ("points", POINTED, MAX_POINTS),
    ("points", POINTED, 2),  # the last is not at 1
    ("x", 1, 0.0),
    ("x", 2, 0.9),
    ("y", 1, 1.1),
    ("channels", BEND, 1 << 16),
    ("channels", BEND, -1),
    ("soft", BEND, 2),
    ("input_hi", BEND, 1e308),
    ("starts", 0, PARAMETER_COUNT + 1),
    ("start_row", 0, PARAMETER_COUNT),
    ("start_value", 0, 1.5),
    ("usual", INDEX["/playing/speed"], SPEED.hi + 1.0),
    ("usual", INDEX["/playing/volume"], 1e-300),  # something is divided by it
    ("pitch", KEY_COUNT - 1, 1e308),
    ("policy", 0, 3),
    ("received", 0, 1 << 16),
    ("received", 0, -2),
    ("has_program", 0, 0.5),
    ("program_row", 0, PARAMETER_COUNT),
    ("program_row", 0, -1),
    ("program_value", 0, math.inf),
]


def test_what_would_lead_astray_is_refused_and_changes_nothing(right):
    instrument = Instrument(InstrumentSpec(48000.0), is_live=True)
    before = instrument.tables.tobytes()
    for field, place, wrong in WRONG:
        made = right.copy()
        made[field].reshape(-1)[place] = wrong
        given = instrument.address, 0, made.ctypes.data, made.nbytes
        assert use_tables.call(*given) == -1, (field, place, wrong)
    assert instrument.posted == 0
    assert instrument.tables.tobytes() == before
