"""The stage alone: the mix of given sounds, without the instruments that would make them."""

import itertools
from typing import Any

import numpy as np

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.controls.slots import STAGE_INPUTS
from yehu_server.core.engine.instrument import new_memory
from yehu_server.core.engine.mixing import mix_block
from yehu_server.core.engine.output import NOT_SILENCED, SOUNDED, prepare_output
from yehu_server.core.engine.rig import RIG, RIG_BYTES
from yehu_server.core.stage.record import STAGE, prepare_stage
from yehu_server.core.stage.seat import prepare_seat
from yehu_server.params.table import ENGINE

NAMES = ("size", "decay", "damping", "level", "distance", "pan", "width")
ADDRESSES = tuple(ENGINE[slot].address for slot in STAGE_INPUTS)
DEFAULTS = {name: ENGINE[slot].default for name, slot in zip(NAMES, STAGE_INPUTS, strict=True)}
RANGES = {
    name: (ENGINE[slot].lo, ENGINE[slot].hi) for name, slot in zip(NAMES, STAGE_INPUTS, strict=True)
}
# Of each frame: what a stage needs, the limiter, and whether the instrument is put to rest.
LIMITER = len(STAGE_INPUTS)
SILENCED = LIMITER + 1
COLUMNS = SILENCED + 1
SMALL = 2.0**-10  # far below the limiter


def stage_inputs(frames: int, **asked: Any) -> Any:
    """What a stage needs with each frame [shape=(frames, COLUMNS)]: values or arrays."""
    rows = np.zeros((frames, COLUMNS))
    for column, name in enumerate(NAMES):
        rows[:, column] = asked.get(name, DEFAULTS[name])
    rows[:, LIMITER] = asked.get("limiter", 1.0)
    return rows


def as_sounded(dry: Any, rows: Any) -> Any:
    """Samples of all parts, and rows as `stage_inputs`, as instruments give them to the stage."""
    parts, frames = dry.shape
    sounded = np.zeros((parts, -(-frames // CHUNK)), SOUNDED)
    sounded["silenced_at"] = NOT_SILENCED
    for part, begin in itertools.product(range(parts), range(0, frames, CHUNK)):
        chunk, own = sounded[part, begin // CHUNK], rows[part, begin : begin + CHUNK]
        chunk["dry"][: len(own)] = dry[part, begin : begin + CHUNK]
        chunk["stage_inputs"][: len(own)] = own[:, :LIMITER]
        chunk["soft"][: len(own)] = own[:, LIMITER]
        for silenced in np.flatnonzero(own[:, SILENCED]):
            chunk["silenced_at"] = silenced
    return sounded


class Stage:
    """A stage of players whose sounds are given."""

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
        rows : ndarray [shape=(frames, COLUMNS) or (parts, frames, COLUMNS)]
            As `stage_inputs`.

        Returns
        -------
        out : ndarray [shape=(frames, 2), float32]
        stems : ndarray [shape=(frames, parts + 1, 2)]
            What each part gives, and last the room.
        """
        dry = np.broadcast_to(dry, (self.parts, np.shape(dry)[-1]))
        frames = dry.shape[1]
        rows = np.broadcast_to(rows, (self.parts, frames, COLUMNS))
        out = np.zeros((frames, 2), np.float32)
        stems = np.zeros((frames, self.parts + 1, 2))
        for start in range(0, frames, block or frames):
            part = slice(start, min(frames, start + (block or frames)))
            sounded = as_sounded(dry[:, part], rows[:, part])
            count = part.stop - part.start
            into = (out[part].ctypes.data, stems[part].ctypes.data, 1)
            places = (self.memory.ctypes.data, sounded.ctypes.data, self.frame)
            mix_block.call(*places, count, *into)
            self.frame += count
        return out, stems

    def settle(self, seconds: float = 0.5, **asked: Any) -> None:
        """Let some silence pass, in which the room opens."""
        frames = round(seconds * self.rate)
        self.play(np.zeros(frames), stage_inputs(frames, **asked))


def response(rate: float, seconds: float, **asked: Any) -> tuple[Any, Any]:
    """What an impulse of one player gives, once the room is open: direct sound, and the room."""
    stage = Stage(rate)
    stage.settle(**asked)
    frames = round(seconds * rate)
    dry = np.zeros(frames)
    dry[0] = SMALL
    stems = stage.play(dry, stage_inputs(frames, **asked))[1] / SMALL
    return stems[:, 0], stems[:, 1]
