"""The options of playing that live playing and rendering share: mapping, tuning, preset."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibration import Calibration
from yehu_server.playing.fingering import OpenStrings, RangePolicy
from yehu_server.playing.intonation import Intonation
from yehu_server.playing.mapping import DEFAULT, Mapping, load
from yehu_server.playing.messages import MidiPlayer
from yehu_server.playing.ownership import Sink
from yehu_server.playing.performer import Performer
from yehu_server.playing.presets import Presets
from yehu_server.playing.tuning import EQUAL, Tuning


@dataclass(frozen=True)
class Style:
    """How to play; see ``yehu-server render --help``.

    Attributes
    ----------
    settings : tuple of (address, value)
        Held parameters.
    start : tuple of (address, value)
        The values of the preset.
    preset : Path, optional
        The file of the preset.
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

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that it was read from."""
        preset = () if self.preset is None else (self.preset,)
        return (*self.mapping.files, *preset, *self.tuning.files)

    def performer(
        self,
        sink: Sink,
        calibration: Calibration | None = None,
        quantities: Quantities | None = None,
    ) -> Performer:
        """A player of this style for one instrument."""
        return Performer(
            sink,
            Intonation(calibration, quantities),
            policy=self.policy,
            seed=self.seed,
            open_strings=self.open_strings,
            tuning=lambda note: self.tuning.pitch(note, self.a4),
        )

    def midi(self, performer: Performer, channels: set[int] | None = None) -> MidiPlayer:
        """A MIDI player of this style; `channels` as in `MidiPlayer`."""
        programs = self.presets.of_program if self.programs else None
        return MidiPlayer(performer, self.mapping, channels, start=self.start, programs=programs)
