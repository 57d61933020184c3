"""The options of playing that live playing and rendering share: mapping, tuning, preset."""

from __future__ import annotations

from collections.abc import Mapping as Values
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.player.calibration import Calibration
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.core.player.velocity import NEUTRAL
from yehu_server.playing.calibration import Progress
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import DEFAULT, Mapping, load
from yehu_server.playing.midi_poster import MidiPoster
from yehu_server.playing.practice_files import read_practice, shipped_practice
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, RangePolicy, Tuning
from yehu_server.playing.wishes import WishPoster

# Where a voice is followed. It varies by itself, so hands do not; as it sings, nobody can know its
# attacks nor how hard they are, so the bow has quick ones of its own.
STILL_HANDS = {"/playing/variation": 0.0, "/playing/vibrato": 0.0}
AS_IT_SINGS = {**STILL_HANDS, "/playing/attack": 20.0, "/playing/velocity": NEUTRAL}


@dataclass(frozen=True)
class PlayingOptions:
    """How to play; see ``yehu-server render --help``.

    `settings` (tuple of (address, value)): held parameters.
    `start` (tuple of (address, value)): the values of the preset.
    `preset`: the file of the preset.
    """

    mapping: Mapping = field(default_factory=lambda: load(DEFAULT))
    settings: tuple[tuple[str, float], ...] = ()
    start: tuple[tuple[str, float], ...] = ()
    presets: Presets = field(default_factory=Presets, compare=False)
    programs: bool = False  # whether program changes select presets
    a4: float = 440.0  # Hz
    tuning: Tuning = EQUAL
    policy: RangePolicy = RangePolicy.TRANSPOSE
    open_strings: OpenStrings = OpenStrings.ALWAYS
    seed: int = 0
    preset: Path | None = None
    bowing: Any = field(default=None, compare=False)  # how notes are bowed; None: as shipped
    practice: Path | None = None  # the file of `bowing`

    def practised(self, path: Path | None) -> PlayingOptions:
        """The same options with notes bowed as a practice file says, unless another is asked for.

        Raises YehuError where it cannot be read.
        """
        if path is None or self.bowing is not None:
            return self
        return replace(self, bowing=read_practice(path), practice=path)

    def calibration(
        self, rate: float, quantities: Quantities, progress: Progress | None = None
    ) -> Calibration:
        """The calibration of an instrument that is bowed so; see `calibration_for`."""
        return calibration_for(rate, quantities, a4=self.a4, bowing=self.bowing, progress=progress)

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that it was read from."""
        named = [path for path in (self.preset, self.practice) if path is not None]
        return (*self.mapping.files, *named, *self.tuning.files)

    def spec(
        self,
        rate: float,
        calibration: Calibration,
        quantities: Quantities | None = None,
        *,
        start_values: Values[str, float] | None = None,
        body: int = 0,
        player_number: int = 0,
    ) -> InstrumentSpec:
        """An instrument at a rate (Hz), calibrated, with a player with these options.

        `quantities`: the instrument as it is before it is tuned.
        `start_values`, `body`, `player_number`: see `InstrumentSpec`.
        """
        return InstrumentSpec(
            rate,
            calibration.tuned(quantities or Quantities()),
            calibration=calibration,
            open_strings=self.open_strings,
            bowing=shipped_practice(rate) if self.bowing is None else self.bowing,
            seed=self.seed,
            start_values=start_values or {},
            body=body,
            player_number=player_number,
        )

    def wishes(self, instruments: Instrument | Sequence[Instrument]) -> WishPoster:
        """What posts wishes with these options to an instrument, or to those of a section."""
        return WishPoster(instruments, self.policy, self.tuning, self.a4)

    def tables(self, controls: Controls) -> Any:
        """The tables of these options (``midi.tables``), with named controls numbered as given."""
        return make_tables(
            self.mapping,
            controls,
            start=self.start,
            tuning=self.tuning,
            a4=self.a4,
            policy=self.policy,
            programs=self.presets.programs() if self.programs else None,
        )

    def midi(self, wishes: WishPoster, channels: set[int] | None = None) -> MidiPoster:
        """A MIDI player with these options; `channels` as in `MidiPoster`."""
        programs = self.presets.programs() if self.programs else None
        return MidiPoster(wishes, self.mapping, channels, start=self.start, programs=programs)
