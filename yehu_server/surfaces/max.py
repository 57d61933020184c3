"""The Max patch; its dials send and take real values at their addresses."""

import json
from collections.abc import Iterator, Sequence
from typing import Any

from py2max import Box, Patcher
from py2max.core.common import Rect

from yehu_server.live.network import Address
from yehu_server.params.spec import Param
from yehu_server.params.table import offered
from yehu_server.surfaces import common_layout
from yehu_server.surfaces.common_layout import Frame, Group, osc_address
from yehu_server.surfaces.patch_cords import QUIET_MS, Network, width_of

PORT = 7400  # at which the patch receives values from the server; that of part N at N more

COLUMNS = 10
CELL = (112, 98)
MARGIN, LINE = 16, 22
HANDS = Frame(MARGIN, 2 * MARGIN + LINE, COLUMNS * CELL[0], 260)
TOP = HANDS.y + HANDS.height + MARGIN  # of the dials
STEPS = 1000  # of a pad, whose numbers are whole
FLOAT, CUSTOM = 0, 9  # the type of a parameter; the style of its unit

# Sends to the server, and shows its values unless a dial is being moved.
NETWORK = """
out[udpsend {host} {port}]
[loadbang] -> [1( -> [metro {every_ms}] -> subscribe[{calls}( -> out
[r ~out] -> out
moved[r ~moved] -> out
moved -> order[t b b] -> [delay {quiet_ms}] -> then[t b b] -> subscribe
order:1 -> [0( -> gate[gate 1 1] -> [s ~in]
then:1 -> [1( -> gate
[udpreceive {listen_at}] -> 1:gate
send[s ~out]
"""
DIAL = """
[r ~in] -> [route {address}] -> [prepend set] -> dial
[loadmess set {default:g}] -> dial -> [@{param}] -> [s ~moved]
"""


class Panel(Network[Box]):
    """A patcher, with controls at their places on the panel, and the network beneath them."""

    def __init__(self, bottom: float) -> None:
        super().__init__(top=bottom)
        self.patcher = Patcher(
            title=common_layout.with_part("yehu"),
            openinpresentation=1,
            on_invalid="raise",
            validate_attrs=False,
        )
        self.patcher.rect = Rect(60.0, 80.0, MARGIN + HANDS.width + MARGIN, min(bottom, 900.0))
        self._count = 0

    def _add(self, kind: str, text: str, frame: Frame, **attributes: Any) -> Box:
        self._count += 1
        attributes |= {"id": f"obj-{self._count}", "patching_rect": Rect(*frame)}
        add = getattr(self.patcher, f"add_{kind}")
        box: Box = add(text, **attributes)
        return box

    def show(self, kind: str, text: str, frame: Frame, **attributes: Any) -> Box:
        """Add a ``comment``, ``message`` or, as a ``textbox``, a control to the panel."""
        shown = {"presentation": 1, "presentation_rect": list(frame)}
        return self._add(kind, text, frame, **shown, **attributes)

    def box(self, text: str, x: float, y: float, *, is_message: bool) -> Box:
        """As `Network` says."""
        frame = Frame(x, y, width_of(text), LINE)
        return self._add("message" if is_message else "textbox", text, frame)

    def cord(self, source: Box, outlet: int, target: Box, inlet: int) -> None:
        """As `Network` says."""
        self.patcher.add_line(source, target, inlet=inlet, outlet=outlet)

    def prefixing(self, address: str) -> str:
        """As `Network` says."""
        return f"prepend {address}"


def make(server: Address) -> bytes:
    """Write the patch as JSON."""
    shelves = list(_shelves(common_layout.groups()))
    rows = max(row + -(-len(group.params) // COLUMNS) for group, row, _ in shelves)
    panel = Panel(TOP + rows * CELL[1] + MARGIN)
    host, port = server
    listen_at = common_layout.port_from(PORT)
    arguments = f"{common_layout.SUBSCRIBED_S} {listen_at}"
    calls = ", ".join(f"{to} {arguments}" for to in common_layout.subscriptions())
    panel.draw(
        NETWORK.format(
            host=host,
            port=port,
            calls=calls,
            listen_at=listen_at,
            every_ms=1000 * common_layout.SUBSCRIBE_EVERY_S,
            quiet_ms=QUIET_MS,
        )
    )
    _hands(panel)
    for group, row, column in shelves:
        x, y = MARGIN + column * CELL[0], TOP + row * CELL[1]
        width = CELL[0] * len(group.params[:2])
        panel.show("comment", group.name, Frame(x, y, width, LINE), fontface=1)
        for place, param in enumerate(group.params):
            down, across = divmod(place, COLUMNS)
            _dial(panel, param, x + across * CELL[0], y + LINE + down * CELL[1])
    return (json.dumps(panel.patcher.to_dict(), indent=1) + "\n").encode("utf-8")


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


def _hands(panel: Panel) -> None:
    """Add two pads, keys and messages to click."""
    for pad in common_layout.PADS:
        frame = pad.frame.on(HANDS, MARGIN / 4)
        panel.show("comment", pad.title, frame._replace(height=LINE))
        slider = panel.show(
            "textbox",
            "pictslider",
            Frame(frame.x, frame.y + LINE, frame.width, frame.height - LINE),
            varname=pad.name,
            leftvalue=0,
            rightvalue=STEPS,
            bottomvalue=0,
            topvalue=STEPS,
        )
        for call, numbers in pad.calls:
            both = "pak 0. 0." if len(numbers) == 2 else "t f"
            panel.draw(f"both[{both}] -> [@{call}] -> send")
            for inlet, number in enumerate(numbers):
                axis = pad.axes[number]
                scale = f"scale 0. {STEPS}. {float(axis.lo)} {float(axis.hi)}"
                panel.draw(f"pad:{number} -> [{scale}] -> {inlet}:both", pad=slider)
    first, last = common_layout.KEYS[0], common_layout.KEYS[-1]
    keys = panel.show(
        "textbox",
        "kslider",
        common_layout.KEYS_FRAME.on(HANDS, MARGIN / 4),
        varname="keys",
        mode=2,  # a touch screen's: releasing a key ends its note
        offset=first // 12 * 12,
        range=last // 12 * 12 + 12 - first // 12 * 12,
    )
    panel.draw("keys -> note[pack 0 0] -> [@/note] -> send\nkeys:1 -> 1:note", keys=keys)
    for place, call in enumerate(("/bow 0 0", *(f"/{name}" for name in common_layout.BUTTONS))):
        frame = Frame(MARGIN + place * 130, MARGIN, 120, LINE)
        panel.draw("message -> send", message=panel.show("message", osc_address(call), frame))


def _dial(panel: Panel, param: Param, x: float, y: float) -> None:
    """Add a dial, with the boxes that send its value and set it without sending."""
    param = offered(param)
    unit = "" if param.unit == "1" else f" {param.unit}"
    value = {
        "parameter_longname": param.address,
        "parameter_shortname": common_layout.label(param),
        "parameter_mmin": param.lo,
        "parameter_mmax": param.hi,
        "parameter_type": FLOAT,
        "parameter_unitstyle": CUSTOM,
        "parameter_units": f"%.3f{unit}",
    }
    dial = panel.show(
        "textbox",
        "live.dial",
        Frame(x, y, CELL[0] - 8, 48),
        varname=param.address,
        parameter_enable=1,
        saved_attribute_attributes={"valueof": value},
    )
    beneath = Frame(x, y + 50, CELL[0] - 8, LINE)
    panel.show("comment", param.range_text, beneath, textjustification=1, fontsize=9.0)
    address = osc_address(param.address)
    panel.draw(DIAL.format(address=address, param=param.address, default=param.default), dial=dial)
