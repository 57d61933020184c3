"""The lines of a capture: commands as JSON values, and back; docs/capture.md describes them."""

from typing import Any

import llvmlite
import numpy as np

from yehu_server.compile import levels
from yehu_server.compile.cache_folder import source_hash
from yehu_server.core.controls.slots import SILENCE
from yehu_server.core.player import commands
from yehu_server.errors import ParameterError
from yehu_server.params.table import ENGINE, SLOT, TABLE
from yehu_server.util import __version__
from yehu_server.util.values import number, whole

FORMAT, VERSION = "yehu-server capture", 3
MAX_FRAMES = 1 << 53
MAX_MS = 3.6e6
MAX_CHANNELS = 1 << 20
HIGHEST_KEY = 127.0
SILENCED = "silence"
ADDRESSES = {slot: address for address, slot in SLOT.items()} | {SILENCE: SILENCED}
INDICES = {address: slot for slot, address in ADDRESSES.items()}
INDEX = {param.address: index for index, param in enumerate(TABLE)}
NUMBERS = {name: kind for kind, name in enumerate(commands.KINDS)}

CommandRow = tuple[int, int, int, float, float]  # of a command
# What is raised where a line, or a part of one, is no command.
WRONG = (
    ParameterError, ValueError, TypeError, KeyError, IndexError, AttributeError, RecursionError,
)  # fmt: skip


def build() -> dict[str, str]:
    """Versions and machine on which the samples depend: the same build gives the same bits."""
    return {
        "yehu-server": __version__,
        "sources": source_hash(),
        "numpy": np.__version__,
        "llvm": llvmlite.__version__,
        "level": levels.level(),
    }


def as_line(command: CommandRow, player: int = 0) -> list[Any]:  # noqa: PLR0911 - one for each kind
    """The JSON value of a command, the fields of a COMMAND, of a player, counted from 0."""
    frame, kind, index, value, other = command
    line: list[Any] = [frame, player + 1, commands.KINDS[kind]]
    if kind == commands.RAMP:
        return [*line, ADDRESSES[index], value, int(other)]
    if kind in (commands.WRITE, commands.HOLD):
        return [*line, TABLE[index].address, value, other]
    if kind == commands.EXPRESS:
        return [*line, TABLE[index].address, value]
    if kind == commands.BEGIN:
        return [*line, index, value, other]
    if kind == commands.END:
        return [*line, index, value, int(other)]
    if kind in (commands.SLIDE, commands.STOP):
        return [*line, value]
    if kind == commands.DRAW:
        return [*line, value, other]
    return [*line, value] if value != 0.0 else line  # of a release, what is held stays so


def from_line(line: list[Any]) -> CommandRow:
    """A command's fields, from its JSON value; raises `WRONG`."""
    frame, kind, values = whole(line[0], 0, MAX_FRAMES), NUMBERS[line[1]], line[2:]
    index, value, other = 0, 0.0, 0.0
    if kind == commands.RAMP:
        return (frame, *ramp_of(*values))
    if kind in (commands.WRITE, commands.HOLD):
        address, setting, glide_ms = values
        index, value = _setting(address, setting)
        other = number(glide_ms, 0.0, MAX_MS)
    elif kind == commands.EXPRESS:
        index, value = _setting(*values)
    elif kind in (commands.BEGIN, commands.END):
        channel, key, last = values
        index = whole(channel, -MAX_CHANNELS, MAX_CHANNELS)  # below 0: no MIDI channel
        value = number(key, 0.0, HIGHEST_KEY)
        is_key = kind == commands.BEGIN
        other = number(last, 0.0, HIGHEST_KEY) if is_key else float(whole(last, 0, 1))
    elif kind == commands.STOP:
        (panic,) = values
        value = number(panic, 0.0, 1.0)
    elif kind == commands.SLIDE:
        (pitch,) = values
        value = number(pitch, 0.0, HIGHEST_KEY)
    elif kind == commands.DRAW:
        speed, force = values
        value, other = _setting("/bow/speed", speed)[1], _setting("/bow/force", force)[1]
    elif kind == commands.RELEASE and len(values) == 1:
        value = number(values[0], 0.0, 1.0)
    elif values:
        raise ValueError("more values than it takes")
    return frame, kind, index, value, other


def ramp_of(address: str, target: Any, ramp: Any) -> tuple[int, int, float, float]:
    """The fields of a ramp after its frame: also the events of version 1."""
    index = INDICES[address]
    lo, hi = (0.0, 0.0) if index == SILENCE else (ENGINE[index].lo, ENGINE[index].hi)
    return commands.RAMP, index, number(target, lo, hi), float(whole(ramp, 0, MAX_FRAMES))


def _setting(address: str, value: Any) -> tuple[int, float]:
    index = INDEX[address]
    return index, number(value, TABLE[index].lo, TABLE[index].hi)
