"""Ornaments as touches of the fingers on one bow, timed by ear (docs/scores.md)."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from yehu_server.scores.phrasing import OVERLAP_S
from yehu_server.scores.rubato import at_time
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
AWAYS = {"slide-out-up", "slide-out-down"}
SLIDE_STEPS = 12  # lines that its curve is made of
STEP_S = 0.01  # between points; the finger takes 8 ms for each
LAST_S = 0.002
MAX_POINTS = 3000
WIDEST_BEND = 24.0  # semitones
Curve = list[tuple[float, float]]
Around = tuple[float, float]  # semitones to the notes above and below
Alters = dict[tuple[str, int], float]  # the accidentals of a bar, by letters and octaves


class Touch(NamedTuple):
    """A finger on a string: seconds from the start of the score, and a pitch (MIDI note)."""

    begin_s: float
    end_s: float
    pitch: float


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

    def pitch_of(degree: int) -> float:
        octaves, at = divmod(degree, 7)
        return 12.0 * octaves + STEPS[at] + alter_of(LETTERS[at], octave + octaves)

    at = LETTERS.index(letter)
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
    said = (mark.value, mark.second)
    ways = zip(WAYS.get(mark.name, ()), said, strict=False)
    values = [intervals[way < 0] if value is None else value for way, value in ways]
    return Mark(mark.name, *values) if values else mark


def touches_of(note: Note, begin_s: float, end_s: float) -> list[Touch]:
    """Return the touches of a note, its own among them, in the order of their beginnings."""
    if not (note.before or note.after) and note.names.isdisjoint(WAYS):
        return [Touch(begin_s, end_s, note.pitch)]
    length_s = end_s - begin_s
    before = _graces(note.before, begin_s, length_s)
    after = _graces(note.after, end_s, length_s, backwards=True)
    first = before[-1].end_s if before else begin_s
    last = after[0].begin_s if after else end_s
    main = _ornamented(note, first, last)
    if after:  # the note sounds until the first of the small ones holds
        main[0] = main[0]._replace(end_s=last + min(OVERLAP_S, 0.5 * (after[0].end_s - last)))
    before = [each._replace(end_s=each.end_s + _overlap(each)) for each in before]
    after = [each._replace(end_s=each.end_s + _overlap(each)) for each in after[:-1]] + after[-1:]
    return [*before, *main, *after]


def _overlap(touch: Touch) -> float:
    return min(OVERLAP_S, 0.5 * (touch.end_s - touch.begin_s))


def _graces(
    graces: Sequence[Grace], at_s: float, length_s: float, *, backwards: bool = False
) -> list[Touch]:
    """Grace notes one after another from a time on, or up to it."""
    if not graces:
        return []
    each_s = min(GRACE_S, GRACE_SHARE * length_s / len(graces))
    begin = at_s - each_s * len(graces) if backwards else at_s
    return [
        Touch(begin + each_s * number, begin + each_s * (number + 1), grace.pitch)
        for number, grace in enumerate(graces)
    ]


def _ornamented(note: Note, begin_s: float, end_s: float) -> list[Touch]:
    """The note itself, held all along, and what other fingers touch meanwhile."""
    held = Touch(begin_s, end_s, note.pitch)
    for mark in note.marks:
        if mark.name not in WAYS:
            continue
        values = filled(mark, (WHOLE, HALF))
        steps = [
            way * min(max(step or 0.0, -WIDEST), WIDEST)
            for way, step in zip(WAYS[mark.name], (values.value, values.second), strict=False)
        ]
        if mark.name == "trill":
            return [held, *_trill(held, *steps)]
        if len(steps) > 1:
            return _turn(held, steps if mark.name == "turn" else steps[::-1])
        tap_s = min(TAP_S, (end_s - begin_s) / 4.0)
        return [held, Touch(begin_s + tap_s, begin_s + 2.0 * tap_s, note.pitch + steps[0])]
    return [held]


def _turn(held: Touch, steps: Sequence[float]) -> list[Touch]:
    """Other, own, opposite, own: the own note is held under the other two."""
    tap_s = min(TAP_S, TURN_SHARE * (held.end_s - held.begin_s))
    at = held.begin_s
    first = Touch(at, at + tap_s, held.pitch + steps[0])
    second = Touch(at + 2.0 * tap_s, at + 3.0 * tap_s, held.pitch + steps[1])
    return [held, first, second]


def _trill(held: Touch, step: float) -> list[Touch]:
    """Taps at a steady pace from the own note, with a plain end where there is time for one."""
    length_s = held.end_s - held.begin_s
    room_s = length_s - TRILL_LAST_S
    count = min(max(int(room_s / TRILL_S), 1), MAX_TAPS)
    each_s = min(room_s / count if room_s >= TRILL_S else 0.6 * length_s, 1.5 * TRILL_S)
    return [
        Touch(
            held.begin_s + each_s * (number + 0.5),
            held.begin_s + each_s * (number + 1.0),
            held.pitch + step,
        )
        for number in range(count)
    ]


def curve_of(note: Note, begin_s: float, end_s: float) -> Curve:
    """The semitones from a note's pitch at seconds, from its beginning on; empty where it stays."""
    length_s = end_s - begin_s
    if length_s <= LAST_S or not (note.contour or not note.names.isdisjoint(AWAYS)):
        return []
    points = [(begin_s + share * length_s, bend) for share, bend in note.contour]
    points = points or _slide_away(note, begin_s, end_s)
    if not points:
        return []
    if points[0][0] > begin_s:
        points.insert(0, (begin_s, points[0][1]))
    count = min(max(int(length_s / STEP_S), 1), MAX_POINTS)
    curve: Curve = []
    for number in range(count + 1):
        at_s = begin_s + length_s * number / count
        bend = min(max(at_time(points, at_s), -WIDEST_BEND), WIDEST_BEND)
        at_s = min(at_s, end_s - LAST_S)  # before the next note begins
        if not curve or abs(bend - curve[-1][1]) > 1e-4:
            curve.append((at_s, bend))
    return curve if len(curve) > 1 or curve[0][1] != 0.0 else []


def _slide_away(note: Note, begin_s: float, end_s: float) -> Curve:
    """The slide out of a note, if it has one."""
    way = AWAY * (("slide-out-up" in note.names) - ("slide-out-down" in note.names))
    slide_s = min(SLIDE_S, SLIDE_SHARE * (end_s - begin_s))
    if not way:
        return []
    shares = [step / SLIDE_STEPS for step in range(SLIDE_STEPS + 1)]
    bends = [(end_s - (1.0 - share) * slide_s, way * logistic(share)) for share in shares]
    return [(begin_s, 0.0), *bends]
