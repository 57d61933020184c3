"""From source to target and back: spans, curves, tables, inversion."""

import numpy as np
import pytest
from curves import from_unit, input_to_unit, picks_up, receives, to_unit
from hypothesis import given
from hypothesis import strategies as st

from yehu_server.params.spec import Curve
from yehu_server.playing.bind import Bind, Breakpoints

PRESSURE = "/playing/pressure"
units = st.floats(0.0, 1.0)
spans = st.tuples(st.floats(0.05, 2.0), st.floats(0.05, 2.0))


@st.composite
def tables(draw, *, rising: bool = False) -> Breakpoints:
    """Tables of up to eight points, a thousandth apart at least."""
    positions = draw(st.lists(st.integers(1, 999), max_size=6, unique=True))
    shares = draw(st.lists(st.integers(0, 1000), min_size=8, max_size=8, unique=rising))
    shares = sorted(shares) if rising else shares
    points = zip((0, *sorted(positions), 1000), shares, strict=False)
    return Breakpoints(tuple((position / 1000, share / 1000) for position, share in points))


curves = st.one_of(st.sampled_from(Curve), tables(rising=True))


@given(tables(), units)
def test_a_table_goes_through_its_points_and_is_straight_between_them(table, unit):
    bind = Bind("cc 7", "/playing/volume", (0.0, 1.0), table)
    for place in (unit, *(x for x, _ in table.points)):
        expected = np.interp(place, *zip(*table.points, strict=True))
        assert bind.from_unit(place) == from_unit(bind, place)
        assert from_unit(bind, place) == pytest.approx(expected, abs=1e-9)


@given(spans, curves, st.booleans(), units)
def test_every_value_is_found_back_at_a_place_that_gives_it(span, curve, invert, unit):
    bind = Bind("cc 4", PRESSURE, span, curve, invert)
    value = from_unit(bind, unit)
    position = to_unit(bind, value)
    assert -1e-9 <= position <= 1.0 + 1e-9
    assert from_unit(bind, position) == pytest.approx(value, abs=1e-6)


@given(tables(), st.floats(0.05, 2.0))
def test_any_value_has_a_place_also_in_a_table_that_turns_back(table, value):
    bind = Bind("cc 4", PRESSURE, (0.1, 1.9), table)
    assert 0.0 <= to_unit(bind, value) <= 1.0


@given(spans, curves, st.booleans(), st.floats(0.05, 2.0))
def test_python_finds_the_place_that_compiled_code_finds(span, curve, invert, value):
    bind = Bind("cc 4", PRESSURE, span, curve, invert)
    assert bind.to_unit(value) == pytest.approx(to_unit(bind, value), abs=1e-9)


@given(spans, curves, st.booleans(), units, units)
def test_a_source_that_goes_over_the_targets_place_meets_it(span, curve, invert, unit, other):
    bind = Bind("cc 4", PRESSURE, span, curve, invert)
    low, high = sorted((unit, other))
    middle = from_unit(bind, 0.5 * (low + high))
    assert picks_up(bind, high, low, middle)
    assert picks_up(bind, low, high, middle)


def test_an_osc_argument_is_spread_over_what_the_address_sends():
    for sent, argument, position in [
        ((0.0, 1.0), 0.25, 0.25),
        ((0.0, 127.0), 127, 1.0),
        ((0.0, 127.0), 200, 1.0),
        ((-1.0, 1.0), -3.0, 0.0),
        ((1.0, -1.0), 0.5, 0.25),
    ]:
        bind = Bind("/fader", "/playing/volume", input_range=sent)
        assert input_to_unit(bind, argument) == position


def test_channels_count_from_one_and_over_all_ports():
    bind = Bind("cc 4", PRESSURE, channels=(2, 16))
    assert [channel for channel in range(-16, 40) if receives(bind, channel)] == [1, 15, 17, 31, 33]
    assert receives(Bind("cc 4", PRESSURE), -1)
