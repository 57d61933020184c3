"""Fulfils the wishes of another program's player, such as a page's, and knows what it holds.

Such a player reads MIDI and mappings itself, and sends what it would post. Its keys lie on channels
of its own, so that they are not mistaken for those of another player.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from yehu_server.errors import ParameterError
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
    RELEASE,
    SLIDE,
    STOP,
    WRITE,
)
from yehu_server.playing.wishes import Key, Wishes

FIRST, CHANNELS = 1 << 16, 1 << 12  # channels of the first visitor, and of each
LOWEST = -(CHANNELS // 2)
MOST_HELD = 256  # keys; beyond, the one held longest ends
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
    write : callable
        Sets a parameter for all that play: by address, value, and the keyword `frame`.
    number : int
        Tells visitors apart.
    """

    def __init__(self, wishes: Wishes, write: Callable[..., float], number: int) -> None:
        self._wishes = wishes
        self._write = write
        self._first = FIRST + number * CHANNELS - LOWEST
        self._values: dict[str, float] = {}  # for the note that begins next
        self._ending: list[Key] = []  # keys that end together with the next
        self._held: dict[Key, None] = {}  # in the order pressed
        self._draws = False

    def take(self, wish: Wish, frame: int) -> None:
        """Fulfil a wish at a frame."""
        kind, value = wish.kind, wish.value
        if kind == EXPRESS:
            self._values[TABLE[wish.index].address] = value
        elif kind == WRITE and not wish.other:
            self._write(TABLE[wish.index].address, value, frame=frame)
        elif kind in (WRITE, HOLD):
            address, hold = TABLE[wish.index].address, kind == HOLD
            self._wishes.write(address, value, frame=frame, hold=hold, glide_ms=wish.other)
        elif kind == BEGIN:
            self._begin(Key(self._first + wish.index, value), wish.other, frame)
        elif kind == END:
            self._ending.append(Key(self._first + wish.index, value))
            if not wish.other or len(self._ending) >= MOST_HELD:
                self._end(frame)
        elif kind == SLIDE:
            self._wishes.slide(value, frame=frame)
        elif kind == DRAW:
            self._wishes.draw(value, wish.other, frame=frame)
            self._draws = True
        elif kind == LIFT:
            self._wishes.lift(frame=frame)
            self._draws = False
        elif kind == STOP:
            self._wishes.stop_sound(frame=frame)
        elif kind == RELEASE:
            self._wishes.release(frame=frame)

    def leave(self, frame: int) -> None:
        """End all that it holds."""
        self._ending.extend(self._held)
        self._values.clear()
        self._end(frame)
        if self._draws:
            self._wishes.lift(frame=frame)

    def _begin(self, key: Key, pitch: float, frame: int) -> None:
        values, self._values = self._values, {}
        if len(self._held) >= MOST_HELD:
            self._ending.append(next(iter(self._held)))
            self._end(frame)
        self._held.pop(key, None)
        self._held[key] = None
        self._wishes.note_on(key, values, frame=frame, tuned=pitch)

    def _end(self, frame: int) -> None:
        values, self._values = self._values, {}
        ending, self._ending = self._ending, []
        for key in ending:
            self._held.pop(key, None)
        if ending:
            self._wishes.notes_off(ending, values, frame=frame)
