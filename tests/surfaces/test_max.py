"""The Max patch, read back."""

import json

import pytest
from boxes import Rect, overlapping

from yehu_server.params.table import TABLE
from yehu_server.surfaces import layout
from yehu_server.surfaces import max as max_patch


class Patch:
    """The boxes of a patch and their patch cords."""

    def __init__(self, data):
        patcher = json.loads(data)["patcher"]
        assert patcher["openinpresentation"] == 1
        self.boxes = {box["box"]["id"]: box["box"] for box in patcher["boxes"]}
        assert len(self.boxes) == len(patcher["boxes"])
        self.cords = [
            (line["patchline"]["source"], line["patchline"]["destination"])
            for line in patcher["lines"]
        ]

        self.width = patcher["rect"][2]

    def all(self, maxclass):
        return [box for box in self.boxes.values() if box["maxclass"] == maxclass]

    def one(self, text):
        (box,) = (box for box in self.boxes.values() if box.get("text") == text)
        return box

    def after(self, box, outlet=0):
        """The boxes that an outlet is connected to, with their inlets."""
        return [
            (self.boxes[target], inlet)
            for (source, out), (target, inlet) in self.cords
            if source == box["id"] and out == outlet
        ]

    def texts_after(self, box, outlet=0):
        return [target.get("text") for target, _ in self.after(box, outlet)]


@pytest.fixture(scope="module")
def patch():
    return Patch(max_patch.make(("192.168.1.5", 9001)))


def test_every_parameter_has_one_dial_with_its_range(patch):
    dials = {dial["varname"]: dial for dial in patch.all("live.dial")}
    assert len(dials) == len(patch.all("live.dial"))
    assert sorted(dials) == sorted(param.address for param in TABLE)
    for param in TABLE:
        value = dials[param.address]["saved_attribute_attributes"]["valueof"]
        assert (value["parameter_mmin"], value["parameter_mmax"]) == (param.lo, param.hi)
        assert value["parameter_longname"] == param.address
        assert value["parameter_shortname"] == layout.label(param)
        # Opening the patch must not move the instrument.
        assert "parameter_initial_enable" not in value


@pytest.mark.parametrize("param", TABLE, ids=lambda param: param.address)
def test_a_dial_sends_at_its_address_and_is_set_without_sending(patch, param):
    (dial,) = (dial for dial in patch.all("live.dial") if dial["varname"] == param.address)
    ((said, _),) = patch.after(dial)
    assert said["text"] == f"prepend /yehu{param.address}"
    assert patch.texts_after(said) == ["s yehu.moved"]
    route = patch.one(f"route /yehu{param.address}")
    ((quietly, _),) = patch.after(route)
    assert quietly["text"] == "prepend set"
    assert [target for target, _ in patch.after(quietly)] == [dial]
    begins = [
        box["text"]
        for box in patch.boxes.values()
        if box.get("text", "").startswith("loadmess") and patch.after(box)[0][0] is dial
    ]
    (word, quiet, number) = begins[0].split()
    assert (len(begins), word, quiet) == (1, "loadmess", "set")
    assert float(number) == pytest.approx(param.default)


def test_it_speaks_to_the_server_and_names_the_port_it_hears_at(patch):
    assert patch.one("udpsend 192.168.1.5 9001")
    assert patch.one("udpreceive 7400")
    subscribe = patch.one("/yehu/subscribe 60 7400")
    assert patch.texts_after(subscribe) == ["udpsend 192.168.1.5 9001"]
    metro = patch.one(f"metro {1000 * layout.SUBSCRIBE_EVERY_S}")
    assert patch.texts_after(metro) == [subscribe["text"]]


def test_the_keyboard_sends_notes_and_their_ends(patch):
    (keys,) = patch.all("kslider")
    assert keys["mode"] == 2  # a touch screen's: the release is sent too
    assert keys["offset"] <= layout.KEYS[0].note
    assert keys["offset"] + keys["range"] > layout.KEYS[-1].note
    ((note, first),) = patch.after(keys)
    ((same, second),) = patch.after(keys, 1)
    assert (note, first, second) == (same, 0, 1)
    assert patch.texts_after(note) == ["prepend /yehu/note"]


def test_the_bow_pad_sends_speed_and_force(patch):
    (pad,) = (pad for pad in patch.all("pictslider") if pad["varname"] == "bow")
    ends = []
    for outlet, axis in enumerate((layout.BOW_SPEED, layout.BOW_FORCE)):
        ((scale, _),) = patch.after(pad, outlet)
        assert list(map(float, scale["text"].split()[1:])) == [0, 1000, axis.lo, axis.hi]
        ends.append(patch.after(scale)[0])
    assert [inlet for _, inlet in ends] == [0, 1]
    assert ends[0][0] is ends[1][0]
    assert patch.texts_after(ends[0][0]) == ["prepend /yehu/bow"]


@pytest.mark.parametrize("text", ["/yehu/panic", "/yehu/release", "/yehu/bow 0 0"])
def test_a_message_to_click_is_in_front_and_is_sent(patch, text):
    box = patch.one(text)
    assert box["presentation"] == 1
    assert patch.texts_after(box) == ["s yehu.out"]


@pytest.mark.parametrize("kind", ["presentation_rect", "patching_rect"])
def test_boxes_do_not_overlap_in_front_or_behind(any_table, kind):
    patch = Patch(max_patch.make(("127.0.0.1", 9000)))
    assert len(patch.all("live.dial")) == len(any_table)
    rects = [
        Rect(box.get("text", box["maxclass"]), *box[kind])
        for box in patch.boxes.values()
        if kind in box
    ]
    assert overlapping(rects) == []
    if kind == "presentation_rect":  # it may be scrolled down, but not aside
        assert all(rect.x >= 0 and rect.x + rect.w <= patch.width for rect in rects)


def test_it_is_the_same_each_time():
    server = ("127.0.0.1", 9000)
    assert max_patch.make(server) == max_patch.make(server)
