"""Posts the commands of pages to the ring from which the audio callback takes it.

A page reads MIDI and mappings itself, and sends what it would post. Its keys lie on channels of
its own, so that they are not mistaken for those of another page, or of MIDI.
"""

from collections import defaultdict, deque
from collections.abc import Sequence
from typing import Any

import numpy as np

from yehu_server.core.midi.events import LEAVE, RELEASE_ALL, SET
from yehu_server.core.physics.layout import MAX_FINGERS
from yehu_server.core.player.commands import (
    BEGIN,
    DRAW,
    END,
    EXPRESS,
    HOLD,
    LIFT,
    RELEASE,
    SLIDE,
    STOP,
    WRITE,
)
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.live.page.guests import LISTEN, OWN, is_owner_only
from yehu_server.live.page.shared_view import SharedView
from yehu_server.params.table import TABLE
from yehu_server.playing.delay import Arrivals

FIRST, CHANNELS = 1 << 16, 1 << 12  # channels of the first page, and of each
LOWEST = -(CHANNELS // 2)  # of them, as a page numbers its own
AHEAD_S = 3.0  # by which a command may lie ahead
MAX_EVENTS = 3  # that a command comes to
FIRST_PART = 0
VALUE, KEEP_HELD = 3, 1.0  # the column of a command, and what it is of a RELEASE
OWNER_ONLY = sorted(INDEX[param.address] for param in TABLE if is_owner_only(param))
# What a hand moves that no parameter names.
MOVED = {
    DRAW: {INDEX[f"/bow/{name}"] for name in ("speed", "force", "assist")},
    SLIDE: {INDEX[f"/finger/{number + 1}/position"] for number in range(MAX_FINGERS)},
}
SHARED = frozenset(INDEX[param.address] for param in TABLE if param.is_shared)

Array = Any


class PagePlayers:
    """What pages play, by their numbers, on each part's first instrument; of one thread."""

    def __init__(self, view: SharedView, rigs: Sequence[int]) -> None:
        self._view = view
        self._rigs = rigs
        self._arrivals = Arrivals(view.frame_of, view.rate)
        # Parts that each page played: frame of its latest command, and whether it draws the bow.
        self._played: dict[int, dict[int, tuple[int, bool]]] = {}
        # Numbers of the events of each page and part that the callback has not taken yet.
        self._posted: dict[tuple[int, int], deque[int]] = defaultdict(deque)

    def has_room(self, page: int, part: int, commands: int) -> bool:
        """Whether so many commands of a page find room where events of its part wait."""
        return all(self._has_room(page, each, commands) for each in {part, FIRST_PART})

    def _has_room(self, page: int, part: int, commands: int) -> bool:
        posted, taken = self._posted[page, part], self._view.taken(self._rigs[part])
        while posted and posted[0] <= taken:
            posted.popleft()
        room = self._view.room(self._rigs[part], page) - len(posted)
        return room >= MAX_EVENTS * commands

    def post(self, page: int, part: int, commands: Array, arrived_ns: int) -> None:
        """Post commands of a page, for the frames that they name or for now.

        `part`: counted from 0; what all parts share goes to the first.
        `commands` (ndarray [shape=(n, 5)]): frame, kind, index, value and other of each, as
        ``sockets.read_commands`` has them.
        `arrived_ns`: when they came (`clocks.monotonic_ns`).
        """
        now = self._arrivals.frame_of(arrived_ns)
        most = now + round(AHEAD_S * self._view.rate)
        parts = self._played.setdefault(page, {})
        for at, kind, index, value, other in commands.tolist():
            frame = int(min(max(at, now), most))
            target_part = FIRST_PART if kind == WRITE and index in SHARED else part
            latest, draws = parts.get(target_part, (frame, False))
            draws = kind == DRAW or (draws and kind != LIFT)
            parts[target_part] = max(latest, frame), draws
            self._post_one(page, target_part, frame, int(kind), int(index), value, other)

    def _post_one(
        self, page: int, part: int, frame: int, kind: int, index: int, value: float, other: float
    ) -> None:
        if kind == STOP and value != 0.0:  # a panic: all notes of the part end
            self._post_event(page, part, frame, RELEASE_ALL, 0, 1.0)
            self._post_event(page, part, frame, LIFT)
        elif kind == WRITE:
            kind = SET
        elif kind in (BEGIN, END):
            index += FIRST + page * CHANNELS - LOWEST
        self._post_event(page, part, frame, kind, index, value, other)

    def _post_event(
        self,
        page: int,
        part: int,
        frame: int,
        kind: int,
        index: int = 0,
        value: float = 0.0,
        other: float = 0.0,
    ) -> None:
        number = self._view.post(self._rigs[part], page, frame, kind, index, value, other)
        self._posted[page, part].append(number)

    def leave(self, page: int, left_ns: int) -> None:
        """End all that a page holds which is gone, after all that it requested ahead."""
        now = self._arrivals.frame_of(left_ns)
        for part, (latest, draws) in self._played.pop(page, {}).items():
            frame = max(now, latest)
            self._post_event(page, part, frame, LEAVE, FIRST + page * CHANNELS, CHANNELS)
            if draws:
                self._post_event(page, part, frame, LIFT)


def permitted(role: str, commands: Array, held: Sequence[int] = ()) -> tuple[Array, bool]:
    """The commands that a role may have applied, and whether its own notes are to end.

    No page holds a value: that would outlive it. A player's silence is that of the player; a player
    changes how notes are played, but neither what the owner holds nor the instrument, the room and
    the output.

    `held`: indices of the parameters that the owner holds.
    """
    commands = commands[commands[:, 1] != HOLD]
    if role == OWN:
        return commands, False
    if role == LISTEN:
        return commands[:0], False
    kinds, indices = commands[:, 1], commands[:, 2]
    is_stop = kinds == STOP
    owned = {*OWNER_ONLY, *map(int, held)}
    is_owned = np.isin(kinds, (WRITE, EXPRESS)) & np.isin(indices, [*owned])
    for kind, moved in MOVED.items():
        is_owned |= (kinds == kind) & (not owned.isdisjoint(moved))
    allowed = commands[~(is_stop | is_owned)]
    allowed[allowed[:, 1] == RELEASE, VALUE] = KEEP_HELD
    return allowed, bool(is_stop.any())
