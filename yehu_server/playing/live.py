"""The one way to the instrument while it plays: from MIDI, OSC, or whatever comes next.

Handlers run in threads of their own and take turns here. Nothing below waits for them: they
stamp what they decide with frames and post it, and the audio side applies it.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from collections.abc import Mapping as Values

import mido

from yehu_server.engine.instrument import Instrument
from yehu_server.errors import ParameterError
from yehu_server.params.spec import Place
from yehu_server.params.table import ENGINE, TABLE, find
from yehu_server.playing.binds import Bind
from yehu_server.playing.calibration import Calibration
from yehu_server.playing.learner import Found, Learner
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.performer import Key
from yehu_server.playing.style import Style

ELSEWHERE = -1  # the channel of notes that come from no MIDI port


class Targets:
    """Passes the player's moves on to the instrument, and remembers where each went."""

    def __init__(self, instrument: Instrument) -> None:
        self._instrument = instrument
        self.values = {param.address: param.default for param in ENGINE}

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """See `Instrument.write`."""
        accepted = self._instrument.write(address, value, frame=frame, ramp_ms=ramp_ms)
        self.values[address] = accepted
        return accepted

    def silence(self, *, frame: int | None = None) -> None:
        """See `Instrument.silence`."""
        self._instrument.silence(frame=frame)


class Arrivals:
    """Frames for what arrives from one source: none before the one before it.

    The clock that frames are read off is corrected now and then, by a little; messages that
    come close together must not change places over that.
    """

    def __init__(self, player: LivePlayer) -> None:
        self._player = player
        self._latest = 0

    def frame_of(self, arrived_ns: int) -> int:
        """See `LivePlayer.frame_of`."""
        frame = self._player.frame_of(arrived_ns)
        if self._latest - frame > self._player.instrument.rate:  # no small correction
            self._latest = frame
        self._latest = max(self._latest, frame)
        return self._latest


class LivePlayer:
    """A player that several threads may tell what to do.

    Every call takes the frame at which it shall be heard: that of the message's arrival, by
    `frame_of`, or that of its time tag. What the player decides keeps its order: a message
    that comes while a later one is already decided (`control.schedule` looks some
    milliseconds ahead) is heard no earlier than that. Direct writes need not wait.

    Parameters
    ----------
    delay_ms : float
        From arrival to being heard. Constant, and long enough that the frame has not been
        played yet, so that messages keep their rhythm.
    """

    def __init__(
        self,
        instrument: Instrument,
        style: Style,
        *,
        calibration: Calibration | None = None,
        delay_ms: float,
    ) -> None:
        self.instrument = instrument
        self.presets = style.presets
        self.delay = instrument.frames(delay_ms)
        self._turn = threading.RLock()
        self._targets = Targets(instrument)
        self._performer = style.performer(self._targets, calibration, instrument.quantities)
        self._midi = style.midi(self._performer)
        self._learner = Learner()
        self._found: Callable[[Found], None] | None = None
        self._decided = 0  # the latest frame of a decision
        self._written = 0  # and of anything

    def frame_of(self, arrived_ns: int | None = None) -> int:
        """The frame for a message that arrived at a moment of ``time.monotonic_ns()``."""
        moment = time.monotonic_ns() if arrived_ns is None else arrived_ns
        return int(self.instrument.frame_at(moment)) + self.delay

    def _in_order(self, frame: int) -> int:
        if self._decided > frame + self.instrument.rate:  # the world's clock was set back
            self._decided = self._written = frame
        self._decided = max(self._decided, frame)
        self._written = max(self._written, self._decided)
        return self._decided

    # -- parameters --------------------------------------------------------------------------

    def value(self, address: str) -> float:
        """Where a parameter is, or is on its way to. Errors: ParameterError."""
        param = find(address)
        with self._turn:
            return self._targets.values[address] if param.owned else self._performer.value(address)

    def values(self) -> dict[str, float]:
        """All parameters, by address."""
        with self._turn:
            return {param.address: self.value(param.address) for param in TABLE}

    def write(self, address: str, value: float, *, frame: int) -> float:
        """Set a parameter; return the value accepted. Errors: ParameterError."""
        with self._turn:
            if find(address).place is Place.PLAYER:
                frame = self._in_order(frame)
            self._written = max(self._written, frame)
            return self._midi.write(address, value, frame=frame)

    def load(self, values: Values[str, float], *, frame: int) -> None:
        """Set the parameters of a preset, but for those that are held, all at one frame."""
        with self._turn:
            self._midi.load(values, frame=self._in_order(frame))

    def sound(self) -> dict[str, float]:
        """The parameters as a preset is to keep them: see `Controllers.sound`."""
        with self._turn:
            return self._midi.sound()

    def hold(self, address: str, value: float) -> float:
        """Set a parameter for as long as the program runs, from the first frame on."""
        with self._turn:
            return self._performer.write(address, value, frame=0, hold=True)

    def release(self) -> None:
        """Give back to the player what direct writes took over."""
        with self._turn:
            self._performer.release()

    # -- the mapping -------------------------------------------------------------------------

    @property
    def addresses(self) -> tuple[str, ...]:
        """The OSC addresses that the mapping gives a meaning."""
        return self._midi.mapping.addresses

    def move(self, address: str, argument: float, *, frame: int) -> None:
        """Move what the mapping binds to one of its `addresses`; another moves nothing."""
        with self._turn:
            self._midi.move(address, argument, frame=self._in_order(frame))

    @property
    def mapping(self) -> Mapping:
        """What controllers move."""
        return self._midi.mapping

    def remap(self, mapping: Mapping, *, frame: int) -> None:
        """See `MidiPlayer.remap`."""
        with self._turn:
            self._midi.remap(mapping, frame=self._in_order(frame))

    def bindings(self) -> list[tuple[Bind, float | None, float]]:
        """Each bind, where its source was last moved to (0 to 1), and the target's value."""
        with self._turn:
            return [(bind, place, self.value(bind.target)) for bind, place in self._midi.places()]

    def listen(self, found: Callable[[Found], None] | None) -> None:
        """Find out what somebody moves next; `found` is told of it, once, from any thread.

        It must not wait. With None nothing is listened to.
        """
        with self._turn:
            self._learner, self._found = Learner(), found

    @property
    def listens(self) -> bool:
        """Whether it is to find out what somebody moves."""
        return self._found is not None

    def hear(self, address: str, argument: float) -> None:
        """Take in what came to an OSC address of the user's own."""
        with self._turn:
            self._tell(self._learner.hear_address(address, argument))

    def _tell(self, source: Found | None) -> None:
        if source is not None and self._found is not None:
            found, self._found = self._found, None
            found(source)

    # -- notes -------------------------------------------------------------------------------

    @property
    def pitch(self) -> float | None:
        """The pitch (fractional MIDI note) that sounds."""
        with self._turn:
            return self._performer.pitch

    def receive(self, message: mido.Message, *, frame: int, port: int) -> None:
        """Act on a MIDI message of one of the ports, counted from 0."""
        with self._turn:
            if self._found is not None:
                self._tell(self._learner.hear(message, port))
            self._midi.receive(message, frame=self._in_order(frame), port=port)

    def let_go_of(self, port: int, *, frame: int) -> None:
        """End what a port that is gone has left sounding."""
        with self._turn:
            self._midi.let_go_of(port, frame=self._in_order(frame))

    def note_on(self, note: float, velocity: float, *, frame: int) -> None:
        """Begin a note (fractional MIDI note; velocity 0 to 127).

        Errors: ParameterError where one is out of MIDI's range.
        """
        key = _key(_within("note", note))
        with self._turn:
            self._midi.note_on(key, _within("velocity", velocity) / 127.0, self._in_order(frame))

    def note_off(self, note: float, *, frame: int) -> None:
        """End a note that `note_on` began."""
        with self._turn:
            self._midi.note_off(_key(note), self._in_order(frame))

    def slide(self, pitch: float, *, frame: int) -> float:
        """See `Performer.slide`. Errors: ParameterError where it is out of MIDI's range."""
        with self._turn:
            return self._performer.slide(_within("pitch", pitch), frame=self._in_order(frame))

    def draw(self, speed: float, force: float, *, frame: int) -> tuple[float, float]:
        """See `Performer.draw`."""
        with self._turn:
            return self._performer.draw(speed, force, frame=self._in_order(frame))

    def end_notes(self, *, frame: int) -> None:
        """End all notes, as if all keys and pedals were let go, and lift a bow drawn by hand."""
        with self._turn:
            frame = self._in_order(max(frame, self._written))
            self._midi.receive(mido.Message("reset"), frame=frame)
            self._performer.lift(frame=frame)

    def panic(self, *, frame: int) -> None:
        """End all notes and all sound at once."""
        with self._turn:
            self.end_notes(frame=frame)
            self._performer.all_sound_off(frame=self._decided)

    def reset(self, *, frame: int) -> None:
        """The same, and put every parameter back to where it began."""
        with self._turn:
            frame = self._in_order(max(frame, self._written))
            self._midi.begin_again(frame=frame)
            self.panic(frame=frame)


def _key(note: float) -> Key:
    """The key of a note: the same for single and double precision."""
    return Key(ELSEWHERE, round(note, 3))


def _within(what: str, value: float) -> float:
    if not 0.0 <= value <= 127.0:  # also refuses NaN
        raise ParameterError(f"{what}: {value:g} is not within 0 to 127")
    return value
