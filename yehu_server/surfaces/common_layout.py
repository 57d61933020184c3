"""The layout of all surfaces: pads, keys and buttons with their places; parameters in groups."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import NamedTuple

from yehu_server.core.player.note_range import HIGHEST_NOTE, LOWEST_NOTE
from yehu_server.live.osc.all_calls import CALLS
from yehu_server.live.part_addresses import group_of as group_of_part
from yehu_server.params.spec import Param
from yehu_server.params.table import PREFIX, TABLE, UNIT, find

FIRST_GROUP = "playing"  # used most
VELOCITY = 90
# A subscription outlives one message that UDP loses.
SUBSCRIBED_S, SUBSCRIBE_EVERY_S = 60, 25
# The pad's strongest bow force; the fader of /bow/force has the whole range.
HARDEST_N = 2.0


class Frame(NamedTuple):
    """A position and a size: of a page, of a control on it, or as shares of a page."""

    x: float
    y: float
    width: float
    height: float

    def on(self, page: Frame, gap: float = 0.0) -> Frame:
        """The place on a page of a frame that is given as shares, less a gap around it."""
        x, y = page.x + self.x * page.width, page.y + self.y * page.height
        width, height = self.width * page.width, self.height * page.height
        return Frame(x + gap, y + gap, width - 2 * gap, height - 2 * gap)


@dataclass(frozen=True)
class Group:
    """The parameters whose addresses begin with the same word, in the table's order."""

    name: str
    params: tuple[Param, ...]


@dataclass(frozen=True)
class Axis:
    """One axis of a pad: the parameter it moves, in `unit`."""

    name: str
    lo: float
    hi: float
    start: float
    unit: str


@dataclass(frozen=True)
class Pad:
    """A pad with a horizontal and a vertical axis."""

    name: str
    axes: tuple[Axis, Axis]
    frame: Frame
    # Its calls, each with the numbers of the axes that are the arguments.
    calls: tuple[tuple[str, tuple[int, ...]], ...]
    lifted: str = ""  # the call that is sent with zeros when the hand leaves the pad

    @property
    def title(self) -> str:
        """The pad's label."""
        x, y = (f"{each.name} {each.lo:g} to {each.hi:g} {each.unit}" for each in self.axes)
        return f"{self.name}: {x} across, {y} up"


_FASTEST = find("/playing/speed").hi
_PRESS = find("/playing/press")
BOW_SPEED = Axis("speed", -_FASTEST, _FASTEST, 0.0, "m/s")
BOW_FORCE = Axis("force", 0.0, HARDEST_N, 0.0, "N")
STRING_PITCH = Axis("pitch", LOWEST_NOTE, HIGHEST_NOTE, LOWEST_NOTE, "MIDI")
STRING_PRESS = Axis("press", _PRESS.lo, _PRESS.hi, _PRESS.default, _PRESS.unit)

STRING = Pad(
    "string",
    (STRING_PITCH, STRING_PRESS),
    Frame(0.0, 0.0, 0.5, 0.68),
    (("/pitch", (0,)), ("/press", (1,))),
)
BOW = Pad(
    "bow", (BOW_SPEED, BOW_FORCE), Frame(0.5, 0.0, 0.5, 0.68), (("/bow", (0, 1)),), lifted="/bow"
)
PADS = (STRING, BOW)
KEYS = range(LOWEST_NOTE, HIGHEST_NOTE + 1)  # MIDI notes
KEYS_FRAME = Frame(0.0, 0.68, 1.0, 0.32)
BUTTONS = ("release", "panic")  # calls without arguments


def groups(table: Iterable[Param] = TABLE) -> list[Group]:
    """Sort parameters by the first word of their addresses; `FIRST_GROUP` comes first."""
    found: dict[str, list[Param]] = {FIRST_GROUP: []}
    for param in table:
        found.setdefault(param.address.split("/")[1], []).append(param)
    return [Group(name, tuple(params)) for name, params in found.items() if params]


def label(param: Param) -> str:
    """A parameter's name within its group: ``bow position``."""
    return " ".join(param.address.split("/")[2:]).replace("_", " ")


# -- the part that a surface is for ---------------------------------------------------------------

ALL = 0  # no part: addresses without one, which are those of the first part
_part: ContextVar[int] = ContextVar("part", default=ALL)
_FOR_ALL = {param.address for param in TABLE if param.is_shared} | {
    call.address for call in CALLS if call.is_for_all
}


@contextmanager
def for_part(part: int) -> Iterator[None]:
    """Make the addresses within the block those of a part, from 1, or `ALL`."""
    before = _part.set(part)
    try:
        yield
    finally:
        _part.reset(before)


def osc_address(address: str) -> str:
    """Return the whole OSC address of a parameter or call, with the part."""
    part = _part.get()
    if part == ALL or address.removesuffix(UNIT) in _FOR_ALL:
        return PREFIX + address
    return PREFIX + group_of_part(part - 1) + address


def subscriptions(form: str = "") -> list[str]:
    """The OSC addresses to subscribe at for all parameters, in a form: "" or `UNIT`."""
    own = osc_address("/subscribe" + form)
    common = PREFIX + "/subscribe" + form  # parameters that all parts share
    return [own] if own == common else [own, common]


def with_part(name: str) -> str:
    """A name with the part behind it: ``yehu part 2``."""
    return name if _part.get() == ALL else f"{name} part {_part.get()}"


def local_name(name: str) -> str:
    """A name within a patch, different from those in the patch of another part: ``yehu.out``."""
    return f"{with_part('yehu').replace(' ', '.')}.{name}"


def port_from(first: int) -> int:
    """A port to listen at, a different one for each part."""
    return first + _part.get()
