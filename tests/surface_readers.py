"""Surfaces read back from their files: the controls of parameters, and where things lie."""

import json
from typing import Any, NamedTuple

import py2tosc
from boxes import Rect

from yehu_server.params.spec import Curve
from yehu_server.params.table import offered
from yehu_server.surfaces import common_layout
from yehu_server.surfaces.catalogue import SURFACES, bytes_of

SERVER = ("192.168.1.5", 9001)


class Control(NamedTuple):
    """What moves a parameter, by its address without the prefix."""

    address: str
    lo: float
    hi: float
    start: float
    sends: str
    texts: list[str]  # beside it


class Surface(NamedTuple):
    file: Any  # as its own library or format has it
    controls: list[Control]
    pages: list[tuple[list[Rect], float, float]]  # what lies there, width and height


def params():
    """The parameters of all groups, by address."""
    return {param.address: param for group in common_layout.groups() for param in group.params}


def text_of(name, part=0):
    (surface,) = (surface for surface in SURFACES if surface.name == name)
    return surface.content(bytes_of(surface, SERVER, part)).decode()


def start(control, key="x"):
    (value,) = (value.default for value in control.values if value.key == key)
    return value


def sent(message):
    """The address, the arguments as (kind, text, from, to), and the triggers."""
    assert message.send
    assert message.enabled
    address = "".join(part.value for part in message.path)
    arguments = [(str(a.type), a.value, a.scale_min, a.scale_max) for a in message.arguments]
    return address, arguments, [(each.var, str(each.condition)) for each in message.triggers]


def touchosc():
    document = py2tosc.loads(bytes_of(SURFACES[0], SERVER, 0))
    controls = []
    for fader in document.find_all(type="FADER"):
        param = offered(params()[fader.get("tag")])
        texts = [
            start(each, "text") for each in document.find(param.address).find_all(type="LABEL")
        ]
        (address, arguments, triggers), *others = map(sent, fader.messages)
        assert (arguments, triggers, others) == ([("VALUE", "x", 0.0, 1.0)], [("x", "ANY")], [])
        ends = [param.from_unit(unit) for unit in (0.0, 1.0, start(fader))]
        controls.append(Control(param.address, *ends, address.removesuffix("/unit"), texts))

    def walk(control, x=0.0, y=0.0):
        for child in control.children:
            at = child.frame
            yield from walk(child, x + at.x, y + at.y)
            if not child.children:
                yield Rect(child.get("name"), x + at.x, y + at.y, at.w, at.h)

    (pager,) = document.find_all(type="PAGER")
    pages = [(list(walk(page)), page.frame.w, page.frame.h) for page in pager.children]
    return Surface(document, controls, pages)


class Patch:
    """The boxes of a Max patch and their patch cords."""

    def __init__(self, text):
        patcher = json.loads(text)["patcher"]
        assert patcher["openinpresentation"] == 1
        self.boxes = {box["box"]["id"]: box["box"] for box in patcher["boxes"]}
        assert len(self.boxes) == len(patcher["boxes"])
        cords = (line["patchline"] for line in patcher["lines"])
        self.cords = [(cord["source"], cord["destination"]) for cord in cords]
        self.width = patcher["rect"][2]

    def all(self, maxclass):
        return [box for box in self.boxes.values() if box["maxclass"] == maxclass]

    def one(self, text):
        (box,) = (box for box in self.boxes.values() if box.get("text") == text)
        return box

    def after(self, box, outlet=0):
        """The boxes that an outlet is connected to, with their inlets."""
        at = [box["id"], outlet]
        return [
            (self.boxes[target], inlet) for source, (target, inlet) in self.cords if source == at
        ]

    def texts_after(self, box, outlet=0):
        return [target.get("text") for target, _ in self.after(box, outlet)]


def max_patch():
    patch = Patch(text_of("yehu.maxpat"))
    boxes = patch.boxes.values()
    begins = [box for box in boxes if box.get("text", "").startswith("loadmess set ")]
    starts = {patch.after(box)[0][0]["varname"]: float(box["text"].split()[2]) for box in begins}
    beneath = {tuple(box["presentation_rect"][:2]): box["text"] for box in patch.all("comment")}
    controls = []
    for dial in patch.all("live.dial"):
        value = dial["saved_attribute_attributes"]["valueof"]
        assert value["parameter_longname"] == dial["varname"]
        assert "parameter_initial_enable" not in value  # opening the patch moves nothing
        x, y, *_ = dial["presentation_rect"]
        texts = [value["parameter_shortname"], beneath[x, y + 50]]
        ends = value["parameter_mmin"], value["parameter_mmax"], starts[dial["varname"]]
        (sends,) = patch.texts_after(dial)
        controls.append(Control(dial["varname"], *ends, sends.removeprefix("prepend "), texts))
    pages = []
    for kind, width in (("presentation_rect", patch.width), ("patching_rect", 1e9)):
        rects = [Rect(box["id"], *box[kind]) for box in boxes if kind in box]
        pages.append((rects, width, 1e9))  # it may be scrolled down, but not aside
    return Surface(patch, controls, pages)


def pure_data():
    lines = text_of("yehu.pd").splitlines()
    rows = [line.removesuffix(";").split() for line in lines]
    (defaults,) = (line for line in lines if line.startswith("#X msg") and "\\; /yehu" in line)
    starts = dict(part.split(" set ") for part in defaults.removesuffix(";").split("\\; ")[1:])
    controls, rects = [], []
    for row in rows:
        if row[4:5] == ["hsl"]:
            ends, is_log, silent, sends, name = map(float, row[7:9]), *row[9:13]
            texts = [" ".join(one[4:]) for one in rows if one[1] == "text" and one[3] == row[3]]
            address = name.removeprefix("/yehu")
            assert silent == "0"  # as the patch opens
            assert (is_log == "1") == (params()[address].curve is Curve.EXP)
            sends = sends.removesuffix(".moved")
            controls.append(Control(address, *ends, float(starts[name]), sends, texts))
            size = row[5:7]
        elif row[1] == "floatatom":
            size = 7 * int(row[4]), 18
        elif row[4:5] == ["hradio"]:
            size = int(row[5]) * int(row[8]), row[5]
        elif row[4:5] == ["bng"]:
            size = 130, row[5]
        else:
            continue
        rects.append(Rect(" ".join(row), *map(int, (*row[2:4], *size))))
    return Surface(lines, controls, [(rects, *map(int, rows[0][4:6]))])


def open_stage_control():
    session = json.loads(text_of("open-stage-control.json"))
    assert (session["type"], session["content"]["type"]) == ("session", "root")
    found = [session["content"]]
    for widget in found:
        found += [*widget.get("tabs", ()), *widget.get("widgets", ())]
    widgets = {widget["id"]: widget for widget in found}
    assert len(widgets) == len(found)
    controls = []
    for fader in (widget for widget in found if widget["type"] == "fader"):
        ends = (
            fader["range"]["min"],
            fader["range"]["max"],
            round(fader["default"], fader["decimals"]),
        )
        controls.append(Control(fader["id"], *ends, fader["address"], fader["html"].split("<br/>")))
    names = ("left", "top", "width", "height")
    placed = [widget for widget in found if "left" in widget]
    rects = [
        Rect(each["id"], *(float(each[name].rstrip("%")) for name in names)) for each in placed
    ]
    return Surface(widgets, controls, [(rects, 100.0, 100.0)])


READERS = {
    "yehu.tosc": touchosc,
    "yehu.maxpat": max_patch,
    "yehu.pd": pure_data,
    "open-stage-control.json": open_stage_control,
}
