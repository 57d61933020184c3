"""The TouchOSC layout: pads and keys to play on, and a fader for every parameter.

All faders send and take 0 to 1 at ADDRESS/unit, so that each follows its parameter's curve; the
layout subscribes to these by itself. Frames are in points of a 1024 by 768 screen, which
TouchOSC fits to any other.
"""

import uuid
import zlib
from collections.abc import Iterator
from typing import Any

import py2tosc
from py2tosc import (
    Control,
    Conversion,
    OscMessage,
    Partial,
    PartialType,
    Trigger,
    TriggerCondition,
    Value,
    ui,
)

from yehu_server.live.network import Address
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import UNIT, offered
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.surfaces import common_layout
from yehu_server.surfaces.common_layout import Axis, Frame, Group, Pad, osc_address

WIDTH, HEIGHT = 1024, 768
BAR, TABS, GAP = 52, 44, 8
COLUMNS, ROWS = 8, 2  # of faders on a page
LINE = 20  # a label's height
PAGE = Frame(0, TABS, WIDTH, HEIGHT - BAR - TABS)
ON_PAGE = PAGE._replace(y=0)  # of what is on a page, in its own frame

WOOD, DARK, IVORY, EBONY = "#b5763a", "#2b2622", "#e8e0cf", "#3a3530"
COLOURS = {"string": "#d8c69a", "bow": "#8fb8c4", "release": WOOD, "panic": "#b03a2e"}
PLAIN: dict[str, Any] = {"outline": False, "background": False}

SUBSCRIBE = """\
local subscribed = nil
function update()
  local now = getMillis()
  if subscribed == nil or now - subscribed > {every_ms} then
    subscribed = now
    {sending}
  end
end
"""
# The number under a fader, in the parameter's own unit.
SHOW = """\
local lo, hi = {lo!r}, {hi!r}
local function show()
  local x = self.values.x
  self.parent.children.value.values.text = string.format('%.5g', {formula})
end
function init()
  show()
end
function onValueChanged(key)
  if key == 'x' then
    show()
  end
end
"""
FORMULAS = {
    Curve.LIN: "lo + (hi - lo) * x",
    Curve.EXP: "lo * (hi / lo) ^ x",
    Curve.S: "lo + (hi - lo) * x * x * (3 - 2 * x)",
}


def make(server: Address) -> bytes:
    """Return the layout as a .tosc file; the server's address is set in TouchOSC."""
    del server
    return zlib.compress(document().dumps().encode("utf-8"), 9)


def content(data: bytes) -> bytes:
    """Return the text of a .tosc file, whatever zlib packed it; raises zlib.error if damaged."""
    stream = zlib.decompressobj()
    text = stream.decompress(data)
    if not stream.eof or stream.unused_data:
        raise zlib.error("not one whole stream")
    return text


def document() -> py2tosc.Document:
    """Return the whole layout."""
    pages = [_hands(), *(page for group in common_layout.groups() for page in _pages(group))]
    pager = py2tosc.pager(
        name="pages", frame=(0, BAR, WIDTH, HEIGHT - BAR), tabbar_size=TABS, children=pages
    )
    every_ms = 1000 * common_layout.SUBSCRIBE_EVERY_S
    sending = "\n    ".join(f"sendOSC('{to}')" for to in common_layout.subscriptions(UNIT))
    script = SUBSCRIBE.format(every_ms=every_ms, sending=sending)
    root = py2tosc.group(
        name="yehu",
        frame=(0, 0, WIDTH, HEIGHT),
        script=script,
        color=DARK,
        children=[*_bar(), pager],
    )
    _identify(root, "yehu")
    return py2tosc.Document(root=root)


def _identify(control: Control, path: str) -> None:
    """Number the controls' ids, so that they are the same each time."""
    control.id = str(uuid.uuid5(uuid.NAMESPACE_URL, path))
    for child in control.children:
        _identify(child, f"{path}/{child.get('name')}")


# -- pads, keys and buttons ------------------------------------------------------------------------


def _bar() -> Iterator[Control]:
    """Return the title and the buttons, which are above all pages."""
    frame = (GAP, GAP, 500, BAR - 2 * GAP)
    yield _label("title", frame, common_layout.with_part("yehu"), text_size=22, text_align_h=1)
    for place, name in enumerate(common_layout.BUTTONS):
        x = WIDTH - (len(common_layout.BUTTONS) - place) * (150 + GAP)
        frame = (x, GAP, 150, BAR - 2 * GAP)
        press = _message(f"/{name}", [], [Trigger("x", TriggerCondition.RISE)])
        yield py2tosc.button(name=name, frame=frame, color=COLOURS[name], messages=[press])
        yield _label(f"{name} label", frame, name, text_size=16)


def _hands() -> Control:
    """Return the page of two pads and keys."""
    children = [control for pad in common_layout.PADS for control in _pad(pad)]
    keys = common_layout.KEYS_FRAME.on(ON_PAGE, GAP)
    step, height = keys.width / len(common_layout.KEYS), keys.height - LINE
    velocity = Partial(PartialType.VALUE, Conversion.FLOAT, "x", 0.0, common_layout.VELOCITY)
    for place, note in enumerate(common_layout.KEYS):  # each sends 0 when it is released
        x, name = keys.x + place * step, note_name(note)
        press = _message("/note", [_constant(note), velocity], [Trigger("x")])
        children.append(
            py2tosc.button(
                name=name,
                frame=(x, keys.y, step - 2, height),
                color=EBONY if "#" in name else IVORY,
                messages=[press],
            )
        )
        beneath = (x, keys.y + height, step - 2, LINE)
        children.append(_label(f"{name} label", beneath, name, text_size=11))
    return _page("hands", children)


def _pad(pad: Pad) -> Iterator[Control]:
    ways = (TriggerCondition.RISE, TriggerCondition.FALL)
    touched, left = (Trigger("touch", way) for way in ways)
    messages = []
    for call, numbers in pad.calls:
        arguments = [_scaled("xy"[number], pad.axes[number]) for number in numbers]
        moved = [Trigger("xy"[number]) for number in numbers]
        messages.append(_message(call, arguments, [*moved, touched] if pad.lifted else moved))
    if pad.lifted:
        messages.append(_message(pad.lifted, [_constant(0.0)] * 2, [left]))
    starts = [
        Value(key, default=(axis.start - axis.lo) / (axis.hi - axis.lo))
        for key, axis in zip("xy", pad.axes, strict=True)
    ]
    x, y, width, height = pad.frame.on(ON_PAGE, GAP)
    yield _label(f"{pad.name} label", (x, y, width, LINE), pad.title)
    yield py2tosc.xy(
        name=pad.name,
        frame=(x, y + LINE, width, height - LINE),
        color=COLOURS[pad.name],
        values=[*starts, Value("touch")],
        messages=messages,
    )


# -- faders --------------------------------------------------------------------------------------


def _pages(group: Group) -> Iterator[Control]:
    """Return the pages of a group's faders, which are in rows from the top left."""
    size = COLUMNS * ROWS
    for start in range(0, len(group.params), size):
        params = group.params[start : start + size]
        number = f" {start // size + 1}" if len(group.params) > size else ""
        rows = 1 if len(params) <= COLUMNS else ROWS
        yield _page(
            group.name + number,
            [
                _strip(
                    param,
                    Frame(
                        place % COLUMNS / COLUMNS, place // COLUMNS / rows, 1 / COLUMNS, 1 / rows
                    ).on(ON_PAGE),
                )
                for place, param in enumerate(params)
            ],
        )


def _strip(param: Param, frame: Frame) -> Control:
    """Return name, fader, value and range of one parameter."""
    *_, width, height = frame
    inner, param = width - 2 * GAP, offered(param)
    script = SHOW.format(lo=param.lo, hi=param.hi, formula=FORMULAS[param.curve])
    fader = py2tosc.fader(
        name="fader",
        tag=param.address,
        frame=(GAP, GAP + LINE, inner, height - 3 * LINE - 2 * GAP),
        color=WOOD,
        script=script,
        values=[Value("x", default=param.to_unit(param.default)), Value("touch")],
        messages=[_message(param.address + UNIT, [_scaled("x")], [Trigger("x")], receive=True)],
    )
    if param.lo == -param.hi:
        fader.set("centered", True)
    return py2tosc.group(
        name=param.address,
        frame=frame,
        **PLAIN,
        children=[
            _label("name", (0, GAP, width, LINE), common_layout.label(param)),
            fader,
            _label("value", (0, height - 2 * LINE - GAP, width, LINE), f"{param.default:.5g}"),
            _label("range", (0, height - LINE - GAP, width, LINE), param.range_text, text_size=10),
        ],
    )


# -- parts ---------------------------------------------------------------------------------------


def _page(name: str, children: list[Control]) -> Control:
    return py2tosc.group(
        name=name,
        frame=PAGE,
        outline=False,
        color=DARK,
        tab_label=name,
        tab_color_off="#453a30",
        tab_color_on=WOOD,
        text_color_off="#ffffff",
        text_color_on="#ffffff",
        children=children,
    )


def _label(name: str, frame: tuple[float, ...], text: str, **style: Any) -> Control:
    values = [Value("text", default=text), Value("touch")]
    style = {"text_size": 12, **style}
    return py2tosc.label(name=name, frame=frame, values=values, **PLAIN, **style)


def _message(
    address: str, arguments: list[Partial], triggers: list[Trigger], *, receive: bool = False
) -> OscMessage:
    return OscMessage(
        receive=receive, triggers=triggers, path=ui.path(osc_address(address)), arguments=arguments
    )


def _scaled(key: str, axis: Axis | None = None) -> Partial:
    lo, hi = (0.0, 1.0) if axis is None else (axis.lo, axis.hi)
    return Partial(PartialType.VALUE, Conversion.FLOAT, key, lo, hi)


def _constant(number: float) -> Partial:
    return Partial(PartialType.CONSTANT, Conversion.FLOAT, f"{number:g}")
