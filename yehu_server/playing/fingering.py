"""Which string takes a pitch, and where the finger goes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from yehu_server.playing.calibration import OPEN_NOTES
from yehu_server.playing.intonation import Intonation

LOWEST_NOTE, HIGHEST_NOTE = 65, 89  # F4 to F6
# Semitones about an open string that need no finger: nearer to the loop than 8 mm, which is
# this much, no finger fits.
OPEN_WITHIN = 0.45
ON_PITCH_WITHIN = 0.05
# Farther up the F string notes jump and scratch: bowed at four speeds and three pressures, F5 and
# G5 hold in none to a third of the cases, up to E5 in four fifths at least.
HIGHEST_ON_F = 76.5


class RangePolicy(Enum):
    """What happens to a note the instrument does not have."""

    TRANSPOSE = "transpose"
    CLAMP = "clamp"
    SKIP = "skip"

    def fit(self, note: float) -> float | None:
        """Return the note to play instead of `note`, or None for none.

        One that a tuning has put less than a quarter tone beyond an end is the last there is.
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
    """When the open C string sounds; below the first finger on the F string there is no choice."""

    ALWAYS = "always"  # wherever no finger fits on the C string
    ON_PITCH = "on-pitch"
    NEVER = "never"

    def takes(self, pitch: float) -> bool:
        """Whether a pitch is played on the open C string."""
        within = {OpenStrings.ALWAYS: OPEN_WITHIN, OpenStrings.ON_PITCH: ON_PITCH_WITHIN}
        return abs(pitch - OPEN_NOTES[1]) < within.get(self, 0.0)


@dataclass(frozen=True)
class Fingering:
    """A string (0: F4, 1: C5) and the finger's place on it (m); None for an open string."""

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
    """Finger a pitch (fractional MIDI note) for a bow of some speed (m/s).

    Below C5 there is only the F string; from C5 up the C string, unless the finger is down
    on the F string (`hand`) and has a shorter way to the pitch there, not too far up. A string
    wished for is taken wherever it has the pitch.
    """
    if pitch < OPEN_NOTES[0] + OPEN_WITHIN:
        return Fingering(0, None)  # the lowest there is
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
    """Follow a bent pitch on the string it sounds on, as far as that goes.

    Below the open C string it goes on on the F string, and far up the F string on the C, unless
    the F string is wished for.
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
