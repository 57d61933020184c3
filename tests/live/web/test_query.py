"""The OSCQuery tree as data, and the table of status values."""

import json
import math
import subprocess
import sys

import pytest
from web_client import walk

from yehu_server.live.osc.all_calls import CALLS
from yehu_server.live.osc.osc_addresses import readable
from yehu_server.live.osc.status import INT_MAX, STATUS, Kind, as_argument
from yehu_server.live.web.query import ATTRIBUTES, find, node_at
from yehu_server.params.table import TABLE, offered

NOTHING = {Kind.TEXT: "", Kind.GAUGE: 0.0, Kind.COUNTER: 0}
VALUES = {param.address: param.default for param in TABLE}
STANDING = {row.name: NOTHING[row.kind] for row in STATUS}


def tree(status=STANDING, more_calls=()):
    return node_at("/", lambda _: VALUES, lambda _: status, more_calls=more_calls)


@pytest.fixture(scope="module")
def root():
    return tree()


def test_each_node_is_where_it_says_and_has_what_belongs_to_its_arguments(root):
    assert find(root, "/") is root
    for path, node in walk(root):
        assert find(root, path) is node
        assert set(node) <= set(ATTRIBUTES)
        assert ("VALUE" in node) == bool(node["ACCESS"] & 1), path
        assert ("TYPE" in node) == bool(node["ACCESS"]), path
        for name in ("VALUE", "RANGE", "UNIT", "CLIPMODE"):
            assert name not in node or len(node[name]) == len(node["TYPE"]), path
    with_value = {path for path, node in walk(root) if "VALUE" in node}
    assert with_value == {
        "/yehu" + address for address in readable(1) if not address.startswith("/part/")
    }
    assert find(root, "/yehu/bow/") is find(root, "/yehu/bow")
    assert find(root, "/yehu//bow") is find(root, "/yehu/bow/speed/none") is None


def test_every_parameter_is_described_as_the_table_has_it(subtests, root):
    for param in TABLE:
        with subtests.test(param.address):
            path = "/yehu" + param.address
            node = find(root, path)
            assert node["FULL_PATH"] == path
            assert (node["TYPE"], node["ACCESS"]) == ("f", 3)
            assert node["RANGE"] == [{"MIN": param.lo, "MAX": offered(param).hi}]
            assert node["CLIPMODE"] == ["both"]
            assert node["DESCRIPTION"].startswith(param.doc)
            assert ("UNIT" in node) == (param.unit != "1")
            unit = node["CONTENTS"]["unit"]
            assert unit["FULL_PATH"] == path + "/unit"
            assert unit["RANGE"] == [{"MIN": 0.0, "MAX": 1.0}]
            assert (unit["TYPE"], unit["ACCESS"]) == ("f", 3)


def test_every_call_can_be_called_with_arguments_of_their_own_ranges(root):
    for call in CALLS:
        node = find(root, "/yehu" + call.address)
        assert node["ACCESS"] == 2
        assert node["TYPE"] == "".join(one.kind for one in call.arguments) or node["TYPE"] == "N"
        assert node["DESCRIPTION"] == call.doc
    assert find(root, "/yehu/note")["RANGE"] == [{"MIN": 0.0, "MAX": 127.0}] * 2
    assert find(root, "/yehu/note")["UNIT"] == ["time.midinote", "1"]
    assert "RANGE" not in find(root, "/yehu/record/start")


def test_a_number_that_json_cannot_say_is_null_and_long_counts_are_floats():
    states = {"load": math.nan, "frame": INT_MAX + 1, "underruns": 3}
    root = tree(STANDING | states)
    assert find(root, "/yehu/status/load")["VALUE"] == [None]
    assert find(root, "/yehu/status/frame")["TYPE"] == "f"
    assert find(root, "/yehu/status/underruns")["TYPE"] == "i"
    json.dumps(root, allow_nan=False)
    assert as_argument(INT_MAX) == INT_MAX
    assert isinstance(as_argument(INT_MAX + 1), float)


@pytest.mark.parametrize("module", ["yehu_server.cli", "yehu_server.rendering.to_files"])
def test_only_a_server_loads_what_the_web_needs(module):
    code = f"import sys, {module}; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert module in run.stdout.split()
    assert not {"aiohttp", "zeroconf", "prometheus_client"} & set(run.stdout.split())


def test_of_a_part_what_it_has_may_be_listened_to_and_nothing_of_the_servers():
    known = readable(2)
    plain = {address for address in known if not address.startswith("/part/")}
    of_part = {address[7:] for address in known if address.startswith("/part/2/")}
    assert of_part - plain == {"/status/keys"}
    assert {"/status/load", "/room/size"} <= plain - of_part
    assert {"/status/note", "/playing/volume"} <= of_part
    assert not any(address.startswith("/part/3/") for address in known)
