"""What a two-stringed fiddle is tuned to, by its strings.

Each string is tuned to the note that it is nearest to, seen from a yehu's, which is off its own a
little. The player has one pair of hands for all: where a string is tuned elsewhere than a yehu's, a
note is stopped and bowed as the note of the yehu that lies as far above the open string.
"""

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.elementary import log2
from yehu_server.core.player.note_range import NoteRange
from yehu_server.core.player.note_tables import OPEN_NOTES, wave_speed
from yehu_server.errors import ParameterError
from yehu_server.playing.pitch_and_level import note_name

APART = 1.0  # semitones by which strings a fifth apart may be off it
FARTHEST = 36  # semitones from a yehu's
FARTHEST_APART = 12  # semitones between the strings


def notes_of(quantities: Quantities) -> NoteRange:
    """The notes of a fiddle to be tuned; raises ParameterError for strings that no fiddle has."""
    usual = Quantities()
    first, second = (
        12.0 * log2(_hertz(quantities, string) / _hertz(usual, string)) for string in (0, 1)
    )
    if abs(first - second) <= APART:
        first = second = 0.5 * (first + second)
    inner, outer = OPEN_NOTES[0] + round(first), OPEN_NOTES[1] + round(second)
    sound = (
        f"the strings sound {note_name(inner)} and {note_name(outer)} by length, mass and tension"
    )
    if not 0 < outer - inner <= FARTHEST_APART:
        raise ParameterError(
            f"{sound}: expected the second higher than the first, by at most an octave"
        )
    if max(abs(first), abs(second)) > FARTHEST:
        raise ParameterError(f"{sound}: expected at most {FARTHEST // 12} octaves from a yehu's")
    notes = NoteRange.tuned_to((inner, outer), quantities)
    first_highest, second_highest = notes.highest_notes
    if first_highest > second_highest:
        raise ParameterError(
            f"string_1.reach: the first string is stopped up to {note_name(first_highest)}, which "
            f"is above the highest note of the second, {note_name(second_highest)}"
        )
    return notes


def range_text(notes: NoteRange) -> str:
    """The lowest and the highest note of a fiddle."""
    return " to ".join(map(note_name, notes.ends))


def _hertz(quantities: Quantities, string: int) -> float:
    """Of an ideal open string."""
    return wave_speed(quantities, string) / (2.0 * quantities.bridge_x)
