"""Where each source was last moved to, on each channel."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import NamedTuple

from yehu_server.playing.binds import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.sources import NOTE, OF_ONE_NOTE, POLY_PRESSURE, STEPS, VELOCITY


class Move(NamedTuple):
    """One move: its running number, by which the later of two counts, and its position, 0 to 1."""

    number: int
    position: float


# Velocity and poly pressure of a note that had this key before.
NoteMoves = tuple[Move | None, Move | None]


@dataclass
class ChannelMoves:
    """The last moves on one channel."""

    sources: dict[str, Move] = field(default_factory=dict)
    soft: dict[Bind, Move] = field(default_factory=dict)  # that soft binds have acted on
    poly_pressure: dict[float, Move] = field(default_factory=dict)  # by note
    velocity: dict[float, Move] = field(default_factory=dict)  # by note

    def of(self, bind: Bind, note: float) -> Move | None:
        """The move that a bind acts on, for a note."""
        if bind.source == POLY_PRESSURE:
            return self.poly_pressure.get(note)
        if bind.source in (VELOCITY, NOTE):
            struck = self.velocity.get(note)
            return Move(struck.number, note / STEPS) if struck and bind.source == NOTE else struck
        return self.soft.get(bind) if bind.is_soft else self.sources.get(bind.source)

    def of_any_note(self, bind: Bind) -> list[Move]:
        """The moves of a bind's source, of all notes."""
        if bind.source == POLY_PRESSURE:
            return list(self.poly_pressure.values())
        if bind.source == VELOCITY:
            return list(self.velocity.values())
        if bind.source == NOTE:
            struck = self.velocity.items()
            return [Move(move.number, note / STEPS) for note, move in struck]
        return [self.sources[bind.source]] if bind.source in self.sources else []

    def begin_note(self, note: float, velocity: Move) -> NoteMoves:
        """Give a new note its velocity; return what `cancel_note` needs."""
        before = self.velocity.get(note), self.poly_pressure.pop(note, None)
        self.velocity[note] = velocity
        return before

    def cancel_note(self, note: float, before: NoteMoves) -> None:
        """Undo `begin_note`."""
        for moves, move in zip((self.velocity, self.poly_pressure), before, strict=True):
            if move is None:
                moves.pop(note, None)
            else:
                moves[note] = move

    def only(self, binds: Iterable[Bind]) -> ChannelMoves:
        """The moves of the sources of some binds."""
        binds = list(binds)
        return ChannelMoves(
            sources={bind.source: self.sources[bind.source] for bind in binds},
            soft={bind: self.soft[bind] for bind in binds if bind in self.soft},
        )

    def remap(self, before: Mapping, after: Mapping) -> None:
        """Keep the moves of sources that another mapping binds too."""
        self.soft = self._soft_of(before, after)
        self.sources = {source: move for source, move in self.sources.items() if after.of(source)}
        if not after.of(POLY_PRESSURE):
            self.poly_pressure.clear()

    def _soft_of(self, before: Mapping, after: Mapping) -> dict[Bind, Move]:
        """Moves of the new soft binds, where their source moved the same target before."""
        found = {}
        for bind in after.binds:
            for old in before.of(bind.source) if bind.is_soft else ():
                move = self.soft.get(old) if old.is_soft else self.sources.get(old.source)
                if old.target == bind.target and move is not None:
                    found[bind] = move
        return found


class Moves:
    """The last moves on all channels, counted from 0 over all ports."""

    def __init__(self) -> None:
        self._channels: defaultdict[int, ChannelMoves] = defaultdict(ChannelMoves)
        self._count = 0

    def __getitem__(self, channel: int) -> ChannelMoves:
        return self._channels[channel]

    @property
    def channels(self) -> list[int]:
        """The channels on which something was moved."""
        return list(self._channels)

    def next_number(self) -> int:
        """The number of a new move, or of a direct write."""
        self._count += 1
        return self._count

    def to(self, position: float) -> Move:
        """A new move."""
        return Move(self.next_number(), position)

    def of(self, bind: Bind, channel: int, note: float) -> Move | None:
        """The move that a bind acts on, for a note of a channel."""
        return self._channels[channel].of(bind, note) if bind.receives(channel) else None

    def latest(self, bind: Bind, channels: Iterable[int]) -> tuple[Move, int] | tuple[None, None]:
        """The latest move that a bind acts on, of some channels, and its channel."""
        if bind.source in OF_ONE_NOTE:
            return None, None
        moves = [(move, c) for c in channels if (move := self.of(bind, c, -1)) is not None]
        return max(moves, default=(None, None))

    def position(self, bind: Bind) -> float | None:
        """Where a bind's source was last moved to, on any channel that the bind receives."""
        moves = [
            move
            for channel, own in self._channels.items()
            if bind.receives(channel)
            for move in own.of_any_note(bind)
        ]
        return max(moves).position if moves else None

    def pop(self, channel: int) -> ChannelMoves:
        """Forget the moves of a channel; return them."""
        return self._channels.pop(channel, ChannelMoves())

    def put(self, channel: int, moves: ChannelMoves) -> None:
        """Give a channel other moves."""
        self._channels[channel] = moves

    def clear(self) -> None:
        """Forget all moves."""
        self._channels.clear()

    def remap(self, before: Mapping, after: Mapping) -> None:
        """See `ChannelMoves.remap`."""
        for own in self._channels.values():
            own.remap(before, after)
