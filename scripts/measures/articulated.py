"""How articulations come out, at three tempi and three dynamics, and whether as is stated."""

import math
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from measures.heard import Figures, figures, heard
from measures.take import Setup, Take, in_parallel
from yehu_server.params.articulations import ARTICULATIONS, NUMBER

NOTES = (67, 70, 72, 74, 76, 79, 83, 86)
OTHER_NOTES = (66, 69, 71, 73, 75, 77, 81, 84, 88)  # to judge what was mended with NOTES
LENGTHS_S = (0.25, 0.5, 1.2)
VELOCITIES = (40, 80, 120)
REST_S, BEGIN_S = 0.15, 0.05
# A note is wrong that is off its pitches for more of its loud time (%), or softer by so much (dB)
# than the median of those played alike.
MAX_OFF, SOFT_DB = 8.0, 8.0

HERE = (0.0, 0.0)
Range = tuple[float, float, float]  # lowest, highest, and the shortest notes (s) that it holds for


@dataclass(frozen=True)
class Stated:
    """What an articulation should come to.

    `may`: between which pitches (semitones) it may be.
    `ranges`: by the names of `Figures`: what their median lies in.
    `source`: where that is from.
    """

    ranges: dict[str, Range]
    may: tuple[float, float] = HERE
    source: str = "by ear"


def _ranges(**given: tuple[float, ...]) -> dict[str, Range]:
    return {name: (*value, 0.0)[:3] for name, value in given.items()}  # type: ignore[misc]


RECORDED = "recordings of an erhu, a violin and a cello"
STATED: dict[str, Stated] = {
    "ordinary": Stated(_ranges(rise=(15, 290), sounds=(85, 101)), source=f"rise: {RECORDED}"),
    "short": Stated(_ranges(sounds=(45, 85))),
    "staccato": Stated(_ranges(sounds=(35, 75), fade=(12, 60))),
    "spiccato": Stated(_ranges(rise=(5, 60), lasts=(60, 300), fade=(10, 60, 0.5))),
    "ricochet": Stated(_ranges(strokes=(3, 5, 0.5), stroke_rate=(7, 14, 0.5))),
    "tremolo": Stated(_ranges(stroke_rate=(12, 15), dip=(9, 18)), source=RECORDED),
    "padded": Stated(_ranges(strokes=(2, 2), dip=(3, 20))),
    "sforzando": Stated(_ranges(loudest=(0, 0.35, 0.5), fade=(4, 14, 0.5))),
    "swell": Stated(_ranges(loudest=(0.35, 0.7, 1.0), swell=(6, 16, 1.0))),
    "pizzicato": Stated(_ranges(rise=(0, 25), fade=(8, 60, 0.5))),
    "straight": Stated(_ranges(width=(0, 12))),
    "rolling-vibrato": Stated(
        _ranges(width=(39, 105, 1.0), beat_rate=(4.5, 7, 1.0)), (-0.6, 0.6), RECORDED
    ),
    "pressing-vibrato": Stated(
        _ranges(width=(39, 105, 1.0), beat_rate=(4.5, 6.5, 1.0), low=(-0.2, 0.1)),
        (0, 1),
        RECORDED,
    ),
    "sliding-vibrato": Stated(
        _ranges(width=(80, 180, 1.0), beat_rate=(3.5, 5, 1.0)), (-1, 1), "by ear"
    ),
    "slide-up": Stated(
        _ranges(begins=(-2.3, -1.2), ends=(-0.2, 0.2), arrives=(60, 190)), (-2, 0)
    ),
    "large-slide-up": Stated(
        _ranges(begins=(-4.3, -2.8), ends=(-0.2, 0.2), arrives=(90, 300)), (-4, 0)
    ),
    "slide-down": Stated(
        _ranges(begins=(1.2, 2.3), ends=(-0.2, 0.2), arrives=(60, 190)), (0, 2)
    ),
    "turning-slide": Stated(
        _ranges(begins=(-0.2, 0.2), high=(1.6, 2.2), ends=(-0.25, 0.25)), (0, 2)
    ),
    "fall": Stated(_ranges(begins=(-0.2, 0.2), ends=(-3.3, -1.5)), (-3, 0)),
    "mordent": Stated(
        _ranges(begins=(-0.2, 0.2), ends=(-0.2, 0.2), high=(1.5, 2.3, 0.0), beats=(1, 2)), (0, 2)
    ),
    "trill": Stated(
        _ranges(beat_rate=(5.5, 9, 0.5), width=(150, 250, 0.5), high=(1.7, 2.3)), (0, 2)
    ),
    "wide-trill": Stated(
        _ranges(beat_rate=(5.5, 9, 0.5), width=(240, 360, 0.5), high=(2.6, 3.4)), (0, 3)
    ),
    "passed-slide": Stated(
        _ranges(begins=(-3.3, -1.8), ends=(-0.2, 0.2), arrives=(80, 260)), (-3, 0)
    ),
    "left-hand-pizzicato": Stated(_ranges(rise=(0, 25), fade=(8, 60, 0.5))),
    "flageolet": Stated(_ranges(sounds=(85, 101)), (0, 12)),
    "wavering": Stated(
        _ranges(low=(-0.7, -0.1, 0.5), high=(0.3, 0.9, 0.5), beat_rate=(2, 4, 1.0)), (-0.6, 0.8)
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Way:
    """An articulation at one tempo and one velocity."""

    name: str
    length_s: float
    velocity: int


@dataclass(frozen=True)
class Found:
    """What came of it: the median of each figure, the notes that are wrong, and ranges missed."""

    way: Way
    median: dict[str, float]
    wrong: tuple[str, ...]
    missed: tuple[str, ...] = field(default=())


def play(
    setup: Setup, way: Way, notes: tuple[int, ...], **settings: float
) -> tuple[Any, list[float]]:
    """Play notes apart from each other; return the sound and when each begins (s)."""
    values = {f"/playing/{name}": value for name, value in settings.items()}
    values |= {"/playing/articulation": float(NUMBER[way.name]), "/playing/vibrato": 0.0}
    take = Take(setup, settings=values)
    begins = [BEGIN_S + i * (way.length_s + REST_S) for i in range(len(notes))]
    for begin, note in zip(begins, notes, strict=True):
        take.long(begin, way.length_s)
        take.on(begin, note, way.velocity)
        take.off(begin + way.length_s, note)
    return take.play(begins[-1] + way.length_s + REST_S), begins


def heard_figures(setup: Setup, way: Way, notes: tuple[int, ...]) -> list[Figures]:
    """Play notes and return what is heard of each."""
    sound, begins = play(setup, way, notes)
    track = heard(sound, setup.rate)
    may = STATED[way.name].may
    return [
        figures(track, begin, way.length_s, note, may)
        for begin, note in zip(begins, notes, strict=True)
    ]


def judged(way: Way, notes: tuple[int, ...], rows: list[Figures]) -> Found:
    """Compare what is heard with what is stated."""
    columns = {name: np.array([asdict(row)[name] for row in rows]) for name in asdict(rows[0])}
    median = {name: _median(values) for name, values in columns.items()}
    wrong = [
        f"{note} off {off:.0f} %"
        if off > MAX_OFF
        else f"{note} soft {level - median['level']:.0f} dB"
        for note, off, level in zip(notes, columns["off"], columns["level"], strict=True)
        if off > MAX_OFF or level < median["level"] - SOFT_DB
    ]
    missed = [
        f"{name} {median[name]:.3g} not {low:g} to {high:g}"
        for name, (low, high, least_s) in STATED[way.name].ranges.items()
        if way.length_s >= least_s and not low <= median[name] <= high
    ]
    return Found(way, median, tuple(wrong), tuple(missed))


def _median(values: Any) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else math.nan


def all_found(setup: Setup, notes: tuple[int, ...], names: list[str] | None = None) -> list[Found]:
    """Measure articulations, all by default, in all ways."""
    ways = [
        Way(name, length_s, velocity)
        for name in names or [each.name for each in ARTICULATIONS]
        for length_s in LENGTHS_S
        for velocity in VELOCITIES
    ]
    rows = in_parallel(setup, heard_figures, [(way, notes) for way in ways])
    return [judged(way, notes, row) for way, row in zip(ways, rows, strict=True)]
