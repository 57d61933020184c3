"""Lets the sounding note follow the controllers of its channel, through a mapping.

Moves on a channel affect its notes, or all notes (``scope``): while one of them sounds, and
after it until a note of another channel begins.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from yehu_server.params.table import TABLE, find
from yehu_server.playing.binds import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.moves import Moves, NoteMoves
from yehu_server.playing.scope import ChannelRules, Scope
from yehu_server.playing.sources import (
    BEND,
    FINEST,
    NOTE,
    POLY_PRESSURE,
    PRESSURE,
    STEPS,
    VELOCITY,
)
from yehu_server.playing.target_values import TargetValues
from yehu_server.playing.wishes import Key, Wishes

# "Reset all controllers" leaves volume, as the recommended practice RP-015 asks.
KEPT_ON_RESET = {"/playing/volume", "/room/pan"}
# These spring back when the hand lets go; faders and pedals stay where they are.
SPRUNG = (BEND, PRESSURE)
FINE_BITS = 7


@dataclass
class Fader:
    """State of one bind of an OSC address; it belongs to no channel."""

    position: float | None = None
    written: float | None = None  # the value it last gave its target


class Controllers:
    """Writes the values of moved controllers.

    Parameters
    ----------
    start : iterable of (address, value)
        Start values of parameters, over those of the mapping.
    """

    def __init__(
        self,
        wishes: Wishes,
        mapping: Mapping,
        rules: ChannelRules,
        scope: Scope,
        start: Iterable[tuple[str, float]] = (),
    ) -> None:
        self._wishes = wishes
        self._rules = rules
        self._scope = scope
        self._start = dict(start)
        self._moves = Moves()
        self._values = TargetValues(wishes, mapping, self._moves, rules, scope)
        self._faders: defaultdict[Bind, Fader] = defaultdict(Fader)

    @property
    def mapping(self) -> Mapping:
        """The mapping in use; `remap` takes another."""
        return self._values.mapping

    # -- moves -------------------------------------------------------------------------------

    def move(self, source: str, channel: int, position: float, frame: int | None) -> None:
        """Move a source of a channel to a position, 0 to 1."""
        binds = self._receiving(source, channel)
        if not binds:
            return
        self._values.keep_of(source)
        own, move = self._moves[channel], self._moves.to(position)
        for bind in binds:
            if bind.is_soft and self._takes_over(bind, channel, position):
                own.soft[bind] = move
        own.sources[source] = move
        glides = {bind.target: bind.smoothing_ms for bind in binds}
        self.follow(source, channel, frame, glides)

    def move_coarse(self, source: str, channel: int, value: int, frame: int | None) -> None:
        """Move a 14-bit source by its coarse half, 0 to 127; the fine half is set to 0."""
        self.move(source, channel, (value << FINE_BITS) / FINEST, frame)

    def move_fine(self, source: str, channel: int, value: int, frame: int | None) -> None:
        """Set the fine half, 0 to 127, of a source that `move_coarse` moved."""
        move = self._moves[channel].sources.get(source)
        if move is not None:
            coarse = round(move.position * FINEST) >> FINE_BITS
            self.move(source, channel, (coarse << FINE_BITS | value) / FINEST, frame)

    def step(self, source: str, channel: int, steps: int, frame: int | None) -> None:
        """Move a source by 127ths of its range, from its position or that of its target."""
        move = self._moves[channel].sources.get(source)
        binds = self._receiving(source, channel)
        if binds:
            target = binds[0].to_unit(self._wishes.value(binds[0].target))
            position = (target if move is None else move.position) + steps / STEPS
            self.move(source, channel, min(max(position, 0.0), 1.0), frame)

    def _receiving(self, source: str, channel: int) -> list[Bind]:
        """The binds that receive a source on a channel; global ones only if it plays no notes."""
        plays = self._rules.plays(channel)
        binds = self.mapping.of(source)
        return [b for b in binds if b.receives(channel) and (plays or b.is_global)]

    def move_poly_pressure(self, key: Key, position: float, frame: int | None) -> None:
        """Move the aftertouch of one key to a position, 0 to 1."""
        binds = self.mapping.of(POLY_PRESSURE)
        if binds:
            self._moves[key.channel].poly_pressure[key.note] = self._moves.to(position)
            glides = {bind.target: bind.smoothing_ms for bind in binds}
            self.follow(POLY_PRESSURE, key.channel, frame, glides)

    def move_address(self, address: str, argument: float, frame: int | None) -> None:
        """Move the targets of an OSC address, for all channels."""
        for bind in self.mapping.of(address):
            position, fader = bind.input_to_unit(argument), self._faders[bind]
            present = self._wishes.value(bind.target)
            is_waiting = bind.is_soft and present != fader.written
            before, fader.position = fader.position, position
            if not is_waiting or bind.picks_up(position, before, present):
                value = bind.from_unit(position)
                fader.written = self.write(bind.target, value, frame, glide_ms=bind.smoothing_ms)

    def write(
        self, address: str, value: float, frame: int | None, *, glide_ms: float = 0.0
    ) -> float:
        """Set a parameter for all channels, until a controller moves it; see `Wishes.write`."""
        accepted = self._wishes.write(address, value, frame=frame, glide_ms=glide_ms)
        if not find(address).owned:
            self._values.set(address, accepted)
        return accepted

    # -- notes -------------------------------------------------------------------------------

    def begin_note(self, key: Key, velocity: float) -> NoteMoves:
        """Give a note that is about to begin its velocity; return what `cancel_note` needs."""
        before = self._moves[key.channel].begin_note(key.note, self._moves.to(velocity))
        self._values.keep_of(VELOCITY)
        self._values.keep_of(NOTE)
        return before

    def values_of(self, key: Key) -> dict[str, float]:
        """The values of parameters for a note that begins, or sounds again."""
        self._values.last_key = key
        return self._values.of(key.channel, key.note)

    def cancel_note(self, key: Key, before: NoteMoves) -> None:
        """Undo `begin_note` where the instrument does not have the note."""
        self._moves[key.channel].cancel_note(key.note, before)

    # -- forgetting --------------------------------------------------------------------------

    def reset(self, channel: int, frame: int | None) -> None:
        """Act on "reset all controllers"."""
        own = self._moves[channel]
        own.poly_pressure.clear()
        for bind in self.mapping.binds:
            if bind.target not in KEPT_ON_RESET:
                own.sources.pop(bind.source, None)
                own.soft.pop(bind, None)
        for source in self.mapping.sources:
            if source not in (VELOCITY, NOTE):
                self.follow(source, channel, frame)

    def forget(self, channel: int) -> None:
        """Forget all moves on a channel."""
        self._moves.pop(channel)

    def disconnect(self, channel: int, frame: int | None) -> None:
        """Forget the moves on a channel whose port is gone, but keep those for all notes.

        So a loose cable changes nothing, except that wheel and aftertouch spring back.
        """
        own = self._moves.pop(channel)
        for_all = [
            bind
            for bind in self.mapping.binds
            if bind.source in own.sources
            and self._scope.is_for_all(channel, is_global=bind.is_global)
        ]
        kept = [bind for bind in for_all if bind.source not in SPRUNG]
        if kept:
            self._moves.put(channel, own.only(kept))
        for source in SPRUNG:
            if any(bind.source == source for bind in for_all):
                self.follow(source, channel, frame)

    def forget_all(self, frame: int | None) -> None:
        """Forget the moves on all channels; targets go back to where they were before."""
        self._moves.clear()
        for address, value in self._values.written.items():
            self._wishes.write(address, value, frame=frame)

    # -- the mapping -------------------------------------------------------------------------

    def begin(self, frame: int | None) -> None:
        """Set parameters to the start values of the mapping and of the performance."""
        for address, value in self._start_values(self.mapping).items():
            self.write(address, value, frame)

    def positions(self) -> list[tuple[Bind, float | None]]:
        """Each bind, and the position (0 to 1) of its source, if that was ever moved."""
        return [(bind, self._position(bind)) for bind in self.mapping.binds]

    def _position(self, bind: Bind) -> float | None:
        if bind in self._faders:
            return self._faders[bind].position
        return self._moves.position(bind)

    def sound(self) -> dict[str, float]:
        """All parameters that the player does not move, without the velocity of one note."""
        values = {
            param.address: self._wishes.value(param.address) for param in TABLE if not param.owned
        }
        written = self._values.written
        for bind in self.mapping.of(VELOCITY):
            if bind.target in written:
                values[bind.target] = written[bind.target]
        return values

    def remap(self, mapping: Mapping, frame: int | None) -> None:
        """Take another mapping; moves stay where their source is still bound.

        A parameter whose start value differs takes the new one, unless it was moved since.
        """
        before = self.mapping
        self._moves.remap(before, mapping)
        start, new_start = self._start_values(before), self._start_values(mapping)
        changed = self._values.remap(mapping, start, new_start)
        key = self._values.last_key
        if key is not None:
            changed = self._values.of(key.channel, key.note)
        for address, value in changed.items():
            self._wishes.write(address, value, frame=frame)

    def _start_values(self, mapping: Mapping) -> dict[str, float]:
        return dict(mapping.start) | self._start

    # -- the sounding note -------------------------------------------------------------------

    def follow(
        self, source: str, channel: int, frame: int | None, glides: dict[str, float] | None = None
    ) -> None:
        """Write the targets of a source that was moved on a channel; `glides` in ms, by target."""
        self._values.keep_of(source)
        sounding = self._wishes.all_sounding
        keys: list[Key | None] = [*sounding] or [self._values.last_key]
        for key in keys:
            self._follow(source, channel, frame, glides, key, len(sounding) > 1)

    def _follow(
        self,
        source: str,
        channel: int,
        frame: int | None,
        glides: dict[str, float] | None,
        key: Key | None,
        is_divided: bool,
    ) -> None:
        """Write the targets of a moved source as a key has them; to its players, if divided."""
        binds = self.mapping.of(source)
        if key is not None:
            binds = tuple(bind for bind in binds if self._values.is_for(bind, channel, key))
        if binds:
            values = self._values.of(key.channel if key else channel, key.note if key else -1)
        for bind in binds:
            glide_ms = (glides or {}).get(bind.target, 0.0)
            value = values[bind.target]
            only = key if is_divided else None
            self._wishes.write(bind.target, value, frame=frame, glide_ms=glide_ms, key=only)

    def _takes_over(self, bind: Bind, channel: int, position: float) -> bool:
        """Whether a soft bind moves its target: it set its present value, or reaches it now."""
        own = self._moves[channel]
        key = self._wishes.sounding or self._values.last_key
        if key is None or not self._values.is_for(bind, channel, key):
            key = Key(channel, -1)
        present = self._values.of(key.channel, key.note)[bind.target]
        soft, move = own.soft.get(bind), own.sources.get(bind.source)
        if soft is not None and bind.from_unit(soft.position) == present:
            return True
        return bind.picks_up(position, None if move is None else move.position, present)
