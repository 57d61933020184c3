"""The notes that a two-stringed fiddle has: its open strings, and how far each is stopped."""

from __future__ import annotations

from dataclasses import dataclass, replace

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.note_tables import OPEN_NOTES, NoteTables

REACHES = tuple(string.reach for string in Quantities().strings)


@dataclass(frozen=True)
class NoteRange:
    """The notes of a fiddle, by default those of a yehu, F4 to F6."""

    open_notes: tuple[int, int] = OPEN_NOTES  # what the strings are tuned to, the lower first
    reaches: tuple[float, ...] = REACHES  # how far above them fingers stop (semitones)
    bridge_x: float = Quantities().bridge_x  # m, by which harmonics are found
    transposed_by: int = 0  # semitones, which the open notes have already

    @classmethod
    def of(cls, quantities: Quantities, calibration: NoteTables | None) -> NoteRange:
        """That of an instrument as it is tuned."""
        open_notes = OPEN_NOTES if calibration is None else calibration.open_notes
        return cls.tuned_to(open_notes, quantities)

    @classmethod
    def tuned_to(cls, open_notes: tuple[int, int], quantities: Quantities) -> NoteRange:
        """That of an instrument whose strings are tuned to some notes."""
        reaches = tuple(string.reach for string in quantities.strings)
        return cls(open_notes, reaches, quantities.bridge_x)

    def transposed(self, semitones: int) -> NoteRange:
        """The same range, so many semitones higher."""
        lower, upper = (note + semitones for note in self.open_notes)
        by = self.transposed_by + semitones
        return replace(self, open_notes=(lower, upper), transposed_by=by)

    @property
    def highest_notes(self) -> tuple[float, ...]:
        """The highest note of each string (fractional MIDI note)."""
        return tuple(a + b for a, b in zip(self.open_notes, self.reaches, strict=True))

    @property
    def ends(self) -> tuple[int, int]:
        """The lowest and the highest note of the fiddle (MIDI notes)."""
        return self.lowest, self.highest

    @property
    def lowest(self) -> int:
        """The lowest note, the first string's."""
        return self.open_notes[0]

    @property
    def highest(self) -> int:
        """The highest note, which is on the second string."""
        return int(self.highest_notes[1])


YEHU = NoteRange()
LOWEST_NOTE, HIGHEST_NOTE = YEHU.ends
