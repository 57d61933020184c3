"""`evenness`, `velocity`: how loud notes are, from one to the next and from soft to loud."""

import math
from dataclasses import dataclass

import numpy as np

from measures.shares import Share, share_line
from measures.take import NOTES, Setup, Sound, held, in_parallel
from yehu_server.params.table import find
from yehu_server.playing.mapping import DEFAULT, load, shipped_mappings
from yehu_server.playing.pitch_and_level import a_weighted_db

STEADY_S, END_S = 0.3, 0.8
RMS_S = 0.01
DYNAMICS = ((None, 80), (0, 80), (64, 110), (127, 127))  # wheel and velocity
EVEN_DB = 2.0
STRUCK = (1, 20, 50, 80, 110, 127)
SOFT, MEDIUM, HARD = STRUCK.index(20), STRUCK.index(80), STRUCK.index(127)
MIN_RISE_DB, MAX_RISE_DB, MIN_ABOVE_DB = 16.0, 24.0, 3.0
BRIGHTER = 1.1  # the centroid of a hard note, as a factor on that of a soft one
LIMITER = 10.0 ** (find("/output/limiter").default / 20.0)  # amplitude above which it acts


@dataclass(frozen=True)
class Timbre:
    """What a note sounds like."""

    level_db: float  # A-weighted, from 0.3 s on
    centroid_hz: float  # from 0.3 s on
    attack_ms: float
    peak: float  # largest sample


def centroid_hz(sound: Sound, rate: float) -> float:
    """Return the spectral centroid (Hz): the mean frequency, by power."""
    heard = sound.astype(np.float64)
    power = np.abs(np.fft.rfft(heard * np.hanning(len(heard)))) ** 2
    return float((np.fft.rfftfreq(len(heard), 1.0 / rate) * power).sum() / power.sum())


def attack_ms(sound: Sound, rate: float) -> float:
    """Return the time (ms) to within 6 dB of the steady level: the middle of 10 ms of sound."""
    window = round(RMS_S * rate)
    energy = np.cumsum(np.concatenate(([0.0], sound.astype(np.float64) ** 2)))
    level = np.sqrt((energy[window:] - energy[:-window]) / window)
    steady = math.sqrt(float(np.mean(sound[round(STEADY_S * rate) :].astype(np.float64) ** 2)))
    first = int(np.argmax(level >= 0.5 * steady))
    return 1e3 * (first + 0.5 * window) / rate


def timbre(
    setup: Setup, note: int, wheel: int | None, velocity: int, mapping: str = DEFAULT
) -> Timbre:
    """Play a note and return what it sounds like."""
    sound, _ = held(setup, note, velocity, END_S, wheel, mapping=mapping)
    steady = sound[round(STEADY_S * setup.rate) :]
    return Timbre(
        a_weighted_db(steady, setup.rate),
        centroid_hz(steady, setup.rate),
        attack_ms(sound, setup.rate),
        float(np.abs(sound).max()),
    )


def evenness(setup: Setup) -> list[Share]:
    """Print the loudness range of all notes, and the largest difference of neighbours."""
    parts = []
    for wheel, velocity in DYNAMICS:
        jobs = [(note, wheel, velocity) for note in NOTES]
        levels = np.array([each.level_db for each in in_parallel(setup, timbre, jobs)])
        name = f"wheel {'untouched' if wheel is None else wheel}, velocity {velocity}"
        print(
            f"{name}: within {np.ptp(levels):.1f} dB, "
            f"neighbours {np.abs(np.diff(levels)).max():.1f} dB"
        )
        offsets = levels - np.median(levels)
        words = [f"{note} {off:+.1f} dB" for note, off in zip(NOTES, offsets, strict=True)]
        parts.append(share_line(name, np.abs(offsets) <= EVEN_DB, words))
    return parts


def _rises(note: int, row: list[Timbre]) -> bool:
    """Print a note from soft to loud; return whether its level rises as it should."""
    levels = [each.level_db for each in row]
    rise, above = levels[-1] - levels[0], levels[HARD] - levels[MEDIUM]
    is_right = MIN_RISE_DB <= rise <= MAX_RISE_DB and above >= MIN_ABOVE_DB
    limited = [str(v) for v, each in zip(STRUCK, row, strict=True) if each.peak > LIMITER]
    print(
        f"{note}: {' '.join(f'{level:6.1f}' for level in levels)} dB; "
        f"{rise:.1f} in all, {above:.1f} above 80; "
        f"centroid {row[SOFT].centroid_hz:.0f} to {row[HARD].centroid_hz:.0f} Hz, "
        f"attack {row[SOFT].attack_ms:.0f} to {row[HARD].attack_ms:.0f} ms"
        f"{'' if is_right else ' !'}{', limited at ' if limited else ''}{' '.join(limited)}"
    )
    return is_right


def _brightness(rows: list[list[Timbre]]) -> list[Share]:
    """Print whether centroids rise enough from soft to hard, and with each velocity."""
    hz = np.array([[each.centroid_hz for each in row[SOFT:]] for row in rows])
    steps = hz[:, 1:] / hz[:, :-1]
    in_all = hz[:, -1] / hz[:, 0]
    words = [f"{note} {ratio:.2f}" for note, ratio in zip(NOTES, in_all, strict=True)]
    least = [f"{note} {ratio:.3f}" for note, ratio in zip(NOTES, steps.min(axis=1), strict=True)]
    return [
        share_line(f"brighter {BRIGHTER:g} times or more", in_all >= BRIGHTER, words),
        share_line("brighter with each velocity", steps.min(axis=1) > 1.0, least),
    ]


def velocity(setup: Setup) -> list[Share]:
    """Print how each note's level rises with velocity, in each mapping that binds it.

    Level (dB, A-weighted) at six velocities; spectral centroid (Hz) and attack (ms) at 20 and
    127; and the velocities at which a peak was above the threshold of the output's limiter. With
    the default mapping also how many notes become brighter.
    """
    parts = []
    for name in shipped_mappings():
        if not load(name).of("velocity"):
            continue
        print(f"{name}:")
        jobs = [(note, None, struck, name) for note in NOTES for struck in STRUCK]
        found: list[Timbre] = in_parallel(setup, timbre, jobs)
        rows = [found[i : i + len(STRUCK)] for i in range(0, len(found), len(STRUCK))]
        right = [_rises(note, row) for note, row in zip(NOTES, rows, strict=True)]
        ratios = [row[HARD].centroid_hz / row[SOFT].centroid_hz for row in rows]
        sooner = [row[SOFT].attack_ms - row[HARD].attack_ms for row in rows]
        print(
            f"medians: rise {np.median([r[-1].level_db - r[0].level_db for r in rows]):.1f} dB, "
            f"above 80 {np.median([r[HARD].level_db - r[MEDIUM].level_db for r in rows]):.1f} dB, "
            f"centroid times {np.median(ratios):.2f}, attack {np.median(sooner):.0f} ms sooner; "
            f"limited in {sum(each.peak > LIMITER for each in found)} of {len(found)} notes"
        )
        words = [str(note) for note in NOTES]
        parts.append(share_line(name, right, words))
        if name == DEFAULT:
            parts += _brightness(rows)
    return parts
