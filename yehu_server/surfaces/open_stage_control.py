"""The Open Stage Control session: pads, keys and faders in a browser, of real values."""

import json
from typing import Any

from yehu_server.live.network import Address
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import offered
from yehu_server.surfaces import common_layout
from yehu_server.surfaces.common_layout import Frame, Pad, osc_address

FORMAT = "1.30.1"  # the version of Open Stage Control whose sessions these are
COLUMNS = 8
DECIMALS = 5
HANDS, BUTTONS = Frame(0, 0, 100, 90), Frame(0, 90, 100, 10)  # per cent of a tab

Widget = dict[str, Any]


def make(server: Address) -> bytes:
    """Write the session as JSON."""
    speaks = {"target": [f"{server[0]}:{server[1]}"]}
    for_s = common_layout.SUBSCRIBED_S
    send = "; ".join(f"send('{to}', {for_s})" for to in common_layout.subscriptions())
    again = f"setInterval(() => {{ {send} }}, {1000 * common_layout.SUBSCRIBE_EVERY_S})"
    tabs: dict[str, tuple[list[Widget], Widget]] = {"hands": (_hands(), {})}
    for group in common_layout.groups():
        grid = {"layout": "grid", "gridTemplate": COLUMNS}
        tabs[group.name] = ([_fader(param) for param in group.params], grid)
    root = {
        "type": "root",
        "id": "root",
        "onCreate": f"{send}\n{again}",
        **speaks,
        "tabs": [
            {"type": "tab", "id": name, "label": name, **style}
            | {"widgets": [widget | speaks for widget in widgets]}
            for name, (widgets, style) in tabs.items()
        ],
    }
    about = {"createdWith": "Open Stage Control", "version": FORMAT, "type": "session"}
    return (json.dumps({**about, "content": root}, indent=1) + "\n").encode("utf-8")


def _placed(frame: Frame, page: Frame) -> Widget:
    place = frame.on(page, 1)
    names = ("left", "top", "width", "height")
    return {name: f"{share:g}%" for name, share in zip(names, place, strict=True)}


def _hands() -> list[Widget]:
    """Return two pads, keys and buttons."""
    pads = [_pad(pad) | _placed(pad.frame, HANDS) for pad in common_layout.PADS]
    keys = {
        "type": "keyboard",
        "id": "keys",
        **_placed(common_layout.KEYS_FRAME, HANDS),
        "address": osc_address("/note"),
        "start": common_layout.KEYS[0],
        "keys": len(common_layout.KEYS),
        "on": common_layout.VELOCITY,
        "off": 0,
    }
    width = 1 / len(common_layout.BUTTONS)
    buttons = [
        {"type": "button", "id": name, "label": name, "mode": "momentary"}
        | _placed(Frame(place * width, 0, width, 1), BUTTONS)
        | {"address": osc_address(f"/{name}")}
        for place, name in enumerate(common_layout.BUTTONS)
    ]
    return [*pads, keys, *buttons]


def _pad(pad: Pad) -> Widget:
    x, y = pad.axes
    (call, _), *others = pad.calls
    if others:
        sending = [f"send('{osc_address(to)}', value[{of[0]}])" for to, of in pad.calls]
        sends = {"bypass": True, "onValue": "\n".join(sending)}
    else:
        sends = {"address": osc_address(call)}
    if pad.lifted:
        sends["onTouch"] = f"if (event.type === 'stop') send('{osc_address(pad.lifted)}', 0, 0)"
    return {
        "type": "xy",
        "id": f"{pad.name} pad",  # two widgets of one id would move each other
        "html": pad.title,
        "snap": True,
        "rangeX": {"min": x.lo, "max": x.hi},
        "rangeY": {"min": y.lo, "max": y.hi},
        "default": [x.start, y.start],
        "decimals": DECIMALS,
        **sends,
    }


def _fader(param: Param) -> Widget:
    param = offered(param)
    return {
        "type": "fader",
        "id": param.address,
        "html": f"{common_layout.label(param)}<br/>{param.range_text}",
        "address": osc_address(param.address),
        "range": {"min": param.lo, "max": param.hi},
        "logScale": param.curve is Curve.EXP,
        "default": param.default,
        "doubleTap": True,
        "decimals": DECIMALS,
        "pips": True,
    }
