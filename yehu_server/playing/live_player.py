"""A thread-safe player: all live control of the instrument, from MIDI and OSC, goes through it.

Handlers run in threads of their own and hold a lock here. The audio side never waits for them:
they post wishes, with the frames at which its player acts on them.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from collections.abc import Mapping as Values

import mido

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.midi.events import LEAVE
from yehu_server.core.player.note_range import NoteRange
from yehu_server.errors import ParameterError
from yehu_server.params.table import TABLE, find
from yehu_server.playing.bind import Bind
from yehu_server.playing.learn import LearnedSource, Learner
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.wishes import Key, WishPoster

ELSEWHERE = -1  # the channel of notes that do not come from MIDI


class Arrivals:
    """Assigns frames to the messages of one source, in the order of their arrival.

    Small corrections of the clock must not swap messages that arrive close together.

    `frame_at`: returns the frame for a ``time.monotonic_ns()``, such as `LivePlayer.frame_of`.
    `rate` (Hz).
    """

    def __init__(self, frame_at: Callable[[int], int], rate: float) -> None:
        self._frame_at = frame_at
        self._rate = rate
        self._latest = 0

    def frame_of(self, arrived_ns: int) -> int:
        """The frame for a message that arrived then."""
        frame = self._frame_at(arrived_ns)
        if self._latest - frame > self._rate:  # no small correction of the clock
            self._latest = frame
        self._latest = max(self._latest, frame)
        return self._latest


class LivePlayer:
    """A player that several threads may call.

    Every call takes the frame at which it is to sound: that of the message's arrival, by
    `frame_of`, or that of its time tag. The player acts in the order of frames.

    `delay_ms`: from arrival to sound. Constant, and long enough that the frame has not been played
    yet, so that messages keep their rhythm.
    `part`: which of the parts on the stage it plays, counted from 0. What all parts share is the
    first one's.
    `wishes`: what its wishes go through; by default those of its options, to the instrument.

    `on_learning_changed`: called where `listens` changes, from any thread.
    """

    def __init__(
        self,
        instrument: Instrument,
        playing: PlayingOptions,
        *,
        delay_ms: float,
        part: int = 0,
        wishes: WishPoster | None = None,
    ) -> None:
        self.instrument = instrument
        self.part = part
        self.presets = playing.presets
        self.delay = instrument.frames(delay_ms)
        self._lock = threading.RLock()
        self._wishes = playing.wishes(instrument) if wishes is None else wishes
        self._midi = playing.midi(self._wishes)
        self._learner = Learner()
        self._found: Callable[[LearnedSource], None] | None = None
        self.on_learning_changed: Callable[[], None] = lambda: None
        self._latest = 0  # the latest frame of any call

    @property
    def delay(self) -> int:
        """Frames from the arrival of a message to its sound."""
        return self.instrument.delay

    @delay.setter
    def delay(self, frames: int) -> None:
        self.instrument.delay = frames

    def frame_of(self, arrived_ns: int | None = None) -> int:
        """The frame for a message that arrived at this ``time.monotonic_ns()``; by default, now."""
        moment = time.monotonic_ns() if arrived_ns is None else arrived_ns
        return int(self.instrument.frame_at(moment)) + self.delay

    def _at(self, frame: int) -> int:
        """Return the frame, and record it as the latest one."""
        if self._latest > frame + self.instrument.rate:  # the wall clock was set back
            self._latest = frame
        self._latest = max(self._latest, frame)
        return frame

    def _after_all(self, frame: int) -> int:
        """A frame after which nothing is wished yet."""
        return max(self._at(frame), self._latest)

    # -- parameters --------------------------------------------------------------------------

    def value(self, address: str) -> float:
        """The value that a parameter has or moves to; raises ParameterError where there is none."""
        with self._lock:
            return self._wishes.value(address)

    def values(self) -> dict[str, float]:
        """The values of all parameters, by address."""
        with self._lock:
            return {param.address: self.value(param.address) for param in TABLE}

    def write(self, address: str, value: float, *, frame: int) -> float:
        """Set a parameter; return the value accepted. ParameterError: as `WishPoster.write`."""
        with self._lock:
            return self._midi.write(address, value, frame=self._at(frame))

    def load(self, values: Values[str, float], *, frame: int) -> None:
        """Set the parameters of a preset, except held ones, all at one frame."""
        with self._lock:
            self._midi.load(values, frame=self._at(frame))

    def sound(self) -> dict[str, float]:
        """The parameters that a preset keeps: see `MidiPoster.sound`.

        Those that all parts share are in the sound of the first.
        """
        with self._lock:
            sound = self._midi.sound()
        if self.part == 0:
            return sound
        return {address: sound[address] for address in sound if not find(address).is_shared}

    def hold(self, address: str, value: float) -> float:
        """Set a parameter from the first frame on, and hold it as long as the program runs."""
        with self._lock:
            return self._wishes.write(address, value, frame=0, hold=True)

    def release(self, *, frame: int) -> None:
        """Return to the player what direct writes took over."""
        with self._lock:
            self._wishes.release(frame=self._at(frame))

    # -- the mapping -------------------------------------------------------------------------

    def move(self, address: str, argument: float, *, frame: int) -> None:
        """Move the targets of an OSC address that the mapping binds; others move nothing."""
        with self._lock:
            self._midi.move(address, argument, frame=self._at(frame))

    @property
    def mapping(self) -> Mapping:
        """The mapping in use."""
        return self._midi.mapping

    def remap(self, mapping: Mapping, *, frame: int) -> None:
        """See `MidiPoster.remap`."""
        with self._lock:
            self._midi.remap(mapping, frame=self._at(frame))

    def know_programs(self) -> None:
        """Read again which presets MIDI programs select, where they do; those that changed."""
        with self._lock:
            if self._midi.has_programs:
                self._midi.know_programs(self.presets.programs(), frame=self._at(self.frame_of()))

    def bindings(self) -> list[tuple[Bind, float | None, float]]:
        """Each bind, the position (0 to 1) its source was last moved to, and the target's value."""
        with self._lock:
            positions = self._midi.positions()
            return [(bind, position, self.value(bind.target)) for bind, position in positions]

    def listen(self, found: Callable[[LearnedSource], None] | None) -> None:
        """Call `found` once with the source that the user moves next; with None, stop listening.

        It is called from any thread, and must not block.
        """
        with self._lock:
            self._learner, self._found = Learner(), found
        self.on_learning_changed()

    @property
    def listens(self) -> bool:
        """Whether `listen` waits for a source to move."""
        return self._found is not None

    def hear(self, address: str, argument: float) -> None:
        """Receive a number at an OSC address of the user's own, for `listen`."""
        with self._lock:
            self._report(self._learner.learn_from_address(address, argument))

    def learn_from_message(self, message: mido.Message, port: int) -> None:
        """Receive a MIDI message of a port, counted from 0, for `listen`; it plays elsewhere."""
        with self._lock:
            self._report(self._learner.hear(message, port))

    def _report(self, source: LearnedSource | None) -> None:
        if source is not None and self._found is not None:
            found, self._found = self._found, None
            found(source)
            self.on_learning_changed()

    # -- notes -------------------------------------------------------------------------------

    @property
    def keys(self) -> int:
        """Number of keys that are held."""
        with self._lock:
            return int(self._wishes.record["held"])

    @property
    def notes(self) -> NoteRange:
        """The notes that the instrument has."""
        return self._wishes.notes

    @property
    def pitch(self) -> float | None:
        """The sounding pitch (fractional MIDI note); None in silence."""
        with self._lock:
            return self._wishes.pitch

    def end_port_notes(self, port: int, *, frame: int) -> None:
        """End the notes of a port that is gone."""
        with self._lock:
            self._midi.end_port_notes(port, frame=self._at(frame))

    def note_on(self, note: float, velocity: float, *, frame: int) -> None:
        """Begin a note (fractional; velocity 0 to 127); raises ParameterError beyond that."""
        key = _key(_within("note", note))
        with self._lock:
            self._midi.note_on(key, _within("velocity", velocity) / 127.0, self._at(frame))

    def note_off(self, note: float, *, frame: int) -> None:
        """End a note that `note_on` began."""
        with self._lock:
            self._midi.note_off(_key(note), self._at(frame))

    def slide(self, pitch: float, *, frame: int) -> float:
        """See `WishPoster.slide`; raises ParameterError where the pitch is out of MIDI's range."""
        with self._lock:
            return self._wishes.slide(_within("pitch", pitch), frame=self._at(frame))

    def draw(self, speed: float, force: float, *, frame: int) -> tuple[float, float]:
        """See `WishPoster.draw`."""
        with self._lock:
            return self._wishes.draw(speed, force, frame=self._at(frame))

    def end_notes(self, *, frame: int) -> None:
        """End all notes, as if all keys and pedals were released; lift a bow drawn by hand."""
        with self._lock:
            frame = self._after_all(frame)
            self._midi.reset(frame=frame)
            self._wishes.lift(frame=frame)

    def panic(self, *, frame: int) -> None:
        """End all notes and all sound at once."""
        with self._lock:
            self.end_notes(frame=frame)
            self._wishes.stop_sound(frame=self._after_all(frame), is_panic=True)

    def reset(self, *, frame: int) -> None:
        """As `panic`, and set every parameter to its start value."""
        with self._lock:
            self._midi.reset_to_start_values(frame=self._after_all(frame))
            self.panic(frame=frame)

    def end_keys(self, keys: Sequence[Key], *, frame: int) -> None:
        """End the notes of keys that somebody else has wished for, and who is gone."""
        with self._lock:
            self._wishes.notes_off(keys, frame=self._after_all(frame))

    def end_channel_notes(self, first: int, channels: int, *, frame: int) -> None:
        """End what is held on channels whose owner is gone, and lift a bow drawn by hand."""
        with self._lock:
            frame = self._after_all(frame)
            self._wishes.post(LEAVE, frame, first, channels)
            self._wishes.lift(frame=frame)


def _key(note: float) -> Key:
    """The key of a note, rounded so that it is the same in single and double precision."""
    return Key(ELSEWHERE, round(note, 3))


def _within(what: str, value: float) -> float:
    if not 0.0 <= value <= 127.0:  # also refuses NaN
        raise ParameterError(f"{what}: {value:g} is not within 0 to 127")
    return value
