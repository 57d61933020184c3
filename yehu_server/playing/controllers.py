"""What was moved, on which channel, and what that asks of the player's parameters.

Of several sources of one target the one moved last counts, a direct write among them. What
is moved on a channel belongs to its notes, unless it is for all (``scope``): it is heard while
one of them sounds, and after it until another channel's note begins.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field

from yehu_server.params.table import TABLE, find
from yehu_server.playing.binds import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.performer import Key, Performer
from yehu_server.playing.scope import Channels, Scope
from yehu_server.playing.sources import (
    BEND,
    FINEST,
    NOTE,
    OF_ONE_NOTE,
    POLY_PRESSURE,
    PRESSURE,
    STEPS,
    VELOCITY,
)

# Put back by "reset all controllers"; volume stays, as the recommended practice RP-015 asks.
KEPT_ON_RESET = {"/playing/volume"}
# These go back by themselves when the hand is gone; faders and pedals stay where they are.
SPRUNG = (BEND, PRESSURE)
FINE_BITS = 7

# When something was moved, as a running number, and to where: 0 to 1.
Moved = tuple[int, float]
# What a note had that `Controllers.strike` changed: its velocity and its pressure.
Struck = tuple[Moved | None, Moved | None]


@dataclass
class Moves:
    """What was moved on one channel."""

    moved: dict[str, Moved] = field(default_factory=dict)  # by source
    picked: dict[Bind, Moved] = field(default_factory=dict)  # what soft binds made of it
    touch: dict[float, Moved] = field(default_factory=dict)  # poly pressure, by note
    velocity: dict[float, Moved] = field(default_factory=dict)  # by note


@dataclass
class Fader:
    """What one bind of an OSC address has done; it belongs to no channel."""

    place: float | None = None
    put: float | None = None  # the value it gave its target


class Controllers:
    """Lets a performer follow what is moved, through a mapping."""

    def __init__(
        self,
        performer: Performer,
        mapping: Mapping,
        channels: Channels,
        scope: Scope,
        start: Iterable[tuple[str, float]] = (),
    ) -> None:
        self._performer = performer
        performer.expression = self._expression
        self.mapping = mapping
        self._rules = channels
        self._scope = scope
        self._start = dict(start)
        self._channels: defaultdict[int, Moves] = defaultdict(Moves)
        self._faders: defaultdict[Bind, Fader] = defaultdict(Fader)
        self._heard: Key | None = None  # whose note sounds, or sounded last
        self._set: dict[str, Moved] = {}  # targets as they were before, or as `write` left them
        self._moves = 0

    # -- what is moved -----------------------------------------------------------------------

    def move(self, source: str, channel: int, place: float, frame: int | None) -> None:
        """Move a source of a channel to a place, 0 to 1."""
        binds = self._hearing(source, channel)
        if not binds:
            return
        self._remember(source)
        state, stamped = self._channels[channel], self._stamped(place)
        for bind in binds:
            if bind.is_soft and self._may_move(bind, channel, place):
                state.picked[bind] = stamped
        state.moved[source] = stamped
        glides = {bind.target: bind.smoothing_ms for bind in binds}
        self.follow(source, channel, frame, glides)

    def move_coarse(self, source: str, channel: int, value: int, frame: int | None) -> None:
        """Move a source of 14 bits by its coarse half, 0 to 127; the fine one is then 0."""
        self.move(source, channel, (value << FINE_BITS) / FINEST, frame)

    def move_fine(self, source: str, channel: int, value: int, frame: int | None) -> None:
        """Refine what `move_coarse` did, by 0 to 127."""
        moved = self._channels[channel].moved.get(source)
        if moved is not None:
            coarse = round(moved[1] * FINEST) >> FINE_BITS
            self.move(source, channel, (coarse << FINE_BITS | value) / FINEST, frame)

    def step(self, source: str, channel: int, steps: int, frame: int | None) -> None:
        """Move a source by 127ths of its way, from where it is, or where its target is."""
        moved = self._channels[channel].moved.get(source)
        binds = self._hearing(source, channel)
        if binds:
            at = binds[0].place_of(self._performer.value(binds[0].target))
            place = (at if moved is None else moved[1]) + steps / STEPS
            self.move(source, channel, min(max(place, 0.0), 1.0), frame)

    def _hearing(self, source: str, channel: int) -> list[Bind]:
        """The binds of a source that hear it on a channel: of one without notes, global ones."""
        plays = self._rules.plays(channel)
        binds = self.mapping.of(source)
        return [b for b in binds if b.hears(channel) and (plays or b.is_global)]

    def touch(self, key: Key, place: float, frame: int | None) -> None:
        """Press one key of a channel."""
        if self.mapping.of(POLY_PRESSURE):
            self._channels[key.channel].touch[key.note] = self._stamped(place)
            glides = {bind.target: bind.smoothing_ms for bind in self.mapping.of(POLY_PRESSURE)}
            self.follow(POLY_PRESSURE, key.channel, frame, glides)

    def move_address(self, address: str, argument: float, frame: int | None) -> None:
        """Move what an OSC address is bound to, for all channels."""
        for bind in self.mapping.of(address):
            place, fader = bind.place(argument), self._faders[bind]
            present = self._performer.value(bind.target)
            waits = bind.is_soft and present != fader.put
            before, fader.place = fader.place, place
            if not waits or bind.meets(place, before, present):
                value = bind.apply(place)
                fader.put = self.write(bind.target, value, frame, glide_ms=bind.smoothing_ms)

    def write(
        self, address: str, value: float, frame: int | None, *, glide_ms: float = 0.0
    ) -> float:
        """Set a parameter for all channels, until a controller moves it; see `Performer.write`."""
        accepted = self._performer.write(address, value, frame=frame, glide_ms=glide_ms)
        if not find(address).owned:
            self._set[address] = self._stamped(accepted)
        return accepted

    # -- notes -------------------------------------------------------------------------------

    def strike(self, key: Key, velocity: float) -> Struck:
        """A note is about to begin; return what `unstrike` needs if it does not."""
        state = self._channels[key.channel]
        before = state.velocity.get(key.note), state.touch.pop(key.note, None)
        state.velocity[key.note] = self._stamped(velocity)
        self._remember(VELOCITY)
        self._remember(NOTE)
        return before

    def unstrike(self, key: Key, struck: Struck) -> None:
        """It was not a note of this instrument: what was heard goes on."""
        state = self._channels[key.channel]
        for moved, before in zip((state.velocity, state.touch), struck, strict=True):
            if before is None:
                moved.pop(key.note, None)
            else:
                moved[key.note] = before

    # -- forgetting --------------------------------------------------------------------------

    def reset(self, channel: int, frame: int | None) -> None:
        """Act on "reset all controllers"."""
        state = self._channels[channel]
        state.touch.clear()
        for bind in self.mapping.binds:
            if bind.target not in KEPT_ON_RESET:
                state.moved.pop(bind.source, None)
                state.picked.pop(bind, None)
        for source in self.mapping.sources:
            if source not in (VELOCITY, NOTE):
                self.follow(source, channel, frame)

    def forget(self, channel: int) -> None:
        """Forget what was moved on a channel."""
        self._channels.pop(channel, None)

    def leave(self, channel: int, frame: int | None) -> None:
        """Forget what was moved on a channel that is gone, but for what is for all notes.

        So a loose cable changes nothing; only what springs back does so.
        """
        state = self._channels.pop(channel, Moves())
        for_all = [
            bind
            for bind in self.mapping.binds
            if bind.source in state.moved
            and self._scope.is_for_all(channel, is_global=bind.is_global)
        ]
        stays = [bind for bind in for_all if bind.source not in SPRUNG]
        if stays:
            self._channels[channel] = Moves(
                moved={bind.source: state.moved[bind.source] for bind in stays},
                picked={bind: state.picked[bind] for bind in stays if bind in state.picked},
            )
        for source in SPRUNG:
            if any(bind.source == source for bind in for_all):
                self.follow(source, channel, frame)

    def start_anew(self, frame: int | None) -> None:
        """Forget what was moved on all of them; targets are where they were before."""
        self._channels.clear()
        for address, (_, value) in self._set.items():
            self._performer.write(address, value, frame=frame)

    def begin(self, frame: int | None) -> None:
        """Put parameters to where the mapping begins, and then to where the performance does."""
        for address, value in self._beginning(self.mapping).items():
            self.write(address, value, frame)

    def places(self) -> list[tuple[Bind, float | None]]:
        """Each bind, and where its source was last moved to (0 to 1), if it was."""
        return [(bind, self._place(bind)) for bind in self.mapping.binds]

    def _place(self, bind: Bind) -> float | None:
        if bind in self._faders:
            return self._faders[bind].place
        moved: list[Moved] = []
        for channel, state in self._channels.items():
            if not bind.hears(channel):
                continue
            if bind.source == POLY_PRESSURE:
                moved += state.touch.values()
            elif bind.source == VELOCITY:
                moved += state.velocity.values()
            elif bind.source == NOTE:
                moved += [(when, note / STEPS) for note, (when, _) in state.velocity.items()]
            elif bind.source in state.moved:
                moved.append(state.moved[bind.source])
        return max(moved)[1] if moved else None

    def sound(self) -> dict[str, float]:
        """All that the player does not move, without what velocity does for one note."""
        values = {
            param.address: self._performer.value(param.address)
            for param in TABLE
            if not param.owned
        }
        for bind in self.mapping.of(VELOCITY):
            if bind.target in self._set:
                _, values[bind.target] = self._set[bind.target]
        return values

    def remap(self, mapping: Mapping, frame: int | None) -> None:
        """Take another mapping; what was moved stays moved where its source is still bound.

        Parameters are put to where the new one begins where that is elsewhere, and nobody
        has moved them since.
        """
        before, self.mapping = self.mapping, mapping
        for state in self._channels.values():
            state.picked = _picked_still(state, before, mapping)
            state.moved = {s: moved for s, moved in state.moved.items() if mapping.of(s)}
            if not mapping.of(POLY_PRESSURE):
                state.touch.clear()
        for bind in mapping.binds:
            self._set.setdefault(bind.target, (0, self._performer.value(bind.target)))
        was, begins, elsewhere = self._beginning(before), self._beginning(mapping), {}
        for address in was | begins:
            default = find(address).default
            old, new = was.get(address, default), begins.get(address, default)
            _, now = self._set.get(address, (0, self._performer.value(address)))
            if old != new and now == old:
                # Stamped as of old: what a controller has moved stays with it.
                self._set[address] = (0, new)
                elsewhere[address] = new
        if self._heard is not None:
            elsewhere = self._asked(self._heard.channel, self._heard.note)
        for address, value in elsewhere.items():
            self._performer.write(address, value, frame=frame)

    def _beginning(self, mapping: Mapping) -> dict[str, float]:
        return dict(mapping.start) | self._start

    # -- what follows ------------------------------------------------------------------------

    def follow(
        self, source: str, channel: int, frame: int | None, glides: dict[str, float] | None = None
    ) -> None:
        """Let the sounding note follow what its channel just did; `glides` are in ms, by target."""
        self._remember(source)
        heard = self._performer.sounding or self._heard
        binds = self.mapping.of(source)
        if heard is not None:
            binds = tuple(bind for bind in binds if self._is_for(bind, channel, heard))
        if binds:
            asked = self._asked(heard.channel if heard else channel, heard.note if heard else -1)
        for bind in binds:
            glide_ms = (glides or {}).get(bind.target, 0.0)
            value = asked[bind.target]
            self._performer.write(bind.target, value, frame=frame, glide_ms=glide_ms)

    def _is_for(self, bind: Bind, channel: int, key: Key) -> bool:
        """Whether what a bind moves on a channel is heard in a note."""
        own = channel in (key.channel, self._rules.master(key.channel))
        return own or self._scope.is_for_all(channel, is_global=bind.is_global)

    def _expression(self, key: Key) -> dict[str, float]:
        """What a note that begins, or comes back, is to have of its channel."""
        self._heard = key
        return self._asked(key.channel, key.note)

    def _asked(self, channel: int, note: float) -> dict[str, float]:
        """Values of all targets that were ever moved, for a note of this channel.

        Where this channel moved none, the target is as it was before any channel did. A note
        in an MPE zone has its master's bend besides its own, and its master's other moves
        where it has none of its own. Of what was moved for all notes and what is its own it
        has the later, but bends add up.
        """
        asked = dict(self._set)
        master = self._rules.master(channel)
        for_all = self._for_all(channel)
        for bind in self.mapping.binds:
            moved = self._moved(bind, channel, note)
            if moved is None and master is not None:
                moved = self._moved(bind, master, note)
            elsewhere, elsewhere_on = self._latest(bind, for_all[bind.is_global])
            if elsewhere is not None and (moved is None or moved < elsewhere):
                moved = elsewhere
            if moved is None or moved[0] < asked.get(bind.target, (0, 0.0))[0]:
                continue
            when, place = moved
            value = bind.apply(place)
            if bind.source == VELOCITY:
                value *= self._share(bind.target)
            elif bind.is_by_range:
                value = self._bend(bind, channel)
                for other in {master, elsewhere_on}:
                    value += 0.0 if other is None else self._bend(bind, other)
            asked[bind.target] = (when, value)
        return {address: value for address, (_, value) in asked.items()}

    def _for_all(self, channel: int) -> dict[bool, list[int]]:
        """Other channels whose moves are for all notes, by whether the bind is global."""
        if self._heard is None:  # each is heard as it comes, and the first note asks for all
            return {False: [], True: []}
        others = [other for other in self._channels if other != channel]
        return {
            is_global: [c for c in others if self._scope.is_for_all(c, is_global=is_global)]
            for is_global in ((False, True) if self.mapping.has_global else (False,))
        }

    def _latest(self, bind: Bind, channels: list[int]) -> tuple[Moved, int] | tuple[None, None]:
        """What a bind last made of some channels' moves, and on which of them."""
        if not channels or bind.source in OF_ONE_NOTE:
            return None, None
        moved = [(moved, c) for c in channels if (moved := self._moved(bind, c, -1)) is not None]
        return max(moved, default=(None, None))

    def _share(self, target: str) -> float:
        """How far a target was put from where its mapping begins, as a factor.

        Velocity comes with every note: it is spread around what was put, or no preset would
        outlast the next note.
        """
        usual = dict(self.mapping.start).get(target, find(target).default)
        return self._set[target][1] / usual if usual > 0.0 else 1.0

    def _moved(self, bind: Bind, channel: int, note: float) -> Moved | None:
        if not bind.hears(channel):
            return None
        state = self._channels[channel]
        if bind.source == POLY_PRESSURE:
            return state.touch.get(note)
        if bind.source in (VELOCITY, NOTE):
            struck = state.velocity.get(note)
            return (struck[0], note / STEPS) if struck and bind.source == NOTE else struck
        return state.picked.get(bind) if bind.is_soft else state.moved.get(bind.source)

    def _bend(self, bind: Bind, channel: int) -> float:
        """Bend of a channel (semitones)."""
        if not bind.hears(channel):
            return 0.0
        _, place = self._channels[channel].moved.get(BEND, (0, 0.5))
        return bind.semitones(place, self._rules.bend_range(channel))

    # -- soft take-over ----------------------------------------------------------------------

    def _may_move(self, bind: Bind, channel: int, place: float) -> bool:
        """Whether a soft bind has its target: it put it where it is, or comes to it now."""
        state = self._channels[channel]
        heard = self._performer.sounding or self._heard
        own = Key(channel, -1) if heard is None or not self._is_for(bind, channel, heard) else heard
        present = self._asked(own.channel, own.note)[bind.target]
        picked, moved = state.picked.get(bind), state.moved.get(bind.source)
        if picked is not None and bind.apply(picked[1]) == present:
            return True
        return bind.meets(place, None if moved is None else moved[1], present)

    # -- what is kept ------------------------------------------------------------------------

    def _stamped(self, place: float) -> Moved:
        self._moves += 1
        return self._moves, place

    def _remember(self, source: str) -> None:
        for bind in self.mapping.of(source):
            self._set.setdefault(bind.target, (0, self._performer.value(bind.target)))


def _picked_still(state: Moves, before: Mapping, after: Mapping) -> dict[Bind, Moved]:
    """What soft binds have of their sources, where these moved the same target before."""
    picked = {}
    for bind in after.binds:
        for was in before.of(bind.source) if bind.is_soft else ():
            moved = state.picked.get(was) if was.is_soft else state.moved.get(was.source)
            if was.target == bind.target and moved is not None:
                picked[bind] = moved
    return picked
