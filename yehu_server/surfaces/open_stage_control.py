"""The Open Stage Control session: the same pads, keys and faders, in a browser.

Faders send and take real values at their addresses.
"""

from __future__ import annotations

import json
from typing import Any

from yehu_server.live.addresses import Address
from yehu_server.params.spec import Curve, Param
from yehu_server.surfaces import layout
from yehu_server.surfaces.layout import Axis, Group, full

FORMAT = "1.30.1"  # the version of Open Stage Control whose sessions these are
COLUMNS = 8
DECIMALS = 5
SENDING = {"address", "onCreate", "onTouch", "onValue"}  # what makes a widget send

Widget = dict[str, Any]


def make(server: Address) -> bytes:
    """Write the session as JSON."""
    host, port = server
    root = {
        "type": "root",
        "id": "root",
        "onCreate": _subscribing(),
        "tabs": [_hands(), *(_tab(group) for group in layout.groups())],
    }
    for widget in _walk(root):
        if SENDING & widget.keys():
            widget["target"] = [f"{host}:{port}"]
    session = {
        "createdWith": "Open Stage Control",
        "version": FORMAT,
        "type": "session",
        "content": root,
    }
    return (json.dumps(session, indent=1) + "\n").encode("utf-8")


def _walk(widget: Widget) -> list[Widget]:
    inside = [*widget.get("tabs", ()), *widget.get("widgets", ())]
    return [widget, *(found for child in inside for found in _walk(child))]


def _subscribing() -> str:
    send = "; ".join(f"send('{to}', {layout.SUBSCRIBED_S})" for to in layout.subscriptions())
    return f"{send}\nsetInterval(() => {{ {send} }}, {1000 * layout.SUBSCRIBE_EVERY_S})"


def _hands() -> Widget:
    """Add two pads and keys."""
    pitch, press, bow, note = map(full, ("/pitch", "/press", "/bow", "/note"))
    string = _pad("string", layout.STRING_PITCH, layout.STRING_PRESS, "1%") | {
        "bypass": True,
        "onValue": f"send('{pitch}', value[0])\nsend('{press}', value[1])",
    }
    hair = _pad("bow", layout.BOW_SPEED, layout.BOW_FORCE, "51%") | {
        "address": bow,
        "onTouch": f"if (event.type === 'stop') send('{bow}', 0, 0)",
    }
    keys = {
        "type": "keyboard",
        "id": "keys",
        "left": "1%",
        "top": "62%",
        "width": "98%",
        "height": "27%",
        "address": note,
        "start": layout.KEYS[0].note,
        "keys": len(layout.KEYS),
        "on": layout.VELOCITY,
        "off": 0,
    }
    buttons = [
        {
            "type": "button",
            "id": name,
            "label": name,
            "mode": "momentary",
            "left": left,
            "top": "91%",
            "width": "48%",
            "height": "8%",
            "address": full(f"/{name}"),
        }
        for name, left in (("release", "1%"), ("panic", "51%"))
    ]
    return {
        "type": "tab",
        "id": "hands",
        "label": "hands",
        "widgets": [string, hair, keys, *buttons],
    }


def _pad(name: str, x: Axis, y: Axis, left: str) -> Widget:
    return {
        "type": "xy",
        "id": f"{name} pad",  # two widgets of one id would move each other
        "html": f"{name}: {x.text} across, {y.text} up",
        "left": left,
        "top": "1%",
        "width": "48%",
        "height": "60%",
        "snap": True,
        "rangeX": {"min": x.lo, "max": x.hi},
        "rangeY": {"min": y.lo, "max": y.hi},
        "default": [x.start, y.start],
        "decimals": DECIMALS,
    }


def _tab(group: Group) -> Widget:
    return {
        "type": "tab",
        "id": group.name,
        "label": group.name,
        "layout": "grid",
        "gridTemplate": COLUMNS,
        "widgets": [_fader(param) for param in group.params],
    }


def _fader(param: Param) -> Widget:
    return {
        "type": "fader",
        "id": param.address,
        "html": f"{layout.label(param)}<br/>{param.range_text}",
        "address": full(param.address),
        "range": {"min": param.lo, "max": param.hi},
        "logScale": param.curve is Curve.EXP,
        "default": param.default,
        "doubleTap": True,
        "decimals": DECIMALS,
        "pips": True,
    }
