"""Commands to an instrument for Python: notes, parameters, and a bow drawn by hand."""

from yehu_server.api.checks import number, setting
from yehu_server.api.notes import pitch_of, playable
from yehu_server.core.engine.instrument import Instrument as Engine
from yehu_server.errors import ParameterError, YehuError
from yehu_server.params.table import find
from yehu_server.playing.part_state import Key
from yehu_server.playing.player import Player

LONGEST_S = 3600.0  # computed at once
CHANNEL = 0


class Commands:
    """Commands to an instrument while it plays; ``instrument.Instrument`` computes the sound."""

    _rate: int
    _engine: Engine
    _commands: Player
    _dropped: int  # events that were lost and reported

    @property
    def time(self) -> float:
        """Seconds played since the beginning."""
        return self._engine.frame / self._rate

    @property
    def pitch(self) -> float | None:
        """The pitch that is played (fractional MIDI note); None in silence."""
        return self._commands.pitch

    # -- notes ---------------------------------------------------------------------------------

    def note_on(
        self, note: str | float, velocity: float = 80.0, *, at: float | None = None
    ) -> None:
        """Begin a note: slurred where another still sounds, else with a new stroke of the bow.

        Parameters
        ----------
        note : str or float
            Such as ``"A4"``, ``"F#5+25"`` (cents) or 69; of a yehu F4 (65) to F6 (89).
        velocity : float
            How hard it is struck, 0 to 127 as in MIDI, where 0 ends the note.
        at : float, optional
            When (s since the beginning); by default now.

        Raises
        ------
        ParameterError
            Where one is out of range, or the time is over.
        """
        pitch = playable(note, self._commands.notes)
        struck = number(velocity, "velocity", 0.0, 127.0) / 127.0
        if struck == 0.0:
            self.note_off(note, at=at)
            return
        values = {"/playing/velocity": struck}
        self._commands.note_on(Key(CHANNEL, pitch), values, frame=self._frame(at))
        self._check()

    def note_off(self, note: str | float | None = None, *, at: float | None = None) -> None:
        """End a note, by default all; of those still held, the last one sounds again.

        Raises
        ------
        ParameterError
            Where it is no note, or the time is over.
        """
        if note is None:
            self._commands.end_all(frame=self._frame(at))
        else:
            self._commands.note_off(Key(CHANNEL, pitch_of(note)), frame=self._frame(at))
        self._check()

    def slide(self, note: str | float, *, at: float | None = None) -> None:
        """Slide the finger to a pitch: that of the sounding note, or of a bow drawn by hand."""
        self._commands.slide(playable(note, self._commands.notes), frame=self._frame(at))
        self._check()

    def bend(self, semitones: float, *, at: float | None = None) -> None:
        """Hold the finger away from its note, by up to 48 semitones; 0 puts it back."""
        self.set("/playing/bend", semitones, at=at)

    # -- parameters ----------------------------------------------------------------------------

    def set(
        self, address: str, value: float, *, glide: float = 0.0, at: float | None = None
    ) -> None:
        """Set a parameter (docs/parameters.md), such as ``"/playing/bow_position"``.

        One of bow or fingers, such as ``"/bow/force"``, is taken from the player until the next
        note or `release`.

        Parameters
        ----------
        value : float
            In its unit, within its range.
        glide : float
            Least time (s) of the moves of bow and fingers that follow.
        at : float, optional
            When (s since the beginning); by default now.

        Raises
        ------
        ParameterError
            Where there is no such parameter, or the value is out of range.
        """
        address, found = setting(address, value)
        glide_ms = 1e3 * number(glide, "glide", 0.0, LONGEST_S)
        self._commands.write(address, found, frame=self._frame(at), glide_ms=glide_ms)
        self._check()

    def hold(self, address: str, value: float, *, at: float | None = None) -> None:
        """Set a parameter and keep it there, whatever notes do, until `release`; see `set`."""
        self._commands.write(*setting(address, value), frame=self._frame(at), hold=True)
        self._check()

    def get(self, address: str) -> float:
        """Return the value that a parameter has, or moves to.

        Raises
        ------
        ParameterError
            Where there is no such parameter.
        """
        return self._commands.value(find(address).address)

    def release(self, *, at: float | None = None) -> None:
        """Return all that was set directly or held to the player."""
        self._commands.release(frame=self._frame(at))
        self._check()

    # -- by hand -------------------------------------------------------------------------------

    def draw(self, speed: float, force: float, *, at: float | None = None) -> None:
        """Draw the bow by hand, on the string of the last `slide`, until `lift`.

        Parameters
        ----------
        speed : float
            m/s, -2 to 2; the sign is the direction.
        force : float
            N, 0 to 5.
        """
        speed = setting("/bow/speed", speed)[1]
        force = setting("/bow/force", force)[1]
        self._commands.draw(speed, force, frame=self._frame(at))
        self._check()

    def lift(self, *, at: float | None = None) -> None:
        """Lift a bow drawn by hand."""
        self._commands.lift(frame=self._frame(at))
        self._check()

    def pluck(self, force: float, position: float = 0.3, *, at: float | None = None) -> None:
        """Pull a string aside and let it go.

        Parameters
        ----------
        force : float
            N, -5 to 5; above 0 the inner string (F4), below the outer (C5).
        position : float
            Distance from the bridge as a share of the sounding length, 0.05 to 0.9.
        """
        self.set("/pluck/position", position, at=at)
        self.set("/pluck/force", force, at=at)

    # -- inside --------------------------------------------------------------------------------

    def _frame(self, at: float | None) -> int | None:
        if at is None:
            return None
        frame = round(number(at, "at") * self._rate)
        if frame < self._engine.frame:
            raise ParameterError(f"at: {at:g} s is in the past (now {self.time:g} s)")
        return frame

    def _check(self) -> None:
        """Raise YehuError where commands were lost."""
        dropped = self._engine.dropped_events
        if dropped > self._dropped:
            self._dropped = dropped
            raise YehuError("too many commands wait to be played: play some of them first")
