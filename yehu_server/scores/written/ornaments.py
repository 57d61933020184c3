"""Ornaments as touches of the fingers on one bow, timed by ear (docs/scores.md)."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from yehu_server.scores.phrasing import OVERLAP_S
from yehu_server.scores.slides import logistic
from yehu_server.scores.written.layout import LETTERS, STEPS, key_alter
from yehu_server.scores.written.notated import Grace, Mark, Note

GRACE_S = 0.085
GRACE_SHARE = 0.5  # of a note, at most, for all its grace notes
TAP_S = 0.075  # of a mordent's other note, and of each note of a turn
TURN_SHARE = 0.2  # of a note, at most, for each note of a turn
TRILL_S = 0.145  # from one tap to the next: some seven a second
TRILL_LAST_S = 0.07  # of the plain note that ends it
MAX_TAPS = 1000
WHOLE, HALF = 2.0, 1.0  # intervals to the notes above and below, where nothing says them
# The steps of the key from a note to the others of its ornament; their intervals are its values.
WAYS = {"trill": (1,), "mordent": (-1,), "inverted-mordent": (1,), "turn": (1, -1),
        "inverted-turn": (1, -1)}  # fmt: skip
NEAREST, FARTHEST = 0.5, 4.0  # semitones to a note of the key that an ornament touches
WIDEST = 12.0  # semitones, that a hand reaches
# By ear: a slide away takes so long, or so much of its note, and goes so far (semitones).
SLIDE_S, SLIDE_SHARE, AWAY = 0.13, 0.4, 2.0
SLIDE_STEPS = 12  # lines that its curve is made of: the share that is left, and how far it is
SLIDE = [(1.0 - at / SLIDE_STEPS, logistic(at / SLIDE_STEPS)) for at in range(SLIDE_STEPS + 1)]
STEP_S = 0.01  # between points; the finger takes 8 ms for each
LAST_S = 0.002
MAX_POINTS = 3000
LEAST_BEND, WIDEST_BEND = 1e-4, 24.0  # semitones
Array = Any
Curve = list[tuple[float, float]]
Around = tuple[float, float]  # semitones to the notes above and below
Alters = dict[tuple[str, int], float]  # the accidentals of a bar, by letters and octaves
# A finger on a string: from and to which second of the score, and at which pitch (MIDI note).
Touch = tuple[float, float, float]


def around(degree: int, own: float, pitch_of: Callable[[int], float]) -> Around:
    """The intervals from a note to its neighbours in a scale, of which `pitch_of` has the degrees.

    Where a neighbour is no other note, or too far, it is a whole tone.
    """
    up, down = pitch_of(degree + 1) - own, own - pitch_of(degree - 1)
    return _near(up), _near(down)


def _near(interval: float) -> float:
    return interval if NEAREST <= interval <= FARTHEST else WHOLE


def around_letter(
    letter: str, octave: int, alter: float, alter_of: Callable[[str, int], float]
) -> Around:
    """The intervals to the notes on the next lines of a staff.

    `alter_of` is the accidental that holds for a letter in an octave, by the bar or the key.
    """
    at = LETTERS.index(letter)
    alters = [alter_of(LETTERS[to % 7], octave + to // 7) for to in (at - 1, at + 1)]
    return _around_step(at, alter, *alters)


@lru_cache(maxsize=4096)
def _around_step(at: int, alter: float, below: float, above: float) -> Around:
    """The intervals from a letter to its neighbours, by their accidentals."""
    alters = {at - 1: below, at + 1: above}

    def pitch_of(degree: int) -> float:
        octaves, to = divmod(degree, 7)
        return 12.0 * octaves + STEPS[to] + alters[degree]

    return around(at, STEPS[at] + alter, pitch_of)


def around_in(
    place: tuple[str, int, float], alters: Alters, fifths: int, alter: float | None = None
) -> Around:
    """The intervals from a note, its letter, octave and accidental, to its neighbours in a bar.

    `alter` is the accidental of both, where one is written over the ornament.
    """

    def alter_of(letter: str, octave: int) -> float:
        own = alters.get((letter, octave)) if alter is None else alter
        return key_alter(LETTERS.index(letter), fifths) if own is None else own

    return around_letter(*place, alter_of)


def filled(mark: Mark, intervals: Around) -> Mark:
    """A mark, with the intervals that an ornament does not say of itself."""
    return _filled(mark, intervals) if mark.name in WAYS else mark


@lru_cache(maxsize=4096)
def _filled(mark: Mark, intervals: Around) -> Mark:
    ways = zip(WAYS[mark.name], (mark.value, mark.second), strict=False)
    return Mark(mark.name, *(intervals[way < 0] if own is None else own for way, own in ways))


def touches_of(note: Note, begin_s: float, end_s: float) -> list[Touch]:
    """Return the touches of a note, its own among them, in the order of their beginnings."""
    if not (note.before or note.after):
        return _ornamented(note, begin_s, end_s)
    length_s = end_s - begin_s
    before = _graces(note.before, begin_s, length_s)
    after = _graces(note.after, end_s, length_s, backwards=True)
    first = before[-1][1] if before else begin_s
    last = after[0][0] if after else end_s
    main = _ornamented(note, first, last)
    if after:  # the note sounds until the first of the small ones holds
        main[0] = first, last + min(OVERLAP_S, 0.5 * (after[0][1] - last)), note.pitch
    return [*map(_held_over, before), *main, *map(_held_over, after[:-1]), *after[-1:]]


def _held_over(touch: Touch) -> Touch:
    begin_s, end_s, pitch = touch
    return begin_s, end_s + min(OVERLAP_S, 0.5 * (end_s - begin_s)), pitch


def _graces(
    graces: Sequence[Grace], at_s: float, length_s: float, *, backwards: bool = False
) -> list[Touch]:
    """Grace notes one after another from a time on, or up to it."""
    if not graces:
        return []
    each_s = min(GRACE_S, GRACE_SHARE * length_s / len(graces))
    begin = at_s - each_s * len(graces) if backwards else at_s
    return [
        (begin + each_s * number, begin + each_s * (number + 1), grace.pitch)
        for number, grace in enumerate(graces)
    ]


@lru_cache(maxsize=4096)
def _steps(marks: tuple[Mark, ...]) -> tuple[str, list[float]]:
    """The first ornament among marks, and the semitones to its other notes; "" for none."""
    for mark in marks:
        if mark.name in WAYS:
            values = filled(mark, (WHOLE, HALF))
            steps = zip(WAYS[mark.name], (values.value, values.second), strict=False)
            bounded = [way * min(max(step or 0.0, -WIDEST), WIDEST) for way, step in steps]
            return mark.name, bounded[::-1] if mark.name == "inverted-turn" else bounded
    return "", []


def _ornamented(note: Note, begin_s: float, end_s: float) -> list[Touch]:
    """The note itself, held all along, and what other fingers touch meanwhile."""
    pitch, length_s = note.pitch, end_s - begin_s
    held = begin_s, end_s, pitch
    name, steps = _steps(note.marks) if note.marks else ("", [])
    if name == "trill":
        return [held, *_trill(begin_s, length_s, pitch + steps[0])]
    if len(steps) > 1:  # other, own, opposite, own: the own note is held under the other two
        tap_s = min(TAP_S, TURN_SHARE * length_s)
        first = begin_s, begin_s + tap_s, pitch + steps[0]
        return [held, first, (begin_s + 2.0 * tap_s, begin_s + 3.0 * tap_s, pitch + steps[1])]
    if steps:
        tap_s = min(TAP_S, length_s / 4.0)
        return [held, (begin_s + tap_s, begin_s + 2.0 * tap_s, pitch + steps[0])]
    return [held]


def _trill(begin_s: float, length_s: float, pitch: float) -> list[Touch]:
    """Taps at a steady pace from the own note, with a plain end where there is time for one."""
    room_s = length_s - TRILL_LAST_S
    count = min(max(int(room_s / TRILL_S), 1), MAX_TAPS)
    each_s = min(room_s / count if room_s >= TRILL_S else 0.6 * length_s, 1.5 * TRILL_S)
    return [
        (begin_s + each_s * (number + 0.5), begin_s + each_s * (number + 1.0), pitch)
        for number in range(count)
    ]


def curves_of(notes: Iterable[tuple[Note, float, float]]) -> dict[int, Curve]:
    """The semitones from notes' pitches at seconds, from their beginnings on, of those that move.

    Each note comes with the seconds of its beginning and its end; a curve, by the note's number.
    """
    curves: dict[int, Curve] = {}
    alike: dict[tuple[int, int], list[tuple[int, float, float, Curve]]] = defaultdict(list)
    for number, (note, begin_s, end_s) in enumerate(notes):
        if not (note.contour or note.marks):
            continue
        length_s = end_s - begin_s
        points = _points_of(note, begin_s, end_s) if length_s > LAST_S else []
        if points:
            count = min(max(int(length_s / STEP_S), 1), MAX_POINTS)
            alike[len(points), count].append((number, begin_s, end_s, points))
    for (_, count), same in alike.items():
        numbers, *columns = zip(*same, strict=True)
        times_s, bends = (each.tolist() for each in _sampled(count, *map(np.array, columns)))
        for number, at_s, bend in zip(numbers, times_s, bends, strict=True):
            curves[number] = _moving(zip(at_s, bend, strict=True))
    return curves


def _points_of(note: Note, begin_s: float, end_s: float) -> Curve:
    """The corners of a note's curve, if it has one."""
    if note.contour:
        length_s = end_s - begin_s
        points = [(begin_s + share * length_s, bend) for share, bend in note.contour]
        return points if points[0][0] <= begin_s else [(begin_s, points[0][1]), *points]
    names = note.names
    way = AWAY * (("slide-out-up" in names) - ("slide-out-down" in names))
    if not way:
        return []
    slide_s = min(SLIDE_S, SLIDE_SHARE * (end_s - begin_s))
    return [(begin_s, 0.0), *((end_s - rest * slide_s, way * done) for rest, done in SLIDE)]


def _sampled(count: int, begin_s: Array, end_s: Array, points: Array) -> tuple[Array, Array]:
    """Curves at even steps: seconds, and semitones, on the lines between their corners."""
    begin_s, end_s = begin_s[:, None], end_s[:, None]
    times_s = begin_s + (end_s - begin_s) * np.arange(count + 1) / count
    corners, bends = points[:, :, 0], points[:, :, 1]
    after = sum(corner[:, None] <= times_s for corner in corners.T).astype(np.int64)
    last = corners.shape[1] - 1
    at, to = np.clip(after - 1, 0, last), np.clip(after, 0, last)
    begin, end = (np.take_along_axis(corners, place, 1) for place in (at, to))
    first, then = (np.take_along_axis(bends, place, 1) for place in (at, to))
    share = (then - first) * (times_s - begin) / np.where(at == to, 1.0, end - begin)
    bend = np.clip(first + share, -WIDEST_BEND, WIDEST_BEND)
    return np.minimum(times_s, end_s - LAST_S), bend  # before the next note begins


def _moving(samples: Iterable[tuple[float, float]]) -> Curve:
    """The samples of a curve that differ from those before; none where it stays at 0."""
    curve: Curve = []
    last = math.inf
    for at_s, bend in samples:
        if abs(bend - last) > LEAST_BEND:
            curve.append((at_s, bend))
            last = bend
    return curve if len(curve) > 1 or curve[0][1] != 0.0 else []
