"""The options of one player: instrument, mapping, tuning, preset, and how a score is shaped."""

from __future__ import annotations

from collections.abc import Mapping as Values
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities, read_quantities
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.core.player.note_tables import NoteTables
from yehu_server.core.player.velocity import NEUTRAL_VELOCITY
from yehu_server.playing import bowing_tables
from yehu_server.playing.calibration import Progress
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import DEFAULT, Mapping, load
from yehu_server.playing.player import Player
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, RangePolicy, Tuning

# Where a voice is followed. It varies by itself, so hands do not; as it sings, nobody can know its
# attacks nor how hard they are, so the bow has quick ones of its own.
STILL_HANDS = {"/playing/variation": 0.0, "/playing/vibrato": 0.0, "/playing/phrasing": 0.0}
AS_IT_SINGS = {**STILL_HANDS, "/playing/attack": 20.0, "/playing/velocity": NEUTRAL_VELOCITY}


# What a live instrument begins with: a bow arm that moves within each stroke, and a left hand that
# does what it is told.
LIVE = {"/playing/phrasing": 0.5, "/playing/left_hand": 0.0}


@dataclass(frozen=True)
class PlayingOptions:
    """What a player plays, and how; see ``yehu-server render --help``.

    `settings` (tuple of (address, value)): held parameters.
    `start` (tuple of (address, value)): the values of the preset.
    `preset`: the file of the preset.
    `instrument`: the file of the quantities.
    `channels`: MIDI channels that are played, counted from 0; None: all but percussion.
    `phrasing`, `rubato`: how far a score is shaped (``scores.phrasing``); see `shaping`.
    `gain_db`: None: that of the preset.
    """

    quantities: Quantities = field(default_factory=Quantities)  # before it is tuned
    instrument: Path | None = None

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
    channels: frozenset[int] | None = None
    phrasing: float | None = None
    rubato: float | None = None
    gain_db: float | None = None

    def on_instrument(self, file: Path | None, practice: Path | None = None) -> PlayingOptions:
        """The same options on the instrument of a file, or on this one for None.

        Notes are bowed as a practice file says, by default the one beside the instrument's, if it
        is there. Raises YehuError where a file cannot be read.
        """
        playing = self
        if file is not None:
            found = read_quantities(file)
            playing = replace(self, quantities=found, instrument=file, bowing=None, practice=None)
        practice = practice or bowing_tables.bowing_table_beside(file)
        if practice is None:
            return playing
        return replace(playing, bowing=bowing_tables.read_bowing_table(practice), practice=practice)

    def with_preset(self, *names: str) -> PlayingOptions:
        """The same options with the sound of presets; raises YehuError where one is none."""
        values = self.presets.find(*names).values
        return replace(self, preset=self.presets.find_file(names[0]), start=tuple(values.items()))

    def shaping(self, usual: float) -> PlayingOptions:
        """The same options with `phrasing` and `rubato` set: as asked for, or as usual."""
        phrasing = self.phrasing
        if phrasing is None:
            phrasing = dict(self.settings).get("/playing/phrasing", usual)
        rubato = phrasing if self.rubato is None else self.rubato
        return replace(self, phrasing=phrasing, rubato=rubato)

    def calibration(self, rate: float, progress: Progress | None = None) -> NoteTables:
        """The calibration of the instrument, bowed so; see `calibration_for`."""
        return calibration_for(
            rate, self.quantities, a4=self.a4, bowing=self.bowing, progress=progress
        )

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that it was read from, and where a bowing table was searched for."""
        beside = self.instrument and self.instrument.with_suffix(bowing_tables.ENDING)
        named = filter(None, (self.preset, self.practice, self.instrument, beside))
        return (*self.mapping.files, *named, *self.tuning.files)

    def spec(
        self,
        rate: float,
        calibration: NoteTables,
        *,
        start_values: Values[str, float] | None = None,
        body: int = 0,
        player_number: int = 0,
    ) -> InstrumentSpec:
        """The calibrated instrument at a rate (Hz) with this player; as of `InstrumentSpec`."""
        return InstrumentSpec(
            rate,
            calibration.tuned(self.quantities),
            calibration=calibration,
            open_strings=self.open_strings,
            bowing=bowing_tables.shipped_bowing_table(rate) if self.bowing is None else self.bowing,
            seed=self.seed,
            start_values=start_values or {},
            body=body,
            player_number=player_number,
        )

    def player(self, instruments: Instrument | Sequence[Instrument], part: int = 0) -> Player:
        """A player with these options, without the mapping, of an instrument or a section."""
        tuned = (self.policy, self.tuning, self.a4)
        return Player(instruments, *tuned, part=part, presets=self.presets)

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

    def mapped(self, player: Player) -> Player:
        """A player that plays by the mapping from the beginning on; see `Player.mapped`."""
        programs = self.presets.programs() if self.programs else None
        return player.mapped(self.mapping, self.channels, start=self.start, programs=programs)
