"""The TouchOSC layout: pads and keys to play on, and a fader for every parameter.

All faders send and take 0 to 1 at ADDRESS/unit, so that each follows its parameter's curve; the
layout subscribes to these by itself. Frames are in points of a 1024 by 768 screen, which
TouchOSC fits to any other.
"""

from __future__ import annotations

import uuid
import zlib
from collections.abc import Iterator, Sequence
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

from yehu_server.live.addresses import Address
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import UNIT
from yehu_server.surfaces import layout
from yehu_server.surfaces.layout import Axis, Group, Key, full

WIDTH, HEIGHT = 1024, 768
BAR, TABS, GAP = 52, 44, 8
COLUMNS, ROWS = 8, 2  # of faders on a page
LINE = 20  # a label's height
PAGE = (WIDTH, HEIGHT - BAR - TABS)
KEYS_HEIGHT = 190

WOOD, DARK, STRING, HAIR, IVORY, EBONY, ALARM = (
    "#b5763a", "#2b2622", "#d8c69a", "#8fb8c4", "#e8e0cf", "#3a3530", "#b03a2e",
)  # fmt: skip

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
    """Return the text of a .tosc file, which is the same with every version of zlib.

    Raises
    ------
    zlib.error
        Where it is damaged.
    """
    stream = zlib.decompressobj()
    text = stream.decompress(data)
    if not stream.eof or stream.unused_data:
        raise zlib.error("not one whole stream")
    return text


def document() -> py2tosc.Document:
    """Return the whole layout."""
    pages = [_hands(), *(page for group in layout.groups() for page in _pages(group))]
    pager = py2tosc.pager(
        name="pages", frame=(0, BAR, WIDTH, HEIGHT - BAR), tabbar_size=TABS, children=pages
    )
    every_ms = 1000 * layout.SUBSCRIBE_EVERY_S
    sending = "\n    ".join(f"sendOSC('{to}')" for to in layout.subscriptions(UNIT))
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


# -- parts of all pages ---------------------------------------------------------------------------


def _bar() -> Iterator[Control]:
    frame = (GAP, GAP, 500, BAR - 2 * GAP)
    yield _label("title", frame, layout.named("yehu"), text_size=22, text_align_h=1)
    for place, (call, colour) in enumerate((("/release", WOOD), ("/panic", ALARM))):
        name = call.strip("/")
        x = WIDTH - (2 - place) * (150 + GAP)
        press = _message(call, [], [Trigger("x", TriggerCondition.RISE)])
        yield py2tosc.button(
            name=name, frame=(x, GAP, 150, BAR - 2 * GAP), color=colour, messages=[press]
        )
        yield _label(f"{name} label", (x, GAP, 150, BAR - 2 * GAP), name, text_size=16)


# -- the page of pads and keys----------------------------------------------------------------------


def _hands() -> Control:
    """Add two pads and keys."""
    width, height = PAGE
    pad_height = height - KEYS_HEIGHT - 2 * LINE - 4 * GAP
    half = (width - 3 * GAP) / 2
    anywhere = [Trigger("x"), Trigger("y")]
    pitch = _message("/pitch", [_scaled("x", layout.STRING_PITCH)], anywhere[:1])
    press = _message("/press", [_scaled("y", layout.STRING_PRESS)], anywhere[1:])
    touched = Trigger("touch", TriggerCondition.RISE)
    draw = _message(
        "/bow",
        [_scaled("x", layout.BOW_SPEED), _scaled("y", layout.BOW_FORCE)],
        [*anywhere, touched],
    )
    lift = _message(
        "/bow", [_constant(0.0), _constant(0.0)], [Trigger("touch", TriggerCondition.FALL)]
    )
    children: list[Control] = []
    for place, (name, colour, axes, messages) in enumerate(
        (
            ("string", STRING, (layout.STRING_PITCH, layout.STRING_PRESS), [pitch, press]),
            ("bow", HAIR, (layout.BOW_SPEED, layout.BOW_FORCE), [draw, lift]),
        )
    ):
        x = GAP + place * (half + GAP)
        values = [Value("x", default=axes[0].at), Value("y", default=axes[1].at), Value("touch")]
        text = f"{name}: {axes[0].text} across, {axes[1].text} up"
        children += [
            _label(f"{name} label", (x, GAP, half, LINE), text),
            py2tosc.xy(
                name=name,
                frame=(x, GAP + LINE, half, pad_height),
                color=colour,
                values=values,
                messages=messages,
            ),
        ]
    top = height - KEYS_HEIGHT - LINE - GAP
    step = (width - 2 * GAP) / len(layout.KEYS)
    for place, key in enumerate(layout.KEYS):
        children += _key(key, GAP + place * step, top, step - 2)
    return _page("hands", children)


def _key(key: Key, x: float, top: float, width: float) -> Iterator[Control]:
    """Add a key, which sends its velocity when pressed and 0 when released."""
    velocity = Partial(PartialType.VALUE, Conversion.FLOAT, "x", 0.0, layout.VELOCITY)
    yield py2tosc.button(
        name=key.name,
        frame=(x, top, width, KEYS_HEIGHT),
        color=EBONY if key.is_black else IVORY,
        messages=[_message("/note", [_constant(key.note), velocity], [Trigger("x")])],
    )
    frame = (x, top + KEYS_HEIGHT, width, LINE)
    yield _label(f"{key.name} label", frame, key.name, text_size=11)


# -- faders --------------------------------------------------------------------------------------


def _pages(group: Group) -> Iterator[Control]:
    size = COLUMNS * ROWS
    for start in range(0, len(group.params), size):
        number = f" {start // size + 1}" if len(group.params) > size else ""
        yield _page(group.name + number, _strips(group.params[start : start + size]))


def _strips(params: Sequence[Param]) -> list[Control]:
    """Add faders in rows, from the top left."""
    rows = 1 if len(params) <= COLUMNS else ROWS
    width, height = PAGE[0] / COLUMNS, PAGE[1] / rows
    return [
        _strip(param, (place % COLUMNS * width, place // COLUMNS * height, width, height))
        for place, param in enumerate(params)
    ]


def _strip(param: Param, frame: tuple[float, float, float, float]) -> Control:
    """Add name, fader, value and range of one parameter."""
    *_, width, height = frame
    inner = width - 2 * GAP
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
        outline=False,
        background=False,
        children=[
            _label("name", (0, GAP, width, LINE), layout.label(param)),
            fader,
            _label("value", (0, height - 2 * LINE - GAP, width, LINE), f"{param.default:.5g}"),
            _label("range", (0, height - LINE - GAP, width, LINE), param.range_text, text_size=10),
        ],
    )


# -- parts ---------------------------------------------------------------------------------------


def _page(name: str, children: list[Control]) -> Control:
    return py2tosc.group(
        name=name,
        frame=(0, TABS, *PAGE),
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
    return py2tosc.label(
        name=name, frame=frame, values=values, background=False, outline=False, **style
    )


def _message(
    address: str, arguments: list[Partial], triggers: list[Trigger], *, receive: bool = False
) -> OscMessage:
    return OscMessage(
        receive=receive, triggers=triggers, path=ui.path(full(address)), arguments=arguments
    )


def _scaled(key: str, axis: Axis | None = None) -> Partial:
    lo, hi = (0.0, 1.0) if axis is None else (axis.lo, axis.hi)
    return Partial(PartialType.VALUE, Conversion.FLOAT, key, lo, hi)


def _constant(number: float) -> Partial:
    return Partial(PartialType.CONSTANT, Conversion.FLOAT, f"{number:g}")
