"""How to render: what each instrument plays, and the pitch it is asked for."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, fields

from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.player.calibration import Calibration
from yehu_server.core.stage.image_sources import EARS
from yehu_server.playing.options import PlayingOptions
from yehu_server.scores.score import Score

BLOCK = 1 << 14  # frames; the sound does not depend on it


@dataclass(frozen=True)
class Part:
    """A player on the stage, or a section of them: what they play, and how."""

    score: Score
    name: str = ""
    playing: PlayingOptions = field(default_factory=PlayingOptions)
    # Those that it plays, counted from 0; by default all but percussion.
    channels: frozenset[int] | None = None
    phrasing: float = 0.0  # of the player; the score is shaped before (``scores.phrasing``)
    quantities: Quantities = field(default_factory=Quantities)
    calibration: Calibration | None = None  # by default looked up or measured
    gain_db: float | None = None  # by default that of the preset


@dataclass(frozen=True)
class Options:
    """How to render; see ``yehu-server render --help``.

    What describes an instrument holds where one plays a score alone; an ensemble has it in parts.
    """

    rate: int = 44100
    format_name: str = "wav"
    subtype: str = "24"
    channels: frozenset[int] | None = None
    tail_s: float | None = None  # None: until it is quiet
    gain_db: float | None = None
    normalize: bool = False
    phrasing: float = 0.0
    playing: PlayingOptions = field(default_factory=PlayingOptions)
    quantities: Quantities = field(default_factory=Quantities)
    calibration: Calibration | None = None
    block: int = BLOCK
    is_dry: bool = False  # without a room, and with a body that sounds alike to both sides
    is_mono: bool = False
    jobs: int | None = None  # number of cores; None: all

    @property
    def sound_channels(self) -> int:
        """Channels of the sound: left and right, or one."""
        return 1 if self.is_mono else EARS

    @property
    def cores(self) -> int:
        """Number of cores to use."""
        return self.jobs or os.cpu_count() or 1

    def solo(self, score: Score) -> Part:
        """The part of one instrument that plays a score alone."""
        own = {each.name for each in fields(Part)} & {each.name for each in fields(self)}
        return Part(score, score.name, **{name: getattr(self, name) for name in own})
