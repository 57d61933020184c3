"""What all surfaces share: parameters in groups, pads, keys, addresses, and the subscription."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from yehu_server.core.player.fingering import HIGHEST_NOTE, LOWEST_NOTE
from yehu_server.live.osc.call_table import CALLS
from yehu_server.live.part_addresses import group as group_of_part
from yehu_server.params.spec import Param
from yehu_server.params.table import PREFIX, TABLE, UNIT, find
from yehu_server.playing.pitch_and_level import note_name

FIRST_GROUP = "playing"  # used most
BLACK = (1, 3, 6, 8, 10)

VELOCITY = 90
# A subscription outlives one message that UDP loses.
SUBSCRIBED_S, SUBSCRIBE_EVERY_S = 60, 25
# The pad's strongest bow force; the fader of /bow/force has the whole range.
HARDEST_N = 2.0


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

    @property
    def at(self) -> float:
        """The pad's first position, 0 to 1."""
        return (self.start - self.lo) / (self.hi - self.lo)

    @property
    def text(self) -> str:
        """The axis' label."""
        return f"{self.name} {self.lo:g} to {self.hi:g} {self.unit}"


@dataclass(frozen=True)
class Key:
    """One key of the note strip."""

    note: int

    @property
    def name(self) -> str:
        """The note's name, such as F#4."""
        return note_name(self.note)

    @property
    def is_black(self) -> bool:
        """Whether it is a black key of a piano."""
        return self.note % 12 in BLACK


KEYS = tuple(Key(note) for note in range(LOWEST_NOTE, HIGHEST_NOTE + 1))

_FASTEST = find("/playing/speed").hi
_PRESS = find("/playing/press")
BOW_SPEED = Axis("speed", -_FASTEST, _FASTEST, 0.0, "m/s")
BOW_FORCE = Axis("force", 0.0, HARDEST_N, 0.0, "N")
STRING_PITCH = Axis("pitch", LOWEST_NOTE, HIGHEST_NOTE, LOWEST_NOTE, "MIDI")
STRING_PRESS = Axis("press", _PRESS.lo, _PRESS.hi, _PRESS.default, _PRESS.unit)


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

ALL = 0  # in place of a part, from 1: the addresses without a part, which are those of the first
_part: ContextVar[int] = ContextVar("part", default=ALL)
_FOR_ALL = {param.address for param in TABLE if param.is_shared} | {
    call.address for call in CALLS if call.is_for_all
}


@contextmanager
def for_part(part: int) -> Iterator[None]:
    """Let what is made meanwhile speak to a part, from 1, or `ALL`."""
    before = _part.set(part)
    try:
        yield
    finally:
        _part.reset(before)


def full(address: str) -> str:
    """Return the OSC address of a parameter or call."""
    part = _part.get()
    if part == ALL or address.removesuffix(UNIT) in _FOR_ALL:
        return PREFIX + address
    return PREFIX + group_of_part(part - 1) + address


def subscriptions(form: str = "") -> list[str]:
    """The OSC addresses to subscribe at, so that all parameters are told in a form."""
    asked = full("/subscribe" + form)
    common = PREFIX + "/subscribe" + form  # a part does not tell what all parts share
    return [asked] if asked == common else [asked, common]


def named(name: str) -> str:
    """Put the part behind a name: ``yehu part 2``."""
    return name if _part.get() == ALL else f"{name} part {_part.get()}"


def port_from(first: int) -> int:
    """A port to listen at, another for each part."""
    return first + _part.get()
