"""What every program's surface has alike: a control for each parameter, in its place."""

from functools import cache

import pytest
from boxes import overlapping
from surface_readers import READERS

from yehu_server.params.table import BY_ADDRESS, offered
from yehu_server.surfaces import common_layout

pytestmark = pytest.mark.parametrize("name", READERS)


@cache
def controls_of(name):
    return READERS[name]().controls


def test_every_parameter_has_one_control_of_its_range_that_begins_at_its_default(name):
    controls = controls_of(name)
    assert sorted(control.address for control in controls) == sorted(BY_ADDRESS)
    for control in controls:
        param = offered(BY_ADDRESS[control.address])
        assert (control.lo, control.hi) == (param.lo, param.hi)
        assert control.start == pytest.approx(param.default)


def test_a_control_sends_at_its_address_and_has_its_name_and_range_beside_it(name):
    for control in controls_of(name):
        param = BY_ADDRESS[control.address]
        assert control.sends == f"/yehu{param.address}"
        assert common_layout.label(param) in control.texts
        assert offered(BY_ADDRESS[control.address]).range_text in control.texts


def test_nothing_overlaps_and_all_lies_within_its_page(name, any_table):
    read = READERS[name]()
    assert len(read.controls) == len(any_table)
    for rects, width, height in read.pages:
        assert rects
        assert overlapping(rects) == []
        assert all(rect.is_within(width, height) for rect in rects)
        assert all(rect.w > 5 and rect.h > 5 for rect in rects)
