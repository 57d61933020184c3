"""The instrument for Python: commands or controls in, arrays of sound and signals out."""

import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from yehu_server.api.checks import (
    InstrumentLike,
    PathLike,
    get_ready,
    number,
    playing_of,
    rate_of,
    whole,
)
from yehu_server.api.commands import LONGEST_S, Commands
from yehu_server.api.observing import Run, curves_of
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument as Engine
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.errors import YehuError
from yehu_server.params.spec import Place
from yehu_server.params.table import find
from yehu_server.playing.options import PlayingOptions
from yehu_server.simulation.run import Simulation
from yehu_server.util import __version__

Sound = NDArray[np.float32]


class Instrument(Commands):
    """A yehu and its player, whose time goes on only while it computes sound.

    It plays notes as the live instrument does (`note_on`, `slide`, `set`), or the bow is drawn by
    hand (`draw`, or `controls` of `play`). `play` computes the sound, `record` every signal too.

    Parameters
    ----------
    sample_rate : float
        Hz, 22050 to 192000. 44100, 48000 and 96000 are calibrated; others take some seconds, once.
    instrument : mapping, path, Quantities or Body, optional
        Physical quantities to change, such as ``{"string_1": {"T": 49.0}}``, an instrument file
        (docs/physics.md), or a body of `yehu.body`; by default the measured instrument.
    preset : str or path, optional
        A sound to begin with (presets/README.md), such as ``"flautando"``; several are joined by a
        plus.
    settings : mapping, optional
        Values of parameters (docs/parameters.md) that are held, by address.
    stereo : bool
        Sound to left and right, in the room; by default one channel without a room.
    a4 : float
        Reference pitch (Hz), 390 to 480.
    tuning : path, optional
        A Scala scale, or the name of a shipped one; by default equal temperament.
    practice : path, optional
        How notes are bowed: a file of ``yehu-server practise``.
    seed : int
        Seed of the small variation between notes.

    Raises
    ------
    YehuError
        Where an option is wrong, or the quantities make no stable model.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> fiddle = yehu.Instrument(settings={"/playing/vibrato": 20.0})
    >>> fiddle.note_on("A4", velocity=90)
    >>> first = fiddle.play(0.5)
    >>> fiddle.slide("C5")
    >>> then = fiddle.play(0.5)
    >>> first.shape, first.dtype, fiddle.time
    ((22050,), dtype('float32'), 1.0)
    """

    def __init__(
        self,
        sample_rate: float = 44100,
        *,
        instrument: InstrumentLike | None = None,
        preset: PathLike | None = None,
        settings: Mapping[str, float] | None = None,
        stereo: bool = False,
        a4: float = 440.0,
        tuning: PathLike | None = None,
        practice: PathLike | None = None,
        seed: int = 0,
    ) -> None:
        rate = rate_of(sample_rate)
        playing = playing_of(
            instrument,
            preset=preset,
            settings=settings,
            a4=a4,
            tuning=tuning,
            practice=practice,
            seed=seed,
        )
        get_ready()
        spec = playing.spec(float(rate), playing.calibration(float(rate)))
        self._build(rate, playing, spec, stereo=stereo)

    def _build(
        self, rate: int, playing: PlayingOptions, spec: InstrumentSpec, *, stereo: bool
    ) -> None:
        self._rate, self._playing = rate, playing
        self._channels = 2 if stereo else 1
        self._stage: Ensemble | Engine
        if stereo:
            self._stage = Ensemble([spec])
            self._engine = self._stage.first
        else:
            self._stage = self._engine = Engine(spec)
        self._begin()

    def __getstate__(self) -> dict[str, Any]:
        """All of it as it is now: a copy goes on as this one does."""
        return {
            "version": __version__,
            "rate": self._rate,
            "playing": self._playing,
            "spec": self._engine.spec,
            "stereo": self._channels > 1,
            "dropped": self._dropped,
            "pending": self._commands.pending,
            "memory": zlib.compress(memoryview(self._stage.memory), 1),  # most of it is zero
        }

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        if state["version"] != __version__:
            raise YehuError(f"this instrument was pickled by version {state['version']}")
        get_ready()
        self._build(state["rate"], state["playing"], state["spec"], stereo=state["stereo"])
        self._commands.pending = state["pending"]
        self._dropped = state["dropped"]
        memory = np.frombuffer(zlib.decompress(state["memory"]), np.uint8)
        np.frombuffer(self._stage.memory, np.uint8, count=len(memory))[:] = memory

    def __repr__(self) -> str:
        return f"<yehu_server.Instrument at {self._rate} Hz, {self.time:g} s played>"

    @property
    def sample_rate(self) -> int:
        """Sample rate (Hz)."""
        return self._rate

    @property
    def quantities(self) -> Quantities:
        """The physical quantities of the instrument, as it is tuned."""
        return self._engine.spec.quantities

    # -- sound ---------------------------------------------------------------------------------

    def play(self, seconds: float, *, controls: Mapping[str, ArrayLike] | None = None) -> Sound:
        """Compute the next sound.

        Parameters
        ----------
        seconds : float
            How much, up to an hour.
        controls : mapping, optional
            Parameters that move meanwhile, by address: a number, or an array of values, equally
            spaced from the beginning to the end of this sound, with straight lines between. They
            are followed every 64 samples. Those of bow and fingers are taken from the player.

        Returns
        -------
        ndarray [shape=(frames,), or (frames, 2) in stereo, float32]
            Full scale is 1.

        Raises
        ------
        ParameterError
            Where an argument is wrong.

        Examples
        --------
        >>> import numpy as np, yehu_server as yehu
        >>> fiddle = yehu.Instrument()
        >>> speed = np.linspace(0.0, 0.3, 50)
        >>> sound = fiddle.play(
        ...     0.5, controls={"/bow/side": 1.0, "/bow/speed": speed, "/bow/force": 0.7}
        ... )
        >>> bool(np.abs(sound).max() > 0.01)
        True
        """
        frames = self._frames(seconds)
        run = Run(self._engine, self._stage, self._commands, curves_of(controls))
        sound = run.sound(frames, self._channels)
        self._check()
        return sound

    def record(
        self,
        seconds: float,
        *,
        controls: Mapping[str, ArrayLike] | None = None,
        strings_every: int = 0,
    ) -> Simulation:
        """Compute the next sound, and keep every force, velocity and displacement.

        Parameters
        ----------
        seconds, controls
            As of `play`.
        strings_every : int
            Keep the shapes of both strings every so many samples; 0 for never.

        Returns
        -------
        Simulation
            With the arrays of `simulate` and ``sound``. Those of fingers have a column for each of
            four: ``finger_position``, ``press_force``, ``finger_displacement`` [shape=(frames, 4)],
            ``contact_force`` [shape=(frames, 4, 2)].

        Raises
        ------
        ParameterError
            Where an argument is wrong, or the arrays would take more than 8 GiB.

        Examples
        --------
        >>> import yehu_server as yehu
        >>> fiddle = yehu.Instrument()
        >>> fiddle.note_on("G4")
        >>> run = fiddle.record(0.2, strings_every=100)
        >>> run.arrays["bow_force"].shape, run.arrays["string_1"].shape[0]
        ((8820,), 89)
        """
        frames = self._frames(seconds)
        every = whole(strings_every, "strings_every", 0, 2**31)
        run = Run(self._engine, self._stage, self._commands, curves_of(controls))
        found = run.signals(frames, self._channels, every)
        self._check()
        return found

    def stop(self) -> None:
        """End all notes, and let all sound fade within 5 ms; time and parameters stay."""
        self._commands.end_all()
        self._commands.stop_sound(is_panic=True)

    def reset(self) -> None:
        """Begin anew: at time 0, with the settings that it was made with."""
        self._stage.reset()
        self._begin()

    # -- inside --------------------------------------------------------------------------------

    def _begin(self) -> None:
        """Give all parameters the values that preset and settings begin with."""
        self._dropped = 0
        self._commands = self._playing.player(self._engine)
        for address, value in self._playing.start:
            if find(address).place is Place.ENGINE:
                self._engine.write(address, value, ramp_ms=0.0)
            self._commands.write(address, value)
        for address, value in self._playing.settings:
            self._commands.start_with(address, value)

    def _frames(self, seconds: float) -> int:
        return round(number(seconds, "seconds", 0.0, LONGEST_S) * self._rate)
