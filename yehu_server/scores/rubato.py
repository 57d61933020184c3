"""Rubato: a tempo that is slower where a phrase begins and ends, and at the end of the score.

All parts move together, by the phrases of the leading one. A phrase begins where it is written:
the time that its ends take is regained in its middle. Arches of tempo: [Friberg], [Todd]; the end:
[FribergSundberg]. Amounts are small, by ear.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.scores.events import NoteColumns
from yehu_server.scores.score import Score, phrase_starts

Array = Any

# At full rubato: a beat at either end of a phrase is two thirds of this longer, one in its middle a
# third shorter.
ARCH = 0.08
MIN_NOTES, MIN_S, POINTS = 4, 1.5, 16  # of a phrase with an arch; lines that this is made of
# The last beats before the last note are up to so much longer; so is that, for a beat at most.
LAST, LAST_BEATS = 0.2, 2.0
# A file is in time where nearly all onsets are on a grid: the parts of a quarter, and how near.
GRID, NEAR, IN_TIME = 24, 2e-3, 0.95
SAME_TEMPO, STEADY_BEATS = 0.02, 8.0  # a change of tempo; at most one in so many quarters

Delays = tuple[tuple[float, float], ...]


def midi_delays(score: Score, tune: Score) -> Delays:
    """The delays of a MIDI file, where its notes are in time and its tempo is not shaped itself.

    `tune` has the notes of the part that leads.
    """
    notes = _melodic(score)
    if not is_in_time(notes):
        return ()
    return delays_of(notes if tune is score else _melodic(tune))


def _melodic(score: Score) -> NoteColumns:
    notes = score.note_columns
    return notes.where(notes.channel != PERCUSSION_CHANNEL)


def is_in_time(notes: NoteColumns) -> bool:
    """Whether notes were written by a machine: on a grid, and in a tempo that hardly changes."""
    places, count = GRID * notes.beat, len(notes.beat)
    near = np.count_nonzero(np.abs(places - np.rint(places)) < NEAR * GRID)
    if not count or near < IN_TIME * count:
        return False
    tempi = _tempi(notes)
    changes = int(np.count_nonzero(np.abs(np.diff(tempi)) > SAME_TEMPO * tempi[:-1]))
    return changes * STEADY_BEATS <= max(float(notes.beat[-1] - notes.beat[0]), STEADY_BEATS)


def delays_of(notes: NoteColumns) -> Delays:
    """The delays of a score at full rubato: points of seconds as written and delays (s), in order.

    `notes`: of the part that leads. Between the points are straight lines.
    """
    points: list[tuple[float, float]] = []
    starts_s, ends_s, beats = (each.tolist() for each in (notes.start_s, notes.end_s, notes.beat))
    starts = phrase_starts(starts_s, ends_s, beats)
    for first, after in pairwise([*starts, len(beats)]):
        begin, length = starts_s[first], ends_s[after - 1] - starts_s[first]
        if after - first < MIN_NOTES or length < MIN_S:
            continue
        for step in range(POINTS + 1):
            to_end = 2.0 * step / POINTS - 1.0  # the integral of the square less a third
            delay = ARCH * length * to_end * (to_end * to_end - 1.0) / 6
            points.append((begin + length * step / POINTS, delay))
    return _with_end(notes, points)


def _with_end(notes: NoteColumns, points: list[tuple[float, float]]) -> Delays:
    """The delays with those of the last beats added, where their tempo is steady."""
    if len(notes.beat) < MIN_NOTES:
        return tuple(points)
    close = notes.where(notes.beat > notes.beat[-1] - 2.0 * LAST_BEATS - NEAR)
    tempi = _tempi(close).tolist()
    if not (tempi and 0.0 < max(tempi) <= (1.0 + SAME_TEMPO) * min(tempi)):
        return tuple(points)
    last_s, quarter_s = float(notes.start_s[-1]), tempi[-1]
    begin = last_s - LAST_BEATS * quarter_s
    if begin < notes.start_s[0]:
        return tuple(points)
    held_s = min(float(notes.end_s[-1]) - last_s, quarter_s)
    at = sorted({
        *(begin + (last_s - begin) * step / POINTS for step in range(POINTS + 1)),
        last_s + held_s,
        *(seconds for seconds, _ in points if seconds > begin),
    })  # fmt: skip
    before = [point for point in points if point[0] < begin]
    after = [(s, at_time(points, s) + _slowed(s, begin, last_s, held_s)) for s in at]
    return (*before, *after)


def _slowed(seconds: float, begin: float, last: float, held_s: float) -> float:
    """The delay of the last beats, whose tempo sinks with the square of time."""
    share = min((seconds - begin) / (last - begin), 1.0)
    return LAST * (
        (last - begin) * share * share * share / 3.0 + min(max(seconds - last, 0.0), held_s)
    )


def _tempi(notes: NoteColumns) -> Array:
    """The length of a quarter (s), from each note to the next."""
    is_later = notes.beat[1:] > notes.beat[:-1] + NEAR
    return np.diff(notes.start_s)[is_later] / np.diff(notes.beat)[is_later]


def at_time(points: Sequence[tuple[float, float]], seconds: float) -> float:
    """The value at a time on the lines between points; beyond them, that of the nearest."""
    after = bisect_right(points, (seconds, float("inf")))
    if not points or after == 0:
        return points[0][1] if points else 0.0
    if after == len(points):
        return points[-1][1]
    (begin, first), (end, last) = points[after - 1], points[after]
    return first + (last - first) * (seconds - begin) / (end - begin)


def delayed(score: Score, amount: float) -> Score:
    """Return a score with rubato of an amount, 0 to 1; at 0 as it is."""
    if amount == 0.0 or not score.delays:
        return score

    def played(seconds: float) -> float:
        return seconds + amount * at_time(score.delays, seconds)

    times = np.array([played(time_s) for time_s in score.events.time_s.tolist()])
    events = replace(score.events, time_s=times)
    return replace(score, events=events, duration_s=played(score.duration_s), delays=())
