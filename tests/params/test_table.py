"""The parameter table, row by row."""

import math
import re

import pytest

from yehu_server.api.checks import setting
from yehu_server.errors import ParameterError
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.spec import Curve, Place
from yehu_server.params.table import ENGINE, NAMES, TABLE, assignment, find, offered, read

# ---------------------------------------------------------------- every row


def test_each_row_is_complete_and_found_by_its_address():
    for param in TABLE:
        address = param.address
        assert find(address) is param
        assert address.startswith("/"), address
        assert address == address.lower().strip().rstrip("/")
        assert param.lo < param.hi, address
        assert param.lo <= param.default <= param.hi, address
        assert param.curve is not Curve.EXP or param.lo > 0.0, address
        assert param.smooth_ms >= 0.0, address
        assert param.unit, address
        assert param.doc.endswith("."), address


def test_each_row_takes_its_range_and_clamps_what_is_beyond():
    for param in TABLE:
        top = max(NAMES.get(param.address, {"": param.hi}).values())
        for value in (param.default, param.lo, top):
            assert param.clamped(value) == value, param.address
            assert assignment(f"{param.address}={value!r}") == (param.address, value)
            assert setting(param.address, value) == (param.address, value)
        if param.is_choice:
            for value in (param.lo + 0.5, top + 1.0):
                with pytest.raises(ParameterError, match=r"expected .* from|is not within"):
                    assignment(f"{param.address}={value!r}")
                with pytest.raises(ParameterError, match=r"expected .* from|is not within"):
                    setting(param.address, value)
        assert param.clamped(param.hi * 2.0 + 1.0) == param.hi, param.address
        assert param.clamped(param.lo - 1e300) == param.lo, param.address
        assert isinstance(param.clamped(1), float), param.address


def test_what_is_no_finite_number_is_refused_by_address():
    for param in TABLE:
        for value in (math.nan, math.inf, -math.inf, True, False, "1", None, [1.0]):
            with pytest.raises(ParameterError, match=param.address):
                param.clamped(value)
    with pytest.raises(ParameterError, match="not finite"):
        find("/bow/force").clamped(10**400)


def test_zero_to_one_is_the_whole_range_and_comes_back_from_each_value():
    units = [n / 100 for n in range(101)]
    for param in TABLE:
        steps = [param.from_unit(unit) for unit in units]
        assert steps == sorted(steps), param.address
        assert (steps[0], steps[-1]) == (param.lo, param.hi), param.address
        assert (param.from_unit(-1.0), param.from_unit(2.0)) == (param.lo, param.hi), param.address
        assert [param.to_unit(step) for step in steps] == pytest.approx(units, abs=1e-9)
        assert (param.to_unit(param.lo - 1.0), param.to_unit(param.hi + 1.0)) == (0.0, 1.0)
        values = {param.address: offered(param).from_unit(0.25)}
        assert read(values, param.address) == values[param.address]
        assert read(values, param.address + "/unit") == pytest.approx(0.25)


def test_the_engine_holds_its_rows_in_the_order_of_the_table():
    assert tuple(param for param in TABLE if param.place is Place.ENGINE) == ENGINE
    assert all(param.place is Place.ENGINE for param in TABLE if param.player_controlled)


# ---------------------------------------------------------------- finding and setting


def test_a_choice_may_be_named_in_python_as_on_the_command_line():
    for address, names in NAMES.items():
        for name, value in names.items():
            assert assignment(f"{address}={name}") == setting(address, name) == (address, value)
    assert setting("/playing/articulation", ARTICULATIONS[3].chinese)[1] == 3.0
    for address in ("/playing/articulation", "/bow/speed"):
        with pytest.raises(ParameterError, match=f"{address}: 'spicato' is n"):
            setting(address, "spicato")


@pytest.mark.parametrize(
    ("wrong", "meant"),
    [
        ("/bow/sped", "/bow/speed"),
        ("bow/force", "/bow/force"),
        ("/playing/pres", "/playing/press"),
        ("/finger/2/positon", "/finger/2/position"),
        ("bow_position", "/playing/bow_position"),
        ("/bow_position", "/playing/bow_position"),
        ("/plaing", "/playing/..."),
        ("/playing/artic", "/playing/articulation"),
        ("reverb", "/room/level"),
        ("speed", "/playing/speed or /bow/speed"),
        ("vibratto", "/playing/vibrato"),
    ],
)
def test_a_near_miss_is_answered_with_what_was_meant(wrong, meant):
    with pytest.raises(ParameterError, match=rf"'{wrong}'.*did you mean {re.escape(meant)}\?"):
        find(wrong)
    with pytest.raises(ParameterError, match=r"'wibble'; docs/parameters\.md has all"):
        find("wibble")


def test_a_setting_that_makes_no_sense_is_refused(subtests):
    for text, wrong in [
        ("/bow/position", "ADDRESS=VALUE"),
        ("", "ADDRESS=VALUE"),
        ("/bow/position=", "not a number"),
        ("/bow/position=x", "'x'"),
        ("/bow/position=0.1=0.2", "not a number"),
        ("/bow/position=nan", "not finite"),
        ("/bow/position=inf", "not finite"),
        ("/bow/position=0.6", "0.04 to 0.5"),
        ("/bow/force=-1", "0 to 5 N"),
        ("/bow/positio=0.1", "/bow/position"),
        ("=0.1", "unknown"),
    ]:
        with subtests.test(text=text, wrong=wrong), pytest.raises(ParameterError, match=wrong):
            assignment(text)


def test_a_value_of_a_list_is_set_by_its_name_too(subtests):
    for text, value in [
        ("/playing/articulation=trill", ("/playing/articulation", 20.0)),
        ("articulation=20", ("/playing/articulation", 20.0)),
        ("/playing/string=outer", ("/playing/string", 2.0)),
        ("/playing/direction=up", ("/playing/direction", -1.0)),
    ]:
        with subtests.test(text=text):
            assert assignment(text) == value
    with pytest.raises(ParameterError, match="did you mean trill"):
        assignment("/playing/articulation=tril")


# ---------------------------------------------------------------- curves


def test_curves_keep_their_ends_and_the_middle_each_has():
    for curve, middle in ((Curve.LIN, 2.5), (Curve.EXP, 2.0), (Curve.S, 2.5)):
        assert curve.from_unit(0.0, 1.0, 4.0) == 1.0
        assert curve.from_unit(0.5, 1.0, 4.0) == pytest.approx(middle)
        assert curve.from_unit(1.0, 1.0, 4.0) == 4.0
    assert Curve.S.from_unit(0.25, 0.0, 1.0) == pytest.approx(0.15625)
