"""Rooms, compiled: what they answer to sound, apart from any instrument."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.layout import new_record
from yehu_server.core.stage.late_field import (
    CHECK_FRAMES,
    LATE_FIELD,
    prepare_room,
    reverberate,
    set_room,
)


@dataclass(frozen=True)
class Asked:
    """What is asked of a room."""

    size: float = 5.0
    decay: float = 0.4
    damping: float = 0.4


@compiled_exactly
def _run(room: Any, first: int, asked: Any, level: Any, sound: Any, heard: Any) -> None:
    done = 0
    while done < sound.shape[0]:
        if (first + done) % CHECK_FRAMES == 0:
            set_room(room[0], asked[done, 0], asked[done, 1], asked[done, 2])
        end = min(done + CHECK_FRAMES - (first + done) % CHECK_FRAMES, sound.shape[0])
        reverberate(room[0], first + done, level[done:end], sound[done:end], heard[done:end])
        done = end


class Room:
    """A room that stands open, so that what enters it is heard in full."""

    def __init__(self, rate: float, asked: Asked) -> None:
        self.rate, self.asked = rate, asked
        self.record = new_record(LATE_FIELD)
        prepare_room(self.record[0], rate)
        self.frame = 0
        self.hear(np.zeros((round(0.5 * rate), 2)))

    def hear(self, sound: Any, asked: Any = None, level: Any = 1.0) -> Any:
        """What the room gives to sound that enters it, at both ears [shape=(frames, 2)]."""
        frames = len(sound)
        if asked is None:
            asked = (self.asked.size, self.asked.decay, self.asked.damping)
        rows = np.ascontiguousarray(np.broadcast_to(np.asarray(asked, float), (frames, 3)))
        levels = np.ascontiguousarray(np.broadcast_to(np.asarray(level, float), frames))
        heard = np.zeros((frames, 2))
        _run(self.record, self.frame, rows, levels, np.ascontiguousarray(sound, float), heard)
        self.frame += frames
        return heard

    def response(self, seconds: float, left: float = 1.0, right: float = 1.0) -> Any:
        """What the room gives to an impulse at its two sides [shape=(frames, 2)]."""
        sound = np.zeros((round(seconds * self.rate), 2))
        sound[0] = left, right
        return self.hear(sound)
