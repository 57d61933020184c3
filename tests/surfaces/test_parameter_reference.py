"""The page about the parameters."""

import html
import re
from collections import Counter

import pytest

from yehu_server.live.osc.all_calls import CALLS
from yehu_server.params.table import TABLE, offered
from yehu_server.surfaces import parameter_reference


@pytest.fixture(scope="module")
def text():
    return parameter_reference.make(("127.0.0.1", 9000)).decode()


@pytest.fixture(scope="module")
def rows(text):
    """The cells of each row, by the first of them."""
    found = [re.findall("<td[^>]*>(.*?)</td>", row, re.DOTALL) for row in text.split("<tr")[1:]]
    rows = [[html.unescape(re.sub("<[^>]*>", "", cell)) for cell in row] for row in found if row]
    assert len({row[0] for row in rows}) == len(rows)
    return {row[0]: row for row in rows}


def test_every_element_is_closed(text):
    begun = Counter(re.findall(r"<([a-z]\w*)", text))
    ended = Counter(re.findall(r"</(\w+)", text))
    assert begun.keys() - ended.keys() <= {"meta", "input", "br"}
    assert {name: begun[name] for name in ended} == ended


def test_every_parameter_has_a_row_with_all_that_the_table_says(rows):
    for param in TABLE:
        _, symbol, within, unit, default, curve, doc = rows[f"/yehu{param.address}"]
        lo, hi = map(float, within.split(" to "))
        assert (lo, hi) == (param.lo, offered(param).hi)
        assert (symbol, doc) == (param.symbol, param.doc)
        assert unit == ("" if param.unit == "1" else param.unit)
        assert float(default) == pytest.approx(param.default)
        assert curve == param.curve.value


def test_every_call_has_a_row(rows):
    for call in CALLS:
        _, arguments, doc = rows[f"/yehu{call.address}"]
        assert doc == call.doc
        assert all(argument.name in arguments for argument in call.arguments)
    assert len(rows) == len(TABLE) + len(CALLS)


def test_the_page_needs_nothing_from_elsewhere(text):
    assert not re.search(r"https?:|//[a-z]|src=|href=|@import|url\(", text)
    assert "prefers-color-scheme: dark" in text
    assert "width=device-width" in text
