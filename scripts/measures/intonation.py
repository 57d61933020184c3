"""How far sounds are from their pitches.

Strings and body ring on when a note changes. Open C5, or the other string under the same finger,
lies a fifth above a note on the F string: both together repeat after two periods of the note, so
autocorrelation is an octave too low. `overtones_off_by` finds the pitch of a short note among
what still rings of those before, by its harmonics, which differ in frequency.
"""

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from measures.shares import Share, share_line
from measures.take import Sound
from yehu_server.core.player.note_tables import OPEN_NOTES, frequency_hz
from yehu_server.playing.pitch_and_level import cents, pitch_hz

LISTEN_S = 0.06
MOMENTS_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)  # after the start of a note
SETTLED_S = 0.4
CLOSE_CENTS, FAIR_CENTS, OPEN_CENTS = 5.0, 10.0, 12.0
NONE = 9999.0
SHARP_CENTS = 50.0  # more is another register
PARTIAL_S, DECIDING = 0.04, 5  # window of a partial; how many of the first
REACH_CENTS, STEP_CENTS = 150.0, 1.0
HIGHEST_HZ, MOST = 6000.0, 12  # of the harmonics that count
MIN_OWN = 0.03  # share of the power that the harmonics must have
MIN_ODD = 0.01  # share of theirs, of those that a higher register lacks


def mean_off_by(sound: Sound, rate: float, start_s: float, seconds: float, pitch: float) -> float:
    """Return the error (cents) of a note that moves, as `off_by` does.

    Autocorrelation takes partials that rise and fall apart for a change of pitch. So where it finds
    the note itself, the pitch is that of the first partials, which decide what pitch is heard
    [Plomp]: from the slopes of their phases, as their sizes and numbers make each sure.
    """
    found = off_by(sound, rate, start_s, seconds, pitch)
    if abs(found) > SHARP_CENTS:
        return found
    wanted = frequency_hz(pitch, 440.0)
    part = sound[round(start_s * rate) : round((start_s + seconds) * rate)].astype(np.float64)
    short = np.hanning(round(PARTIAL_S * rate))
    time = np.arange(len(part)) / rate
    total = weight = 0.0
    for order in range(1, DECIDING + 1):
        hertz = order * wanted
        line = np.convolve(part * np.exp(-2j * np.pi * hertz * time), short, "valid")
        sure = np.hanning(len(line)) * np.abs(line) ** 2
        phase, at = np.unwrap(np.angle(line)), time[: len(line)]
        at = at - np.average(at, weights=sure)
        slope = (sure * at * phase).sum() / (sure * at * at).sum()
        own = order * order * sure.sum()
        total += own * cents(hertz + slope / (2.0 * np.pi), hertz)
        weight += own
    return float(total / weight)


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

    `error` gives one, with the arguments of `off_by`.
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


def judged(
    what: str,
    cases: Iterable[Sequence[float]],
    errors: Iterable[float],
    stopped: float = FAIR_CENTS,
    *,
    counts: bool = True,
) -> Share:
    """Count notes in tune, and print those that are not: a case begins with its note."""
    both = list(zip(cases, errors, strict=True))
    right = [abs(error) <= bound(case[0], stopped) for case, error in both]
    words = [f"{'/'.join(f'{x:g}' for x in case)} {in_words(error)}" for case, error in both]
    return share_line(what, right, words, counts=counts)


def overtones_off_by(
    sound: Sound, rate: float, start_s: float, seconds: float, pitch: float
) -> float:
    """Return the error (cents) of a note from its pitch (fractional MIDI note).

    It is that of the harmonic series, within 150 cents, with the largest sum of amplitudes. NONE
    where that is at an end, has less than 3 % of the power, or lacks all harmonics but the
    multiples of 2 or of 3.
    """
    part = sound[round(start_s * rate) : round((start_s + seconds) * rate)].astype(np.float64)
    heard = (part - part.mean()) * np.hanning(len(part))
    wanted = frequency_hz(pitch, 440.0)
    orders = np.arange(1, min(int(HIGHEST_HZ / wanted), MOST) + 1)
    shifts = np.arange(-REACH_CENTS, REACH_CENTS + STEP_CENTS, STEP_CENTS)
    size = 1 << (8 * len(part)).bit_length()
    spectrum = np.abs(np.fft.rfft(heard, size))
    places = wanted * 2.0 ** (shifts[:, np.newaxis] / 1200.0) * orders * size / rate
    amplitudes = np.interp(places, np.arange(len(spectrum)), spectrum)
    sums = amplitudes.sum(axis=1)
    best = int(np.argmax(sums))
    if best in (0, len(shifts) - 1) or not np.any(heard):
        return NONE
    # The power of a line, of that of its Hann window's main lobe.
    own = amplitudes[best] ** 2 * (1.5 * size / len(part))
    frequencies = np.arange(len(spectrum)) * rate / size
    within = (frequencies > 0.5 * wanted) & (frequencies < HIGHEST_HZ)
    if own.sum() < MIN_OWN * (spectrum[within] ** 2).sum():
        return NONE
    if any(own[orders % n != 0].sum() < MIN_ODD * own.sum() for n in (2, 3)):
        return NONE
    left, here, right = sums[best - 1 : best + 2]
    return float(shifts[best] + STEP_CENTS * 0.5 * (left - right) / (left - 2.0 * here + right))
