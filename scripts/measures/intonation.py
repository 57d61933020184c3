"""How far sounds are from their pitches."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from measures.take import Sound
from yehu_server.core.player.calibration import OPEN_NOTES, frequency_hz
from yehu_server.playing.pitch_and_level import cents, pitch_hz

LISTEN_S = 0.06
MOMENTS_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)  # after the start of a note
SETTLED_S = 0.4
CLOSE_CENTS, FAIR_CENTS, OPEN_CENTS = 5.0, 10.0, 12.0
NONE = 9999.0


def off_by(sound: Sound, rate: float, start_s: float, seconds: float, pitch: float) -> float:
    """Return the error (cents) from a pitch (fractional MIDI note); NONE if no pitch is found.

    Where the pitch moves it is that of its mean, in which the middle of the time counts most.
    """
    wanted = frequency_hz(pitch, 440.0)
    part = sound[round(start_s * rate) : round((start_s + seconds) * rate)]
    found = pitch_hz(part, rate, lo=0.4 * wanted, hi=3.2 * wanted)
    return cents(found, wanted) if math.isfinite(found) else NONE


def errors_of(
    sound: Sound,
    rate: float,
    note: float,
    start_s: float,
    seconds: float,
    error: Callable[..., float] = off_by,
) -> list[float]:
    """Return the errors (cents) of a note at those of MOMENTS_S that it is long enough for.

    `error` tells one, with the arguments of `off_by`.
    """
    moments = [moment for moment in MOMENTS_S if moment + LISTEN_S <= seconds + 1e-9]
    return [error(sound, rate, start_s + moment, LISTEN_S, note) for moment in moments]


def worst(errors: Sequence[float]) -> float:
    """Return the largest error, with its sign."""
    return max(errors, key=abs)


def bound(note: float, stopped: float = FAIR_CENTS) -> float:
    """Return the largest error (cents) with which a note counts as in tune.

    No finger tunes an open string; a stopped note has a bound of `stopped`.
    """
    return OPEN_CENTS if note in OPEN_NOTES else stopped


def in_words(error: float) -> str:
    """Write an error (cents)."""
    return "no pitch" if error == NONE else f"{error:+.0f}"
