"""The TouchOSC layout, read back."""

import re

import py2tosc
import pytest
from boxes import Rect, overlapping

from yehu_server.params.table import BY_ADDRESS, TABLE
from yehu_server.surfaces import layout, touchosc

SERVER = ("127.0.0.1", 9000)


@pytest.fixture(scope="module")
def document():
    return py2tosc.loads(touchosc.make(SERVER))


def sent(message):
    """The address, the arguments as (kind, text, from, to), and the trigger."""
    assert message.send
    assert message.enabled
    address = "".join(part.value for part in message.path)
    arguments = [
        (str(part.type), part.value, part.scale_min, part.scale_max) for part in message.arguments
    ]
    triggers = [(trigger.var, str(trigger.condition)) for trigger in message.triggers]
    return address, arguments, triggers


def start(control, key="x"):
    (value,) = (value.default for value in control.values if value.key == key)
    return value


def test_every_parameter_has_one_fader_that_sends_and_takes_its_unit(document):
    faders = document.find_all(type="FADER")
    assert sorted(fader.get("tag") for fader in faders) == sorted(BY_ADDRESS)
    for fader in faders:
        param = BY_ADDRESS[fader.get("tag")]
        (message,) = fader.messages
        address, arguments, triggers = sent(message)
        assert address == f"/yehu{param.address}/unit"
        assert arguments == [("VALUE", "x", 0.0, 1.0)]
        assert triggers == [("x", "ANY")]
        assert message.receive
        assert not message.feedback  # what comes in does not go out again
        assert param.from_unit(start(fader)) == pytest.approx(param.default, abs=1e-9)


def test_a_fader_tells_its_value_as_the_parameter_has_it(document):
    for fader in document.find_all(type="FADER"):
        param = BY_ADDRESS[fader.get("tag")]
        script = fader.get("script")
        lo, hi = re.search(r"local lo, hi = (\S+), (\S+)", script).groups()
        formula = re.search(r"'%.5g', (.*)\)\n", script).group(1).replace("^", "**")
        names = {"lo": float(lo), "hi": float(hi)}
        for unit in (0.0, 0.2, 0.5, 0.9, 1.0):
            shown = eval(formula, {}, names | {"x": unit})  # noqa: S307
            assert shown == pytest.approx(param.from_unit(unit))


def test_each_fader_has_its_name_value_and_range_beside_it(document):
    for param in TABLE:
        strip = document.find(param.address)
        texts = {child.get("name"): child for child in strip.children}
        assert start(texts["name"], "text") == layout.label(param)
        assert start(texts["range"], "text") == param.range_text
        assert float(start(texts["value"], "text")) == pytest.approx(param.default, rel=1e-3)


def test_the_string_pad_slides_and_presses(document):
    (pad,) = document.find_all("string", type="XY")
    pitch, press = layout.STRING_PITCH, layout.STRING_PRESS
    assert [sent(message) for message in pad.messages] == [
        ("/yehu/pitch", [("VALUE", "x", pitch.lo, pitch.hi)], [("x", "ANY")]),
        ("/yehu/press", [("VALUE", "y", press.lo, press.hi)], [("y", "ANY")]),
    ]


def test_the_bow_pad_draws_and_lifts_at_its_release(document):
    (pad,) = document.find_all("bow", type="XY")
    speed, force = layout.BOW_SPEED, layout.BOW_FORCE
    draw, lift = (sent(message) for message in pad.messages)
    assert draw == (
        "/yehu/bow",
        [("VALUE", "x", speed.lo, speed.hi), ("VALUE", "y", force.lo, force.hi)],
        [("x", "ANY"), ("y", "ANY"), ("touch", "RISE")],
    )
    assert lift[0] == "/yehu/bow"
    assert [argument[:2] for argument in lift[1]] == [("CONSTANT", "0"), ("CONSTANT", "0")]
    assert lift[2] == [("touch", "FALL")]
    assert (start(pad), start(pad, "y")) == (0.5, 0.0)  # at rest


def test_a_key_sends_its_velocity_and_then_0(document):
    for key in layout.KEYS:
        (button,) = document.find_all(key.name, type="BUTTON")
        (message,) = button.messages
        address, (note, velocity), triggers = sent(message)
        assert address == "/yehu/note"
        assert note[:2] == ("CONSTANT", str(key.note))
        assert velocity == ("VALUE", "x", 0.0, 90.0)
        assert triggers == [("x", "ANY")]


@pytest.mark.parametrize("name", ["release", "panic"])
def test_a_button_says_its_call_once_when_pressed(document, name):
    (button,) = document.find_all(name, type="BUTTON")
    assert [sent(message) for message in button.messages] == [
        (f"/yehu/{name}", [], [("x", "RISE")])
    ]


def test_the_layout_subscribes_by_itself(document):
    script = document.root.get("script")
    assert "sendOSC('/yehu/subscribe/unit')" in script
    assert f"> {1000 * layout.SUBSCRIBE_EVERY_S} then" in script


def controls(page):
    """All visible controls on a page except groups, in the page's frame."""

    def walk(control, x, y):
        for child in control.children:
            frame = child.frame
            if child.children:
                yield from walk(child, x + frame.x, y + frame.y)
            else:
                name = f"{control.get('name')} {child.get('name')}"
                yield Rect(name, x + frame.x, y + frame.y, frame.w, frame.h)

    return list(walk(page, 0.0, 0.0))


def test_no_two_controls_of_a_page_overlap_and_all_lie_within_it(any_table):
    document = py2tosc.loads(touchosc.make(SERVER))
    assert len(document.find_all(type="FADER")) == len(any_table)
    (pager,) = document.find_all(type="PAGER")
    for page in pager.children:
        rects = controls(page)
        assert rects
        assert overlapping(rects) == []
        assert all(rect.is_within(page.frame.w, page.frame.h) for rect in rects)
        assert all(rect.w > 20 and rect.h > 10 for rect in rects)
        assert page.frame.y == pager.get("tabbarSize")
        assert page.frame.y + page.frame.h == pager.frame.h
    assert pager.frame.y + pager.frame.h == document.root.frame.h
    bar = [child for child in document.root.children if child is not pager]
    assert all(child.frame.y + child.frame.h <= pager.frame.y for child in bar)


def test_py2tosc_finds_nothing_wrong(document):
    assert [str(issue) for issue in document.validate()] == []


def test_every_control_has_an_id_of_its_own_the_same_each_time(document):
    ids = [control.id for control in document.walk()]
    assert len(set(ids)) == len(ids)
    again = py2tosc.loads(touchosc.make(SERVER))
    assert [control.id for control in again.walk()] == ids
