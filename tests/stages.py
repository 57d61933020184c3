"""The stage alone: the mix of given sounds, without the instruments that would make them."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.core.controls.slots import STAGE_INPUTS
from yehu_server.core.engine.instrument import new_memory
from yehu_server.core.engine.mixing import mix_block
from yehu_server.core.engine.output import prepare_output
from yehu_server.core.engine.rig import RIG, RIG_BYTES
from yehu_server.core.engine.sounding import STAGE_COLUMNS
from yehu_server.core.stage.record import STAGE, prepare_stage
from yehu_server.core.stage.seat import prepare_seat
from yehu_server.params.table import ENGINE

NAMES = ("size", "decay", "damping", "level", "distance", "pan", "width")
ADDRESSES = tuple(ENGINE[slot].address for slot in STAGE_INPUTS)
DEFAULTS = {name: ENGINE[slot].default for name, slot in zip(NAMES, STAGE_INPUTS, strict=True)}
RANGES = {
    name: (ENGINE[slot].lo, ENGINE[slot].hi) for name, slot in zip(NAMES, STAGE_INPUTS, strict=True)
}
SILENCED = STAGE_COLUMNS - 1
SMALL = 2.0**-10  # far below the limiter
LIMITER = STAGE_COLUMNS - 2


def told(frames: int, **asked: Any) -> Any:
    """What a stage needs with each frame [shape=(frames, STAGE_COLUMNS)]: values or arrays."""
    rows = np.zeros((frames, STAGE_COLUMNS))
    for column, name in enumerate(NAMES):
        rows[:, column] = asked.get(name, DEFAULTS[name])
    rows[:, LIMITER] = asked.get("limiter", 1.0)
    return rows


class Stage:
    """A stage of players who sound as they are told."""

    def __init__(self, rate: float, parts: int = 1, *, has_room: bool = True) -> None:
        self.rate, self.parts, self.frame = rate, parts, 0
        self.memory = new_memory(parts)
        self.memory[:8].view(np.int64)[0] = parts
        self.rigs = np.frombuffer(self.memory, RIG, count=parts)
        self.record = np.frombuffer(self.memory, STAGE, offset=parts * RIG_BYTES, count=1)[0]
        prepare_stage(self.record, rate, 2, has_room=has_room)
        self.rigs["meters"]["rate"] = rate
        for body, rig in enumerate(self.rigs):
            prepare_output(rig["output"], rate)
            prepare_seat(rig["seat"], rate, body)

    def play(self, dry: Any, rows: Any, block: int = 0) -> tuple[Any, Any]:
        """Mix the sounds of all parts.

        Parameters
        ----------
        dry : ndarray [shape=(frames,) or (parts, frames)]
        rows : ndarray [shape=(frames, STAGE_COLUMNS) or (parts, frames, STAGE_COLUMNS)]
            As `told`.

        Returns
        -------
        out : ndarray [shape=(frames, 2), float32]
        stems : ndarray [shape=(frames, parts + 1, 2)]
            What each part gives, and last the room.
        """
        dry = np.broadcast_to(dry, (self.parts, np.shape(dry)[-1]))
        frames = dry.shape[1]
        rows = np.broadcast_to(rows, (self.parts, frames, STAGE_COLUMNS))
        out = np.zeros((frames, 2), np.float32)
        stems = np.zeros((frames, self.parts + 1, 2))
        for start in range(0, frames, block or frames):
            part = slice(start, min(frames, start + (block or frames)))
            some = np.ascontiguousarray(dry[:, part], np.float64)
            where = np.ascontiguousarray(rows[:, part])
            mix_block.call(
                self.memory.ctypes.data, self.frame, some.shape[1], some.ctypes.data,
                where.ctypes.data, out[part].ctypes.data, stems[part].ctypes.data, 1,
            )  # fmt: skip
            self.frame += some.shape[1]
        return out, stems

    def settle(self, seconds: float = 0.5, **asked: Any) -> None:
        """Let some silence pass, in which the room opens."""
        frames = round(seconds * self.rate)
        self.play(np.zeros(frames), told(frames, **asked))


def response(rate: float, seconds: float, **asked: Any) -> tuple[Any, Any]:
    """What an impulse of one player gives, once the room is open: direct sound, and the room."""
    stage = Stage(rate)
    stage.settle(**asked)
    frames = round(seconds * rate)
    dry = np.zeros(frames)
    dry[0] = SMALL
    stems = stage.play(dry, told(frames, **asked))[1] / SMALL
    return stems[:, 0], stems[:, 1]
