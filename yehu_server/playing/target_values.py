"""The values that a mapping gives its targets, for each note.

Of several sources of one target the one moved last counts; a direct write counts as a move. Moves
on a channel affect the notes of that channel, or all notes (``scope``).
"""

from __future__ import annotations

from typing import NamedTuple

from yehu_server.params.table import find
from yehu_server.playing.binds import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.moves import Moves
from yehu_server.playing.scope import ChannelRules, Scope
from yehu_server.playing.sources import BEND, VELOCITY
from yehu_server.playing.wishes import Key, Wishes


class Written(NamedTuple):
    """A value of a target, and the number of the move or write it comes from; 0: from none."""

    number: int
    value: float


class TargetValues:
    """Computes the values of targets from moves and direct writes.

    Attributes
    ----------
    mapping : Mapping
        The mapping in use.
    last_key : Key, optional
        The key whose note sounds, or sounded last.
    """

    def __init__(
        self,
        wishes: Wishes,
        mapping: Mapping,
        moves: Moves,
        rules: ChannelRules,
        scope: Scope,
    ) -> None:
        self._wishes = wishes
        self.mapping = mapping
        self._moves = moves
        self._rules = rules
        self._scope = scope
        self.last_key: Key | None = None
        # Targets as `set` left them, or as they were before their first move.
        self._written: dict[str, Written] = {}

    def set(self, address: str, value: float) -> None:
        """Record a direct write."""
        self._written[address] = Written(self._moves.next_number(), value)

    def keep_of(self, source: str) -> None:
        """Record the present values of a source's targets, before its first move."""
        for bind in self.mapping.of(source):
            self._keep(bind.target)

    def _keep(self, address: str) -> None:
        self._written.setdefault(address, Written(0, self._wishes.value(address)))

    @property
    def written(self) -> dict[str, float]:
        """The values of targets without any moves."""
        return {address: written.value for address, written in self._written.items()}

    def remap(
        self, mapping: Mapping, before: dict[str, float], after: dict[str, float]
    ) -> dict[str, float]:
        """Take another mapping; return the start values that now apply.

        Those are the ones that differ between the two mappings (`before` and `after`), of
        parameters that still have the old one.
        """
        self.mapping = mapping
        for bind in mapping.binds:
            self._keep(bind.target)
        changed = {}
        for address in before | after:
            default = find(address).default
            old, new = before.get(address, default), after.get(address, default)
            now = self._written.get(address, Written(0, self._wishes.value(address))).value
            if old != new and now == old:
                # Number 0: moves made before still count.
                self._written[address] = Written(0, new)
                changed[address] = new
        return changed

    def is_for(self, bind: Bind, channel: int, key: Key) -> bool:
        """Whether a bind's moves on a channel affect the note of a key."""
        own = channel in (key.channel, self._rules.master(key.channel))
        return own or self._scope.is_for_all(channel, is_global=bind.is_global)

    def of(self, channel: int, note: float) -> dict[str, float]:
        """The values of all targets that were ever moved, for a note of a channel.

        The latest counts of the write to a target, the channel's own moves, and the moves for
        all notes. A note in an MPE zone has its master's moves where its channel has none.
        Bends add up: that of the note's channel, of the master, and for all notes.
        """
        values = dict(self._written)
        master = self._rules.master(channel)
        for_all = self._channels_for_all(channel)
        for bind in self.mapping.binds:
            move = self._moves.of(bind, channel, note)
            if move is None and master is not None:
                move = self._moves.of(bind, master, note)
            other, other_channel = self._moves.latest(bind, for_all[bind.is_global])
            if other is not None and (move is None or move < other):
                move = other
            if move is None or move.number < values.get(bind.target, (0, 0.0))[0]:
                continue
            value = bind.from_unit(move.position)
            if bind.source == VELOCITY:
                value *= self._velocity_factor(bind.target)
            elif bind.is_by_range:
                value = self._bend(bind, channel)
                for each in dict.fromkeys((master, other_channel)):
                    value += 0.0 if each is None else self._bend(bind, each)
            values[bind.target] = Written(move.number, value)
        return {address: written.value for address, written in values.items()}

    def _channels_for_all(self, channel: int) -> dict[bool, list[int]]:
        """Other channels whose moves are for all notes, by whether the bind is global."""
        if self.last_key is None:  # each move applies as it comes; the first note sees them all
            return {False: [], True: []}
        others = [other for other in self._moves.channels if other != channel]
        return {
            is_global: [c for c in others if self._scope.is_for_all(c, is_global=is_global)]
            for is_global in ((False, True) if self.mapping.has_global else (False,))
        }

    def _velocity_factor(self, target: str) -> float:
        """Ratio of a target's written value to its start value.

        Velocity comes with every note: without this factor a preset's value would last only
        until the next note.
        """
        start = dict(self.mapping.start).get(target, find(target).default)
        return self._written[target].value / start if start > 0.0 else 1.0

    def _bend(self, bind: Bind, channel: int) -> float:
        """Bend of a channel (semitones)."""
        if not bind.receives(channel):
            return 0.0
        move = self._moves[channel].sources.get(BEND)
        position = 0.5 if move is None else move.position
        return bind.semitones(position, self._rules.bend_range(channel))
