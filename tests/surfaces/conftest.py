"""Two parameter tables: ours, and one with more rows."""

from dataclasses import replace

import pytest

from yehu_server.params.spec import Curve
from yehu_server.params.table import TABLE, find
from yehu_server.surfaces import common_layout

_ROW = find("/playing/vibrato_rate")
LARGER = (
    *TABLE,
    replace(_ROW, address="/limiter/ceiling"),
    *(replace(_ROW, address=f"/strings/{n}/tension", curve=Curve.S) for n in range(19)),
    replace(_ROW, address="/noise/level"),
    replace(_ROW, address="/room/a_word_that_is_long"),
)


@pytest.fixture(params=[TABLE, LARGER], ids=["the table", "a larger table"])
def any_table(request, monkeypatch):
    """Make surfaces from either table."""
    groups = common_layout.groups(request.param)
    monkeypatch.setattr(common_layout, "groups", lambda: groups)
    return request.param
