"""The Max patch: it opens in presentation mode; patching mode shows its cords.

Dials send and take real values at their addresses.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from py2max import Box, Patcher
from py2max.core.common import Rect

from yehu_server.live.addresses import Address
from yehu_server.params.spec import Param
from yehu_server.surfaces import layout
from yehu_server.surfaces.layout import Axis, Group, full

PORT = 7400  # at which the patch receives values from the server; that of part N at N more
# While a dial is moved it ignores the server, whose echo would move it back.
QUIET_MS = 250

COLUMNS = 10
CELL = (112, 98)  # in the panel
WIRED = (190, 214)  # behind it
MARGIN, LINE = 16, 22
PADS_HEIGHT, KEYS_HEIGHT = 190, 60
TOP = 2 * MARGIN + LINE + PADS_HEIGHT + KEYS_HEIGHT + 2 * MARGIN  # of the dials
WIRED_TOP = 700
STEPS = 1000  # of a pad, whose numbers are whole
FLOAT, CUSTOM = 0, 9  # a parameter's type; its unit's style

Place = tuple[float, float]


class Panel:
    """A patcher: each box has a place in patching mode, some also one in presentation mode."""

    def __init__(self) -> None:
        self.patcher = Patcher(
            title=layout.named("yehu"),
            openinpresentation=1,
            on_invalid="raise",
            validate_attrs=False,
        )
        self._boxes = 0

    def add(
        self, kind: str, at: Place, shown: tuple[float, ...] | None = None, **attributes: Any
    ) -> Box:
        """Add an object, a ``comment ...`` or a ``message ...``.

        `shown` is its place in presentation mode.
        """
        word, _, rest = kind.partition(" ")
        self._boxes += 1
        attributes["id"] = f"obj-{self._boxes}"
        size = attributes.pop("size", (max(60.0, 7.0 * len(kind)), LINE))
        rect = Rect(*at, *size)
        if shown is not None:
            attributes |= {"presentation": 1, "presentation_rect": list(shown)}
        if word == "comment":
            return self.patcher.add_comment(rest, patching_rect=rect, **attributes)
        if word == "message":
            return self.patcher.add_message(rest, patching_rect=rect, **attributes)
        return self.patcher.add_textbox(kind, patching_rect=rect, **attributes)

    def chain(self, *boxes: Box) -> None:
        """Draw cords from each to the next."""
        for source, target in pairwise(boxes):
            self.patcher.add_line(source, target)

    def connect(self, source: Box, target: Box, *, outlet: int = 0, inlet: int = 0) -> None:
        """Draw a cord."""
        self.patcher.add_line(source, target, inlet=inlet, outlet=outlet)


def make(server: Address) -> bytes:
    """Write the patch as JSON."""
    panel = Panel()
    _network(panel, server)
    _hands(panel)
    bottom = 0.0
    for group, row, column in _shelves(layout.groups()):
        shelf = (MARGIN + column * CELL[0], TOP + row * CELL[1])
        wired = (MARGIN + column * WIRED[0], WIRED_TOP + row * WIRED[1])
        width = CELL[0] * len(group.params[:2])
        panel.add(f"comment {group.name}", wired, (*shelf, width, LINE), fontface=1)
        for place, param in enumerate(group.params):
            down, across = divmod(place, COLUMNS)
            at = (wired[0] + across * WIRED[0], wired[1] + LINE + 8 + down * WIRED[1])
            shown = (shelf[0] + across * CELL[0], shelf[1] + LINE + down * CELL[1])
            _dial(panel, param, at, shown)
            bottom = shown[1] + CELL[1]
    panel.patcher.rect = Rect(
        60.0, 80.0, MARGIN * 2 + COLUMNS * CELL[0], min(bottom + MARGIN, 900.0)
    )
    return (json.dumps(panel.patcher.to_dict(), indent=1) + "\n").encode("utf-8")


def _local(kind: str, name: str) -> str:
    """An object that sends to, or receives at, a name that another part's patch does not have."""
    return f"{kind} {layout.named('yehu').replace(' ', '.')}.{name}"


def _shelves(groups: Sequence[Group]) -> Iterator[tuple[Group, int, int]]:
    """Return each group's row and column: beside the one before it where there is room."""
    row, column, rows = 0, 0, 0
    for group in groups:
        count = len(group.params)
        if column + count > COLUMNS:
            row, column, rows = row + rows, 0, 0
        yield group, row, column
        column += count
        rows = max(rows, -(-count // COLUMNS))


def _network(panel: Panel, server: Address) -> None:
    """Add what sends to the server, and what shows its values unless a dial is being moved."""
    host, port = server
    begin = panel.add("loadbang", (16, 16))
    metro = panel.add(f"metro {1000 * layout.SUBSCRIBE_EVERY_S}", (16, 76))
    on = panel.add("message 1", (16, 46))
    heard_at = layout.port_from(PORT)
    asking = ", ".join(f"{to} {layout.SUBSCRIBED_S} {heard_at}" for to in layout.subscriptions())
    subscribe = panel.add(f"message {asking}", (16, 106))
    out = panel.add(f"udpsend {host} {port}", (16, 176))
    panel.chain(begin, on, metro, subscribe, out)
    panel.chain(panel.add(_local("r", "out"), (250, 106)), out)
    moved = panel.add(_local("r", "moved"), (360, 16))
    order = panel.add("t b b", (360, 46))
    wait = panel.add(f"delay {QUIET_MS}", (360, 76))
    then = panel.add("t b b", (360, 106))
    close = panel.add("message 0", (500, 76))
    reopen = panel.add("message 1", (500, 106))
    gate = panel.add("gate 1 1", (500, 146))
    heard = panel.add(f"udpreceive {heard_at}", (620, 106))
    panel.chain(moved, out)
    panel.chain(moved, order, wait, then, subscribe)
    panel.connect(order, close, outlet=1)
    panel.connect(then, reopen, outlet=1)
    panel.chain(close, gate)
    panel.chain(reopen, gate)
    panel.connect(heard, gate, inlet=1)
    panel.chain(gate, panel.add(_local("s", "in"), (500, 176)))


def _hands(panel: Panel) -> None:
    """Add two pads, keys and buttons."""
    half = (COLUMNS * CELL[0] - MARGIN) / 2
    send = panel.add(_local("s", "out"), (16, 560))
    pitch = panel.add(f"prepend {full('/pitch')}", (16, 500))
    press = panel.add(f"prepend {full('/press')}", (200, 500))
    string = (layout.STRING_PITCH, layout.STRING_PRESS)
    for scaled, target in zip(_pad(panel, "string", string, 16, half), (pitch, press), strict=True):
        panel.chain(scaled, target, send)
    bow = (layout.BOW_SPEED, layout.BOW_FORCE)
    speed, force = _pad(panel, "bow", bow, 16 + half + MARGIN, half)
    both = panel.add("pak 0. 0.", (600, 470))
    panel.connect(speed, both)
    panel.connect(force, both, inlet=1)
    panel.chain(both, panel.add(f"prepend {full('/bow')}", (600, 500)), send)
    _keys(panel, send)
    for place, said in enumerate(("/bow 0 0", "/release", "/panic")):
        shown = (MARGIN + place * 130, MARGIN, 120, LINE)
        panel.chain(panel.add(f"message {full(said)}", (900 + place * 160, 500), shown), send)


def _pad(panel: Panel, name: str, axes: tuple[Axis, Axis], x: float, width: float) -> Iterator[Box]:
    """Add a pad; return its outlets, across and up."""
    top = 2 * MARGIN + LINE
    title = f"comment {name}: {axes[0].text} across, {axes[1].text} up"
    panel.add(title, (x, 230), (x, top, width, LINE))
    slider = panel.add(
        "pictslider",
        (x, 256),
        (x, top + LINE, width, PADS_HEIGHT - LINE),
        size=(160.0, 120.0),
        varname=name,
        leftvalue=0,
        rightvalue=STEPS,
        bottomvalue=0,
        topvalue=STEPS,
    )
    for outlet, axis in enumerate(axes):
        scale = f"scale 0. {STEPS}. {float(axis.lo)} {float(axis.hi)}"
        scaled = panel.add(scale, (x + outlet * 200, 400))
        panel.connect(slider, scaled, outlet=outlet)
        yield scaled


def _keys(panel: Panel, send: Box) -> None:
    """Add a keyboard in touch-screen mode: pressing a key begins its note, releasing it ends it."""
    first, last = layout.KEYS[0].note, layout.KEYS[-1].note
    keys = panel.add(
        "kslider",
        (240, 590),
        (MARGIN, 3 * MARGIN + LINE + PADS_HEIGHT, COLUMNS * CELL[0], KEYS_HEIGHT),
        size=(420.0, 60.0),
        varname="keys",
        mode=2,
        offset=first // 12 * 12,
        range=last // 12 * 12 + 12 - first // 12 * 12,
    )
    note = panel.add("pack 0 0", (240, 660))
    panel.connect(keys, note)
    panel.connect(keys, note, outlet=1, inlet=1)
    panel.chain(note, panel.add(f"prepend {full('/note')}", (340, 660)), send)


def _dial(panel: Panel, param: Param, at: Place, shown: Place) -> None:
    """Add a dial, what it sends, and what sets it without sending."""
    x, y = at
    address = full(param.address)
    unit = "" if param.unit == "1" else f" {param.unit}"
    value = {
        "parameter_longname": param.address,
        "parameter_shortname": layout.label(param),
        "parameter_mmin": param.lo,
        "parameter_mmax": param.hi,
        "parameter_type": FLOAT,
        "parameter_unitstyle": CUSTOM,
        "parameter_units": f"%.3f{unit}",
    }
    dial = panel.add(
        "live.dial",
        (x + 90, y),
        (*shown, CELL[0] - 8, 48),
        size=(90.0, 48.0),
        varname=param.address,
        parameter_enable=1,
        saved_attribute_attributes={"valueof": value},
    )
    range_place = (shown[0], shown[1] + 50, CELL[0] - 8, LINE)
    panel.add(f"comment {param.range_text}", (x + 90, y + 50), range_place, textjustification=1,
              fontsize=9.0, size=(90.0, 18.0))  # fmt: skip
    said = panel.add(f"prepend {address}", (x, y + 118), size=(170.0, LINE))
    panel.chain(dial, said, panel.add(_local("s", "moved"), (x, y + 144)))
    told = panel.add(_local("r", "in"), (x, y))
    route = panel.add(f"route {address}", (x, y + 70), size=(170.0, LINE))
    quietly = panel.add("prepend set", (x, y + 94))
    begin = panel.add(f"loadmess set {param.default:g}", (x, y + 26), size=(86.0, LINE))
    panel.chain(told, route, quietly, dial)
    panel.chain(begin, dial)
