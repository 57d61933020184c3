"""Passes on the wishes of another program's player, such as a page's.

Such a player reads MIDI and mappings itself, and sends what it would post. Its keys lie on channels
of its own, so that they are not mistaken for those of another player.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from yehu_server.errors import ParameterError
from yehu_server.midi.events import LEAVE, SET
from yehu_server.params.table import TABLE
from yehu_server.player.wishes import (
    BEGIN,
    DRAW,
    END,
    EXPRESS,
    HOLD,
    KINDS,
    LIFT,
    RAMP,
    STOP,
    WRITE,
)
from yehu_server.playing.wishes import Wishes

FIRST, CHANNELS = 1 << 16, 1 << 12  # channels of the first visitor, and of each
LOWEST = -(CHANNELS // 2)
SETTINGS = (WRITE, HOLD, EXPRESS)


@dataclass(frozen=True)
class Wish:
    """A wish, as ``player.wishes`` has it, without its frame.

    Raises
    ------
    ParameterError
        Where there is none of this kind, for this index, or with such numbers.
    """

    kind: int
    index: int
    value: float
    other: float

    def __post_init__(self) -> None:
        is_known = self.kind != RAMP and 0 <= self.kind < len(KINDS)
        if not (is_known and math.isfinite(self.value) and math.isfinite(self.other)):
            raise ParameterError(f"no wish: {self.kind} {self.value:g} {self.other:g}")
        last = len(TABLE) - 1 if self.kind in SETTINGS else LOWEST + CHANNELS - 1
        if not (0 if self.kind in SETTINGS else LOWEST) <= self.index <= last:
            raise ParameterError(f"no wish: {self.kind} of {self.index}")

    @property
    def ends_all(self) -> bool:
        """Whether it ends all notes of all players."""
        return self.kind == STOP and self.value != 0.0


class Visitor:
    """The player of another program.

    Parameters
    ----------
    number : int
        Tells visitors apart.
    """

    def __init__(self, wishes: Wishes, number: int) -> None:
        self._wishes = wishes
        self._first = FIRST + number * CHANNELS - LOWEST
        self._draws = False

    def take(self, wish: Wish, frame: int) -> None:
        """Fulfil a wish at a frame."""
        kind = SET if wish.kind == WRITE else wish.kind
        index = self._first + wish.index if kind in (BEGIN, END) else wish.index
        self._wishes.post(kind, frame, index, wish.value, wish.other)
        self._draws = kind == DRAW or (self._draws and kind != LIFT)

    def leave(self, frame: int) -> None:
        """End all that it holds."""
        self._wishes.post(LEAVE, frame, self._first + LOWEST, CHANNELS)
        if self._draws:
            self._wishes.lift(frame=frame)
