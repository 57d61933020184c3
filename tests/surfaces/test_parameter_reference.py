"""The page about the parameters."""

import re
from html.parser import HTMLParser

import pytest

from yehu_server.live.osc.all_calls import CALLS
from yehu_server.params.table import TABLE
from yehu_server.surfaces import parameter_reference

VOID = ("meta", "input", "br")


class Reader(HTMLParser):
    """Collects rows of cells; checks that every element is closed."""

    def __init__(self):
        super().__init__()
        self.open, self.rows = [], []

    def handle_starttag(self, tag, _attributes):
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag == "td":
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "td" in self.open:
            self.rows[-1][-1] += data


@pytest.fixture(scope="module")
def text():
    return parameter_reference.make(("127.0.0.1", 9000)).decode()


@pytest.fixture(scope="module")
def rows(text):
    reader = Reader()
    reader.feed(text)
    assert reader.open == []
    rows = [row for row in reader.rows if row]
    assert len({row[0] for row in rows}) == len(rows)
    return {row[0]: row for row in rows}


def test_every_parameter_has_a_row_with_all_that_the_table_says(rows):
    for param in TABLE:
        _, symbol, within, unit, default, curve, doc = rows[f"/yehu{param.address}"]
        lo, hi = map(float, within.split(" to "))
        assert (lo, hi) == (param.lo, param.hi)
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
