"""The immutable configuration from which an instrument and its player are made."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.bowing import default_bowing_table
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.core.player.note_range import NoteRange
from yehu_server.core.player.note_tables import NoteTables
from yehu_server.params.table import TABLE, find

SEED = "/engine/seed"


@dataclass(frozen=True)
class InstrumentSpec:
    """An instrument and its player, before anything is played.

    Attributes
    ----------
    rate : float
        Sample rate (Hz), within the bounds of ``physics.grid``.
    quantities : Quantities
        The physical instrument, as it is tuned; by default the measured one.
    calibration : NoteTables, optional
        Where its player's fingers stop; by default where an ideal string is in tune.
    open_strings : OpenStrings
        When the C string is played open.
    seed : int
        Seed of the variation between notes.
    bowing : ndarray
        How each note is bowed; by default ``player.bowing.default_bowing_table``.
    start_values : mapping
        Values of parameters at the start, by address; others have their default.
    body : int
        Which of many bodies it has, for what differs to both sides.
    player_number : int
        Which player of a section it is, counted from 0.
    """

    rate: float
    quantities: Quantities = field(default_factory=Quantities)
    calibration: NoteTables | None = None
    open_strings: OpenStrings = OpenStrings.ALWAYS
    seed: int = 0
    bowing: Any = field(default_factory=default_bowing_table, compare=False)
    start_values: Mapping[str, float] = field(default_factory=dict)
    body: int = 0
    player_number: int = 0

    @property
    def notes(self) -> NoteRange:
        """The notes that it has."""
        return NoteRange.of(self.quantities, self.calibration)

    @property
    def values(self) -> dict[str, float]:
        """The value of every parameter at the start, by address."""
        seeded = {SEED: find(SEED).clamped(self.seed)}
        return {param.address: param.default for param in TABLE} | seeded | dict(self.start_values)
