"""The Pure Data patch, for Pd vanilla 0.51 or newer.

Its network objects are in a subpatch. Each slider receives at its OSC address and sends at the
same with `MOVED` after it; what the server tells comes back through the socket it was asked by.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise

from yehu_server.live.addresses import Address
from yehu_server.params.spec import Curve, Param
from yehu_server.surfaces import layout
from yehu_server.surfaces.layout import Group, full

MOVED = ".moved"
KEY, END, LIFT, RELEASE, PANIC = (
    f"yehu.{name}" for name in ("key", "end", "lift", "release", "panic")
)
# While a slider is moved it ignores the server, whose echo would move it back.
QUIET_MS = 250

COLUMNS = 2
ROW, COLUMN = 22, 560
NAME, SLIDER, NUMBER = 140, 160, 64  # widths
TOP = 120  # of the sliders
COLOURS = "-262144 -1 -1"  # white background, black foreground, in the form that every Pd reads


class Canvas:
    """A patch or subpatch, as lines of Pd's own format."""

    def __init__(self, width: int, height: int, name: str | None = None) -> None:
        end = "12;" if name is None else f"{name} 0;"
        self.lines = [f"#N canvas 40 40 {width} {height} {end}"]
        self._cords: list[str] = []
        self._count = 0

    def add(self, line: str) -> int:
        """Add an element; return its number, for cords."""
        self.lines.append(line)
        self._count += 1
        return self._count - 1

    def object(self, x: int, y: int, text: str) -> int:
        """Add an object."""
        return self.add(f"#X obj {x} {y} {text};")

    def message(self, x: int, y: int, text: str, width: int = 0) -> int:
        """Add a message box, `width` characters wide."""
        return self.add(f"#X msg {x} {y} {text}{f', f {width}' if width else ''};")

    def text(self, x: int, y: int, text: str) -> int:
        """Add a comment."""
        escaped = text.replace(",", " \\,").replace(";", " \\;")
        return self.add(f"#X text {x} {y} {escaped};")

    def connect(self, source: int, target: int, *, outlet: int = 0, inlet: int = 0) -> None:
        """Draw a cord."""
        self._cords.append(f"#X connect {source} {outlet} {target} {inlet};")

    def chain(self, *elements: int) -> None:
        """Draw cords from each to the next."""
        for source, target in pairwise(elements):
            self.connect(source, target)

    def place(self, part: Canvas, x: int, y: int, name: str) -> int:
        """Add a subpatch."""
        return self.add("\n".join((*part.written(), f"#X restore {x} {y} pd {name};")))

    def written(self) -> list[str]:
        """All lines: elements, then cords."""
        return [*self.lines, *self._cords]


def make(server: Address) -> bytes:
    """Write the patch."""
    columns = _columns(layout.groups())
    height = TOP + ROW * max(sum(len(group.params) + 2 for group in column) for column in columns)
    patch = Canvas(COLUMNS * COLUMN + 40, height + 20)
    _play(patch)
    for place, column in enumerate(columns):
        row = 0
        for group in column:
            x = 20 + place * COLUMN
            patch.text(x, TOP + row * ROW, f"--- {group.name} ---")
            for offset, param in enumerate(group.params, 1):
                _slider(patch, param, x, TOP + (row + offset) * ROW)
            row += len(group.params) + 2
    patch.place(_wires(server), 20 + COLUMNS * COLUMN - 100, 10, "wires")
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
    keys = layout.KEYS
    patch.text(20, 10, f"keys {keys[0].name} to {keys[-1].name}")
    patch.object(
        20, 34, f"hradio 22 1 0 {len(keys)} {_local(KEY)} empty empty 0 -8 0 10 {COLOURS} 0"
    )  # fmt: skip
    for place, (name, label) in enumerate(
        ((END, "end_the_note"), (LIFT, "lift_the_bow"), (RELEASE, "release"), (PANIC, "panic"))
    ):
        patch.object(
            20 + 140 * place,
            72,
            f"bng 22 250 50 0 {_local(name)} empty {label} 28 11 0 12 {COLOURS}",
        )


def _slider(patch: Canvas, param: Param, x: int, y: int) -> None:
    """Add name, slider, number and range of one parameter."""
    address = full(param.address)
    sent = address + MOVED
    is_log = int(param.curve is Curve.EXP)
    patch.text(x, y, layout.label(param))
    patch.object(
        x + NAME,
        y,
        f"hsl {SLIDER} 16 {param.lo:g} {param.hi:g} {is_log} 0 {sent} {address} empty "
        f"-2 -8 0 10 {COLOURS} 0 1",
    )
    ends = f"{param.lo:g} {param.hi:g}"
    patch.add(f"#X floatatom {x + NAME + SLIDER + 14} {y} 7 {ends} 0 - {address} {sent};")
    patch.text(x + NAME + SLIDER + 14 + NUMBER, y, param.range_text)


# -- subpatches ----------------------------------------------------------------------------------


def _wires(server: Address) -> Canvas:
    """Add what sends to the server and receives from it."""
    wires = Canvas(1000, 700, "wires")
    host, port = server
    begin = wires.object(20, 20, "loadbang")
    order = wires.object(20, 50, "t b b b")
    metro = wires.object(20, 80, f"metro {1000 * layout.SUBSCRIBE_EVERY_S}")
    connect = wires.message(120, 80, f"connect {host} {port}")
    where = wires.message(300, 80, _defaults(), 60)
    subscribe = wires.message(20, 110, f"{layout.SUBSCRIBED_S}")
    asking = [
        wires.object(20 + 150 * column, 140, _format_of(address))
        for column, address in enumerate(layout.subscriptions())
    ]
    send = wires.object(20, 200, "list prepend send")
    trim = wires.object(20, 230, "list trim")
    net = wires.object(20, 260, "netsend -u -b")
    wires.chain(begin, order, metro, subscribe)
    for one in asking:
        wires.chain(subscribe, one, send)
    wires.chain(send, trim, net)
    wires.connect(order, connect, outlet=1)
    wires.connect(order, where, outlet=2)
    wires.connect(connect, net)
    moved = _sliders(wires, send)
    _calls(wires, send)
    _answers(wires, net, moved, subscribe)
    return wires


def _defaults() -> str:
    """Return a message that sets every slider to its parameter's default."""
    return " ".join(
        f"\\; {full(param.address)} set {param.default:g}"
        for group in layout.groups()
        for param in group.params
    )


def _local(name: str) -> str:
    """A name that all patches of one Pd know, another for each part."""
    return name.replace("yehu", layout.named("yehu").replace(" ", "."), 1)


def _format(address: str) -> str:
    return _format_of(full(address))


def _format_of(address: str) -> str:
    return "oscformat " + address.strip("/").replace("/", " ")


def _sliders(wires: Canvas, send: int) -> int:
    """Add what makes packets of moved sliders; return what bangs when one is moved."""
    packet = wires.object(20, 170, "t b a")
    wires.connect(packet, send, outlet=1)
    params = [param for group in layout.groups() for param in group.params]
    for place, param in enumerate(params):
        x, y = 20 + place % 4 * 300, 640 + place // 4 * 110
        address = full(param.address)
        moved = wires.object(x, y, f"r {address}{MOVED}")
        wires.chain(moved, wires.object(x, y + 25, _format(param.address)), packet)
        shown = wires.message(x, y + 50, "set \\$1")
        wires.chain(moved, shown, wires.object(x, y + 75, f"s {address}"))
    return packet


def _calls(wires: Canvas, send: int) -> None:
    """Add what keys, which slur, and buttons send."""
    key = wires.object(20, 420, f"r {_local(KEY)}")
    note = wires.object(20, 445, f"+ {layout.KEYS[0].note}")
    change = wires.object(20, 470, "change -1")
    order = wires.object(20, 495, "t f b f")
    last = wires.object(20, 560, "f")
    off = wires.object(20, 585, _format("/note/off"))
    begin = wires.message(120, 530, f"\\$1 {layout.VELOCITY}")
    on = wires.object(120, 560, _format("/note"))
    wires.chain(key, note, change, order)
    # The new note begins, the one before it ends, the new one is kept.
    wires.connect(order, begin, outlet=2)
    wires.connect(order, last, outlet=1)
    wires.connect(order, last, inlet=1)
    wires.chain(begin, on, send)
    wires.chain(last, off, send)
    end = wires.object(250, 420, f"r {_local(END)}")
    then = wires.object(250, 445, "t b b b")
    none = wires.message(250, 500, "0")
    forget = wires.message(300, 470, "set -1")
    wires.chain(end, then, none)
    wires.connect(then, last, outlet=2)
    wires.connect(then, forget, outlet=1)
    wires.connect(forget, change)
    wires.connect(none, last, inlet=1)
    for place, (name, arguments, address) in enumerate(
        ((LIFT, "0 0", "/bow"), (RELEASE, "", "/release"), (PANIC, "", "/panic"))
    ):
        x = 400 + 180 * place
        path = [wires.object(x, 420, f"r {_local(name)}")]
        if arguments:
            path.append(wires.message(x, 445, arguments))
        wires.chain(*path, wires.object(x, 470, _format(address)), send)


def _answers(wires: Canvas, net: int, moved: int, subscribe: int) -> None:
    """Add what sets sliders from packets: a slider's name is its parameter's address."""
    gate = wires.object(300, 260, "spigot 1")
    both = wires.object(300, 285, "t l l")
    words = wires.object(300, 310, "oscparse")
    again = wires.object(300, 335, "t l l")
    count = wires.object(420, 335, "list length")
    but_one = wires.object(420, 360, "- 1")
    split = wires.object(300, 360, "list split")
    shown = wires.message(300, 385, "set \\$1")
    # Of the whole packet: a symbol ends at its first zero, as an address does.
    name = wires.object(520, 310, "list tosymbol")
    target = wires.object(520, 385, "send")
    wires.connect(net, gate, outlet=1)
    wires.chain(gate, both, words, again, split)
    wires.connect(again, count, outlet=1)
    wires.chain(count, but_one)
    wires.connect(but_one, split, inlet=1)
    wires.connect(split, shown, outlet=1)
    wires.connect(shown, target)
    wires.connect(both, name, outlet=1)
    wires.connect(name, target, inlet=1)
    order = wires.object(300, 140, "t b b")
    close = wires.message(420, 170, "0")
    rest = wires.object(300, 170, f"delay {QUIET_MS}")
    then = wires.object(300, 200, "t b b")
    reopen = wires.message(420, 200, "1")
    wires.chain(moved, order, rest, then, subscribe)
    wires.connect(order, close, outlet=1)
    wires.connect(then, reopen, outlet=1)
    wires.connect(close, gate, inlet=1)
    wires.connect(reopen, gate, inlet=1)
