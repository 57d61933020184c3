"""The Pure Data patch, for Pd vanilla 0.51 or newer, with its network in a subpatch.

Each slider receives at its OSC address and sends at the same with `MOVED` after it.
"""

from collections.abc import Sequence
from itertools import accumulate

from yehu_server.live.network import Address
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import offered
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.surfaces import common_layout
from yehu_server.surfaces.common_layout import Group, local_name, osc_address
from yehu_server.surfaces.patch_cords import QUIET_MS, Network

MOVED = ".moved"
KEY, END, LIFT, RELEASE, PANIC = "key", "end", "lift", "release", "panic"
BUTTONS = {END: "end_the_note", LIFT: "lift_the_bow", RELEASE: "release", PANIC: "panic"}

COLUMNS = 2
ROW, COLUMN = 22, 560
NAME, SLIDER, NUMBER = 140, 160, 64  # widths
TOP = 120  # of the sliders
COLOURS = "-262144 -1 -1"  # white background, black foreground, in the form that every Pd reads

# The new note begins, the one before it ends, the new one is kept. A slider's name is its
# parameter's address: as a symbol, the whole packet ends at its first zero, as an address does.
WIRES = r"""
send[list prepend send] -> [list trim] -> net[netsend -u -b]
[loadbang] -> order[t b b b] -> [metro {every_ms}] -> subscribe[{for_s}(
order:1 -> [connect {host} {port}( -> net
[r ~key] -> [+ {lowest}] -> change[change -1] -> turn[t f b f]
turn:2 -> [\$1 {velocity}( -> [@/note] -> send
turn:1 -> last[f] -> [@/note/off] -> send
turn -> 1:last
[r ~end] -> then[t b b b] -> [0( -> 1:last
then:1 -> [set -1( -> change
then:2 -> last
[r ~lift] -> [0 0( -> [@/bow] -> send
[r ~release] -> [@/release] -> send
[r ~panic] -> [@/panic] -> send
net:1 -> gate[spigot 1] -> both[t l l] -> [oscparse] -> words[t l l] -> split[list split]
words:1 -> [list length] -> [- 1] -> 1:split
split:1 -> [set \$1( -> target[send]
both:1 -> [list tosymbol] -> 1:target
packet[t b a] -> moved[t b b] -> [delay {quiet_ms}] -> rested[t b b] -> subscribe
packet:1 -> send
moved:1 -> [0( -> 1:gate
rested:1 -> [1( -> 1:gate
"""
WIRED_SLIDER = r"""
slider[r {address}{moved}] -> [@{param}] -> packet
slider -> [set \$1( -> [s {address}]
"""


class Canvas(Network[int]):
    """A patch or subpatch, as lines of Pd's own format."""

    def __init__(self, width: int, height: int, end: str) -> None:
        super().__init__(top=20)
        self.lines = [f"#N canvas 40 40 {width} {height} {end};"]
        self._cords: list[str] = []
        self._count = 0

    def add(self, kind: str, x: float, y: float, text: str) -> int:
        """Add an element; return its number, for cords."""
        self.lines.append(f"#X {kind} {x:.0f} {y:.0f} {text};")
        self._count += 1
        return self._count - 1

    def box(self, text: str, x: float, y: float, *, is_message: bool) -> int:
        """As `Network` says."""
        return self.add("msg" if is_message else "obj", x, y, text)

    def cord(self, source: int, outlet: int, target: int, inlet: int) -> None:
        """As `Network` says."""
        self._cords.append(f"#X connect {source} {outlet} {target} {inlet};")

    def prefixing(self, address: str) -> str:
        """As `Network` says."""
        return "oscformat " + address.strip("/").replace("/", " ")

    def text(self, x: int, y: int, text: str) -> None:
        """Add a comment."""
        self.add("text", x, y, text.replace(",", " \\,").replace(";", " \\;"))

    def written(self) -> list[str]:
        """All lines: elements, then cords."""
        return [*self.lines, *self._cords]


def make(server: Address) -> bytes:
    """Write the patch."""
    columns = _columns(common_layout.groups())
    height = TOP + ROW * max(sum(len(group.params) + 2 for group in column) for column in columns)
    patch = Canvas(COLUMNS * COLUMN + 40, height + 20, "12")
    _play(patch)
    for place, column in enumerate(columns):
        x, y = 20 + place * COLUMN, TOP
        for group in column:
            patch.text(x, y, f"--- {group.name} ---")
            for offset, param in enumerate(group.params, 1):
                _slider(patch, param, x, y + offset * ROW)
            y += (len(group.params) + 2) * ROW
    patch.lines += _wires(server).written()
    patch.add("restore", 20 + COLUMNS * COLUMN - 100, 10, "pd wires")
    return ("\n".join(patch.written()) + "\n").encode("ascii")


def _columns(groups: Sequence[Group]) -> list[list[Group]]:
    """Divide groups, in order, into columns of about equal length."""
    ends = list(accumulate(len(group.params) + 2 for group in groups))
    columns: list[list[Group]] = [[] for _ in range(COLUMNS)]
    for group, end in zip(groups, ends, strict=True):
        middle = end - (len(group.params) + 2) / 2
        columns[min(int(COLUMNS * middle / ends[-1]), COLUMNS - 1)].append(group)
    return columns


def _play(patch: Canvas) -> None:
    """Add keys and buttons."""
    keys = common_layout.KEYS
    patch.text(20, 10, f"keys {note_name(keys[0])} to {note_name(keys[-1])}")
    strip = f"hradio 22 1 0 {len(keys)} {local_name(KEY)} empty empty 0 -8 0 10 {COLOURS} 0"
    patch.add("obj", 20, 34, strip)
    for place, (name, label) in enumerate(BUTTONS.items()):
        button = f"bng 22 250 50 0 {local_name(name)} empty {label} 28 11 0 12 {COLOURS}"
        patch.add("obj", 20 + 140 * place, 72, button)


def _slider(patch: Canvas, param: Param, x: int, y: int) -> None:
    """Add name, slider, number and range of one parameter."""
    param = offered(param)
    address = osc_address(param.address)
    sent, ends = address + MOVED, f"{param.lo:g} {param.hi:g}"
    slider = f"hsl {SLIDER} 16 {ends} {int(param.curve is Curve.EXP)} 0 {sent} {address} empty"
    number = x + NAME + SLIDER + 14
    patch.text(x, y, common_layout.label(param))
    patch.add("obj", x + NAME, y, f"{slider} -2 -8 0 10 {COLOURS} 0 1")
    patch.add("floatatom", number, y, f"7 {ends} 0 - {address} {sent}")
    patch.text(number + NUMBER, y, param.range_text)


def _wires(server: Address) -> Canvas:
    """The subpatch that sends to the server and receives from it."""
    wires = Canvas(1000, 700, "wires 0")
    host, port = server
    wires.draw(
        WIRES.format(
            host=host,
            port=port,
            every_ms=1000 * common_layout.SUBSCRIBE_EVERY_S,
            for_s=common_layout.SUBSCRIBED_S,
            quiet_ms=QUIET_MS,
            lowest=common_layout.KEYS[0],
            velocity=common_layout.VELOCITY,
        )
    )
    for address in common_layout.subscriptions():
        wires.draw(f"subscribe -> [{wires.prefixing(address)}] -> send")
    params = [param for group in common_layout.groups() for param in group.params]
    for param in params:
        address = osc_address(param.address)
        wires.draw(WIRED_SLIDER.format(address=address, moved=MOVED, param=param.address))
    defaults = " ".join(
        f"\\; {osc_address(param.address)} set {param.default:g}" for param in params
    )
    wires.draw(f"order:2 -> [{defaults}(")
    return wires
