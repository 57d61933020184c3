"""Posts the commands of pages to the ring from which the audio callback takes it.

A page reads MIDI and mappings itself, and sends what it would post. Its keys lie on channels of
its own, so that they are not mistaken for those of another page, or of MIDI.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from yehu_server.core.midi.events import LEAVE, RELEASE_ALL, SET
from yehu_server.core.player.commands import BEGIN, DRAW, END, EXPRESS, HOLD, LIFT, STOP, WRITE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.live.page.guests import LISTEN, OWN
from yehu_server.live.page.shared_view import SharedView
from yehu_server.params.table import TABLE
from yehu_server.playing.delay import Arrivals

FIRST, CHANNELS = 1 << 16, 1 << 12  # channels of the first page, and of each
LOWEST = -(CHANNELS // 2)  # of them, as a page numbers its own
AHEAD_S = 3.0  # by which a command may lie ahead
FIRST_PART = 0
# What is the instrument's, the room's or the output's, and no player's.
OWNER_ONLY = sorted(
    INDEX[param.address]
    for param in TABLE
    if param.is_shared or param.address.startswith(("/body/", "/string/", "/engine/", "/output/"))
)
SHARED = frozenset(INDEX[param.address] for param in TABLE if param.is_shared)

Array = Any


class PagePlayers:
    """What pages play, by their numbers; called from one thread.

    `rigs`: the first instrument of each part.
    """

    def __init__(self, view: SharedView, rigs: Sequence[int]) -> None:
        self._view = view
        self._rigs = rigs
        self._arrivals = Arrivals(view.frame_of, view.rate)
        # Parts that each page played: frame of its latest command, and whether it draws the bow.
        self._played: dict[int, dict[int, tuple[int, bool]]] = {}

    def post(self, page: int, part: int, commands: Array, arrived_ns: int) -> None:
        """Post commands of a page, for the frames that they name or for now.

        `part`: counted from 0; what all parts share goes to the first.
        `commands` (ndarray [shape=(n, 5)]): frame, kind, index, value and other of each, as
        ``sockets.read_commands`` has them.
        `arrived_ns`: when they came (``time.monotonic_ns()``).
        """
        now = self._arrivals.frame_of(arrived_ns)
        most = now + round(AHEAD_S * self._view.rate)
        parts = self._played.setdefault(page, {})
        for at, kind, index, value, other in commands.tolist():
            frame = int(min(max(at, now), most))
            target_part = FIRST_PART if kind in (WRITE, HOLD) and index in SHARED else part
            latest, draws = parts.get(target_part, (frame, False))
            draws = kind == DRAW or (draws and kind != LIFT)
            parts[target_part] = max(latest, frame), draws
            self._post_one(page, target_part, frame, int(kind), int(index), value, other)

    def _post_one(
        self, page: int, part: int, frame: int, kind: int, index: int, value: float, other: float
    ) -> None:
        rig = self._rigs[part]
        if kind == STOP and value != 0.0:  # a panic: all notes of the part end
            self._view.post(rig, frame, RELEASE_ALL, value=1.0)
            self._view.post(rig, frame, LIFT)
        elif kind == WRITE:
            kind = SET
        elif kind in (BEGIN, END):
            index += FIRST + page * CHANNELS - LOWEST
        self._view.post(rig, frame, kind, index, value, other)

    def leave(self, page: int, left_ns: int) -> None:
        """End all that a page holds which is gone, after all that it requested ahead."""
        now = self._arrivals.frame_of(left_ns)
        for part, (latest, draws) in self._played.pop(page, {}).items():
            rig, frame = self._rigs[part], max(now, latest)
            self._view.post(rig, frame, LEAVE, FIRST + page * CHANNELS, CHANNELS)
            if draws:
                self._view.post(rig, frame, LIFT)


def permitted(role: str, commands: Any) -> tuple[Any, bool]:
    """The commands that a role may have applied, and whether its own notes are to end.

    A player's silence is that of the player; a player changes how notes are played, but neither
    what the owner holds nor the instrument, the room and the output.
    """
    if role == OWN:
        return commands, False
    if role == LISTEN:
        return commands[:0], False
    kinds, indices = commands[:, 1], commands[:, 2]
    is_stop = kinds == STOP
    is_owner_only = np.isin(kinds, (WRITE, EXPRESS)) & np.isin(indices, OWNER_ONLY)
    return commands[~(is_stop | is_owner_only | (kinds == HOLD))], bool(is_stop.any())
