"""The Pure Data patch as text; tests/control/test_pd_patch.py opens it in Pd."""

import pytest
from boxes import Rect, overlapping

from yehu_server.params.spec import Curve
from yehu_server.params.table import TABLE
from yehu_server.surfaces import layout, puredata


def lines_of_it():
    return puredata.make(("127.0.0.1", 9000)).decode().splitlines()


def sliders_of(lines):
    """The words of each slider, by its receive name."""
    words = (line.removesuffix(";").split() for line in lines if line.startswith("#X obj"))
    found = {word[12]: word for word in words if word[4] == "hsl"}
    assert len(found) == sum(" hsl " in line for line in lines)
    return found


@pytest.fixture(scope="module")
def lines():
    return lines_of_it()


@pytest.fixture(scope="module")
def sliders(lines):
    return sliders_of(lines)


def test_every_parameter_has_one_slider_of_its_range(sliders):
    assert sorted(sliders) == sorted(f"/yehu{param.address}" for param in TABLE)
    for param in TABLE:
        words = sliders[f"/yehu{param.address}"]
        assert (float(words[7]), float(words[8])) == (param.lo, param.hi)
        assert (words[9] == "1") == (param.curve is Curve.EXP)
        assert words[10] == "0"  # silent as the patch opens
        assert words[11] == f"/yehu{param.address}.moved"


def test_each_has_its_name_and_range_beside_it(lines, sliders):
    texts = {
        tuple(line.split()[2:4]): line.removesuffix(";").split(maxsplit=4)[4]
        for line in lines
        if line.startswith("#X text")
    }
    for param in TABLE:
        x, y = map(int, sliders[f"/yehu{param.address}"][2:4])
        assert texts[str(x - puredata.NAME), str(y)] == layout.label(param)
        beside = [text for (at, row), text in texts.items() if row == str(y) and int(at) > x]
        assert param.range_text in beside


def test_the_patch_begins_at_the_defaults(lines):
    (message,) = (line for line in lines if line.startswith("#X msg") and "\\; /yehu" in line)
    body = message.removesuffix(", f 60;").split(maxsplit=4)[4]
    begins = dict(part.split(" set ") for part in body.split("\\; ") if part)
    assert {name: float(value) for name, value in begins.items()} == {
        f"/yehu{param.address}": pytest.approx(param.default) for param in TABLE
    }


def test_sliders_numbers_and_keys_do_not_overlap(any_table):
    lines = lines_of_it()
    rects = [
        Rect(name, int(words[2]), int(words[3]), int(words[5]), int(words[6]))
        for name, words in sliders_of(lines).items()
    ]
    for line in lines:
        words = line.removesuffix(";").split()
        if words[:2] == ["#X", "floatatom"]:
            rects.append(Rect(words[9], int(words[2]), int(words[3]), 7 * int(words[4]), 18))
        elif words[:2] == ["#X", "obj"] and words[4] == "hradio":
            size = int(words[5])
            rects.append(Rect("keys", int(words[2]), int(words[3]), size * int(words[8]), size))
        elif words[:2] == ["#X", "obj"] and words[4] == "bng":
            rects.append(Rect(words[9], int(words[2]), int(words[3]), 130, int(words[5])))
    width, height = map(int, lines[0].split()[4:6])
    assert len(rects) == 2 * len(any_table) + 5
    assert overlapping(rects) == []
    assert all(rect.is_within(width, height) for rect in rects)


def test_it_is_the_same_each_time():
    server = ("127.0.0.1", 9000)
    assert puredata.make(server) == puredata.make(server)
