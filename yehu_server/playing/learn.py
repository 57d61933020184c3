"""MIDI learn: detect which source the user moves, and keep its bind in a mapping file."""

import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

import mido

from yehu_server.compile.cache_folder import data_folder
from yehu_server.core.midi.registered_parameters import DATA_ENTRY, NRPN_FINE, RPN_FINE
from yehu_server.core.midi.registered_parameters import NRPN_COARSE as NRPN
from yehu_server.core.midi.registered_parameters import RPN_COARSE as RPN
from yehu_server.errors import MappingError
from yehu_server.params.table import find
from yehu_server.playing import sources
from yehu_server.playing.bind import Bind, override_key
from yehu_server.playing.mapping import (
    Mapping,
    load,
    mapping_folder,
    shipped_mappings,
    user_folder,
    with_bases,
)
from yehu_server.playing.mapping_file import MappingFile, read_mapping_file, settable_param, text_of
from yehu_server.playing.mapping_writer import as_toml, edited
from yehu_server.playing.sources import COARSE, FINE_ABOVE, OF_ONE_NOTE, RESERVED, STEPS, is_address
from yehu_server.util.files import write_text
from yehu_server.util.processes import machine_lock

# How far a source has to move, 0 to 1: pedals and breath sensors are noisy at rest.
DISTANCE = 1.0 / 16.0
FULL = (1.0, float(STEPS), 255.0, 1023.0, 16383.0)  # where ranges of OSC addresses end
STILL_S = 2.0  # after which what was just learned may be learned again
PRESSURES = {"aftertouch": sources.PRESSURE, "polytouch": sources.POLY_PRESSURE}
LOCK = "learned"  # another server may learn at the same time
AT_REST = {sources.BEND: 0.5, sources.PRESSURE: 0.0, sources.POLY_PRESSURE: 0.0}


@dataclass(frozen=True)
class LearnedSource:
    """A source that was moved; of an OSC address also the range of its values."""

    source: str
    input_range: tuple[float, float] = (0.0, 1.0)
    part: int = 0  # of an address: as of `Bind`

    def __str__(self) -> str:
        """The source, with the range of its values where that is not 0 to 1."""
        lo, hi = self.input_range
        return self.source if (lo, hi) == (0.0, 1.0) else f"{self.source} ({lo:g} to {hi:g})"


@dataclass
class _Channel:
    """The control changes received on one channel."""

    before: int | None = None  # the control change before
    nrpn: list[int | None] = field(default_factory=lambda: [None, None])


class Learner:
    """Compares each source with where it began, until one has moved far enough to be meant.

    `before`: the source that was learned before, and when it moved last (monotonic s). It is
    ignored until it has been still: one sweep of a fader is meant for one parameter.
    """

    def __init__(self, before: tuple[str, float] = ("", 0.0)) -> None:
        self._before, self._moved_s = before
        self._began_at: dict[tuple[int, str], float] = {}
        self._ends: dict[str, tuple[float, float]] = {}  # lowest and highest value, by address
        self._channels: dict[int, _Channel] = {}
        self._pairs: set[tuple[int, int]] = set()  # channel, coarse half

    def hear(self, message: mido.Message, port: int = 0) -> LearnedSource | None:
        """Receive a MIDI message; return the source, once one has moved far enough."""
        if not hasattr(message, "channel"):
            return None
        channel = sources.CHANNELS * port + message.channel
        if message.type == "pitchwheel":
            return self._moved(channel, sources.BEND, (message.pitch + 8192) / 16383.0)
        if message.type in PRESSURES:
            return self._moved(channel, PRESSURES[message.type], message.value / STEPS)
        if message.type == "control_change":
            return self._control(channel, message.control, message.value)
        return None

    def learn_from_address(self, address: str, argument: float) -> LearnedSource | None:
        """Receive a number at an OSC address of the user's own; return as `hear` does.

        Its range ends at the next of FULL beyond its values, and begins as far below 0 where one is
        below 0. A step from 0 to 1 may be the first of 127, so it counts with the value after it: a
        button's 0, or the next of a fader.
        """
        if self._still_moves(address):
            return None
        lowest, highest = self._ends.get(address, (argument, argument))
        lowest, highest = ends = min(lowest, argument), max(highest, argument)
        self._ends[address] = ends
        farthest = max(abs(lowest), abs(highest))
        full = next((end for end in FULL if farthest <= end), farthest)
        least = -full if lowest < 0.0 else 0.0
        if highest - lowest < DISTANCE * (full - least) or (*ends, argument) == (0.0, 1.0, 1.0):
            return None
        return LearnedSource(address, (least, full))

    def _control(self, channel: int, control: int, value: int) -> LearnedSource | None:
        state = self._channels.setdefault(channel, _Channel())
        before, state.before = state.before, control
        if control in (NRPN, NRPN_FINE):
            state.nrpn[control == NRPN_FINE] = value
        elif control in (RPN, RPN_FINE):
            state.nrpn = [None, None]
        elif control == DATA_ENTRY and None not in state.nrpn:
            coarse, fine = (half or 0 for half in state.nrpn)
            number = coarse << 7 | fine
            if number < sources.NO_NRPN:
                return self._moved(channel, sources.nrpn(number), value / STEPS)
        if control in RESERVED:
            return None
        if control - FINE_ABOVE in COARSE:
            if before == control - FINE_ABOVE:
                self._pairs.add((channel, before))
            if (channel, control - FINE_ABOVE) in self._pairs:
                return None  # the fine half of a pair
        found = self._moved(channel, sources.control(control), value / STEPS)
        if found is not None and (channel, control) in self._pairs:
            return LearnedSource(sources.pair(control))
        return found

    def _moved(self, channel: int, source: str, position: float) -> LearnedSource | None:
        if self._still_moves(source):
            return None
        began = self._began_at.setdefault((channel, source), AT_REST.get(source, position))
        return LearnedSource(source) if abs(position - began) >= DISTANCE else None

    def _still_moves(self, source: str) -> bool:
        """Whether a source is the one learned before, and has not been still since."""
        if source != self._before:
            return False
        now = time.monotonic()
        is_still, self._moved_s = now - self._moved_s >= STILL_S, now
        if is_still:
            self._before = ""
        return not is_still


class Learning:
    """Waits for the source that the user moves next; any thread may call."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._learner = Learner()
        self._found: Callable[[LearnedSource], None] | None = None
        self._last = ("", 0.0)  # the source learned last, and when
        self.on_change: Callable[[], None] = lambda: None  # called where `waits` changes

    @property
    def waits(self) -> bool:
        """Whether it waits for a source to move."""
        return self._found is not None

    def expects(self, address: str) -> bool:
        """Whether it waits for a source to move, or has just learned this one."""
        source, learned_s = self._last
        return self.waits or (source == address and time.monotonic() - learned_s < STILL_S)

    def listen(self, found: Callable[[LearnedSource], None] | None) -> None:
        """Call `found`, which must not block, once with the source moved next; None: stop."""
        with self._lock:
            self._learner, self._found = Learner(self._last), found
        self.on_change()

    def hear_address(self, address: str, argument: float) -> None:
        """Receive a number at an OSC address of the user's own."""
        with self._lock:
            source = self._learner.learn_from_address(address, argument)
        self._report(source)

    def hear_message(self, message: mido.Message, port: int) -> None:
        """Receive a MIDI message of a port, counted from 0; it plays elsewhere."""
        with self._lock:
            source = self._learner.hear(message, port)
        self._report(source)

    def _report(self, source: LearnedSource | None) -> None:
        with self._lock:
            found = self._found if source is not None else None
            self._found = None if found is not None else self._found
            if source is not None and found is not None:
                self._last = (sources.controller(source.source), time.monotonic())
        if source is not None and found is not None:
            found(source)
            self.on_change()


def own_file(mapping: Mapping) -> Path:
    """The file of learned binds: the mapping's own, or the user's copy; raises MappingError."""
    if not mapping.files:
        raise MappingError(f"the mapping {mapping.name} comes from no file")
    own = mapping.files[0]
    is_shipped = own.parent.resolve() == mapping_folder().resolve()
    return user_folder() / own.name if is_shipped else own


def current(mapping: Mapping) -> Mapping:
    """A mapping as its file of learned binds has it now: another server may have changed it."""
    path = own_file(mapping)
    if not path.exists():
        return mapping
    # `--mpe` is in no file.
    return replace(with_bases(path, read_mapping_file(path)), mpe=mapping.mpe)


def learn(
    mapping: Mapping, target: str, found: LearnedSource, *, soft: bool, only: bool = False
) -> tuple[Mapping, Path]:
    """Bind a source to a target, over its whole range, and save the bind.

    It moves the target for all notes, on whichever device they are played, beside the sources that
    did so before, or with `only` in their place. It replaces all other binds of its source. What it
    replaces in the user's file is kept with it, for `unlearn`.
    Returns the mapping with the bind, and the file that it was saved to. Raises MappingError where
    the file is wrong or cannot be written; nothing is changed then.
    """
    param = settable_param(target, "learn one")
    bind = Bind(
        found.source,
        param.address,
        curve=param.curve,
        input_range=found.input_range,
        part=found.part,
        is_soft=soft and found.source not in OF_ONE_NOTE,
        is_exclusive=only,
        is_global=not (found.source in OF_ONE_NOTE or is_address(found.source)),
        is_learned=True,
    )
    if bind.is_by_range:  # the bend range still sets its span
        bind = replace(bind, is_soft=False)
    path = own_file(mapping)
    with machine_lock(data_folder(), LOCK):
        contents, text = _own_contents(mapping, path)
        dropped = [own for own in contents.binds if _excludes(bind, own)]
        added = [_replacing(bind, dropped)]
        return _save(mapping, path, edited(contents, text, dropped, added)), path


def unlearn(mapping: Mapping, target: str) -> tuple[Mapping, int]:
    """Remove the learned binds of a target from the user's file, and give back what they replaced.

    One whose control has learned another target since then does not come back with that. Where none
    is learned, those that the user has written are removed. Returns the mapping without
    them, and how many were removed. Raises MappingError as `learn`.
    """
    with machine_lock(data_folder(), LOCK):
        return _unlearned(mapping, find(target).address, own_file(mapping))


def _unlearned(mapping: Mapping, address: str, path: Path) -> tuple[Mapping, int]:
    if not path.exists():
        return mapping, 0
    contents, text = _own_contents(mapping, path)
    of_target = [own for own in contents.binds if own.target == address]
    kept = [one for own in contents.binds for one in own.replaces]
    given_up = [one for one in kept if one.target == address and one.is_learned]
    dropped = [own for own in of_target if _is_learned(own)] or ([] if given_up else of_target)
    if not (dropped or given_up):
        return mapping, 0
    remaining = [own for own in contents.binds if own not in dropped]
    binds = [
        replace(own, replaces=tuple(one for one in own.replaces if one not in given_up))
        for own in remaining
    ]
    back: list[Bind] = []
    count = len(dropped) + len(given_up)
    for returned in [each for own in dropped for each in own.replaces]:
        # What was learned since then goes first; what the user wrote beside it comes back, too.
        newer = next(
            (
                own
                for own in binds
                if _is_learned(own)
                and _excludes(own, returned)
                and (own not in back or _is_plain(own))
            ),
            None,
        )
        if newer is None:
            binds.append(returned)
            back.append(returned)
        else:
            binds[binds.index(newer)] = _replacing(newer, [returned])
    removed = [own for own in contents.binds if own not in binds]
    added = [own for own in binds if own not in remaining]
    text = edited(contents, text, removed, added)
    if path.stem in shipped_mappings() and path.parent == user_folder():
        shipped = load(path.stem)
        if text.split() == as_toml(_new_contents(shipped)).split():  # nothing is left of the user
            path.unlink(missing_ok=True)
            return replace(shipped, mpe=mapping.mpe), count
    return _save(mapping, path, text), count


def others(mapping: Mapping, target: str, source: str) -> list[str]:
    """The sources beside one that move a target."""
    movers = dict.fromkeys(bind.source for bind in mapping.binds if bind.target == target)
    return [other for other in movers if other != source]


def added(before: Mapping, after: Mapping, target: str, found: LearnedSource) -> str:
    """What `learn` has changed, in a line: what was added, what stays and what is gone."""
    words = [f"{found} added: {target}"]
    if stay := others(after, target, found.source):
        words.append(f"{', '.join(stay)} still move{'s' * (len(stay) == 1)} it, too")
    words += [f"{lost} no longer moves {of}" for lost, of in changes(before, after)]
    return "; ".join(words)


def changes(before: Mapping, after: Mapping) -> list[tuple[str, str]]:
    """Source and target of each bind of a mapping that is not in another one."""
    kept = {(bind.source, bind.target) for bind in after.binds}
    lost = [(bind.source, bind.target) for bind in before.binds]
    return [pair for pair in dict.fromkeys(lost) if pair not in kept]


def _excludes(learned: Bind, other: Bind) -> bool:
    is_of_target = learned.is_exclusive and learned.target == other.target
    return is_of_target or override_key(learned) == override_key(other)


def _replacing(bind: Bind, dropped: Iterable[Bind]) -> Bind:
    """A learned bind that keeps others: but not what the same target has learned before."""
    kept = list(bind.replaces)
    for other in dropped:
        if not (other.target == bind.target and _is_plain(other)):
            kept.append(replace(other, replaces=()))
        kept += other.replaces
    return replace(bind, replaces=tuple(dict.fromkeys(kept)))


def _is_learned(bind: Bind) -> bool:
    """Whether `learn` made it, of before 1.0 too: that did not say so, and made all exclusive."""
    return bind.is_learned or bind.is_exclusive


def _is_plain(bind: Bind) -> bool:
    """Whether it is as `learn` makes it: its control can be moved again, nothing else is lost."""
    return _is_learned(bind) and bind == replace(
        bind, curve=find(bind.target).curve, span=None, invert=False, smoothing_ms=0.0, channels=()
    )


def _own_contents(mapping: Mapping, path: Path) -> tuple[MappingFile, str]:
    """Contents and text of the user's file; where there is none, of a new one with this base."""
    if path.exists():
        return read_mapping_file(path), text_of(path)
    contents = _new_contents(mapping)
    return contents, as_toml(contents)


def _new_contents(mapping: Mapping) -> MappingFile:
    """A file of the user's with a shipped mapping as its base, of which nothing is changed yet."""
    about = f"{mapping.about} With what you have taught it."
    return MappingFile(mapping.name, base=mapping.files[0].stem, about=about)


def _save(mapping: Mapping, path: Path, text: str) -> Mapping:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MappingError(f"{path.parent}: {error.strerror}") from error
    write_text(path, text)
    return current(mapping)
