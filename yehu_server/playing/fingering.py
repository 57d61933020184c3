"""Choose the string and finger position for a pitch."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from yehu_server.playing.calibration import OPEN_NOTES
from yehu_server.playing.intonation import Intonation

LOWEST_NOTE, HIGHEST_NOTE = 65, 89  # F4 to F6
# Semitones around an open string that are played without a finger: no finger fits nearer to the
# loop than 8 mm, which is this interval.
OPEN_WITHIN = 0.45
ON_PITCH_WITHIN = 0.05
# Above this pitch notes on the F string jump and scratch: bowed at four speeds and three pressures,
# F5 and G5 hold in at most a third of the cases, notes up to E5 in at least four fifths.
HIGHEST_ON_F = 76.5


class RangePolicy(Enum):
    """What happens to a note outside the range of the instrument."""

    TRANSPOSE = "transpose"
    CLAMP = "clamp"
    SKIP = "skip"

    def fit(self, note: float) -> float | None:
        """Return the note to play for `note`, or None for none.

        A note that a tuning puts less than a quarter tone out of range is moved to its end.
        """
        if LOWEST_NOTE - OPEN_WITHIN < note < HIGHEST_NOTE + OPEN_WITHIN:
            return min(max(note, LOWEST_NOTE), HIGHEST_NOTE)
        if self is RangePolicy.SKIP:
            return None
        if self is RangePolicy.CLAMP:
            return min(max(note, LOWEST_NOTE), HIGHEST_NOTE)
        if note < LOWEST_NOTE:
            return note + 12 * -(-(LOWEST_NOTE - note) // 12)
        return note - 12 * -(-(note - HIGHEST_NOTE) // 12)


class OpenStrings(Enum):
    """When the C string is played open; the F string is, wherever no finger fits."""

    ALWAYS = "always"  # wherever no finger fits on the C string
    ON_PITCH = "on-pitch"
    NEVER = "never"

    def takes(self, pitch: float) -> bool:
        """Whether a pitch is played on the open C string."""
        within = {OpenStrings.ALWAYS: OPEN_WITHIN, OpenStrings.ON_PITCH: ON_PITCH_WITHIN}
        return abs(pitch - OPEN_NOTES[1]) < within.get(self, 0.0)


@dataclass(frozen=True)
class Fingering:
    """A string (0: F4, 1: C5) and the finger's position on it (m); None for an open string."""

    string: int
    position: float | None

    @property
    def side(self) -> float:
        """The value of ``/bow/side`` that bows this string."""
        return 1.0 if self.string == 0 else -1.0


@dataclass(frozen=True)
class Stopped(Fingering):
    """A fingering with the finger down."""

    position: float


def choose(
    pitch: float,
    hand: Fingering | None,
    intonation: Intonation,
    speed: float,
    open_strings: OpenStrings = OpenStrings.ALWAYS,
    wish: int | None = None,
) -> Fingering:
    """Choose the fingering of a pitch (fractional MIDI note) at a bow speed (m/s).

    Below C5 it is on the F string; from C5 up on the C string, unless the finger is on the F
    string and nearer to the pitch there, up to HIGHEST_ON_F.

    Parameters
    ----------
    hand : Fingering, optional
        The present fingering.
    wish : int, optional
        The string to play on, wherever it has the pitch.
    """
    if pitch < OPEN_NOTES[0] + OPEN_WITHIN:
        return Fingering(0, None)  # the lowest note of the instrument
    if wish == 0:
        return _stop(0, pitch, intonation, speed)
    if open_strings.takes(pitch):
        return Fingering(1, None)
    if pitch < OPEN_NOTES[1] + OPEN_WITHIN:
        return _stop(0, pitch, intonation, speed)
    near, far = (_stop(string, pitch, intonation, speed) for string in (1, 0))
    if wish == 1 or hand is None or hand.string != 0 or hand.position is None:
        return near
    nearer = abs(far.position - hand.position) < abs(near.position - hand.position)
    return far if nearer and pitch <= HIGHEST_ON_F else near


def stay(
    pitch: float, string: int, intonation: Intonation, speed: float, wish: int | None = None
) -> Fingering:
    """Follow a bent pitch on the string that sounds, as far as that has it.

    Below the open C string it changes to the F string, and above HIGHEST_ON_F to the C string,
    unless the F string is wished for.
    """
    string = string if wish is None else wish
    open_note = OPEN_NOTES[string]
    if abs(pitch - open_note) < OPEN_WITHIN or pitch < OPEN_NOTES[0]:
        return Fingering(string if pitch >= OPEN_NOTES[0] else 0, None)
    if string == 0 and pitch > HIGHEST_ON_F and wish != 0:
        string = 1
    return _stop(string if pitch > OPEN_NOTES[string] else 0, pitch, intonation, speed)


def _stop(string: int, pitch: float, intonation: Intonation, speed: float) -> Stopped:
    return Stopped(string, intonation.position(string, pitch, speed))
