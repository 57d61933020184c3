"""Ornaments as touches of the fingers on one bow, timed by ear (docs/scores.md)."""

from collections.abc import Sequence
from typing import NamedTuple

from yehu_server.scores.phrasing import OVERLAP_S
from yehu_server.scores.rubato import at_time
from yehu_server.scores.slides import logistic
from yehu_server.scores.written.notated import Grace, Note

GRACE_S = 0.085
GRACE_SHARE = 0.5  # of a note, at most, for all its grace notes
TAP_S = 0.075  # of a mordent's other note, and of each note of a turn
TURN_SHARE = 0.2  # of a note, at most, for each note of a turn
TRILL_S = 0.145  # from one tap to the next: some seven a second
TRILL_LAST_S = 0.07  # of the plain note that ends it
MAX_TAPS = 1000
WHOLE, HALF = 2.0, 1.0  # default intervals: of trills and mordents above, and below
WIDEST = 12.0  # semitones, that a hand reaches
# By ear: a slide away takes so long, or so much of its note, and goes so far (semitones).
SLIDE_S, SLIDE_SHARE, AWAY = 0.13, 0.4, 2.0
SLIDE_STEPS = 12  # lines that its curve is made of
STEP_S = 0.01  # between points; the finger takes 8 ms for each
LAST_S = 0.002
MAX_POINTS = 3000
WIDEST_BEND = 24.0  # semitones
Curve = list[tuple[float, float]]


class Touch(NamedTuple):
    """A finger on a string: seconds from the start of the score, and a pitch (MIDI note)."""

    begin_s: float
    end_s: float
    pitch: float


def touches_of(note: Note, begin_s: float, end_s: float, trill: float | None) -> list[Touch]:
    """Return the touches of a note, its own among them, in the order of their beginnings.

    `trill` is the semitones to the other note of a trill that goes on from before, if one does.
    """
    if not (note.marks or note.before or note.after or trill):
        return [Touch(begin_s, end_s, note.pitch)]
    length_s = end_s - begin_s
    before = _graces(note.before, begin_s, length_s)
    after = _graces(note.after, end_s, length_s, backwards=True)
    first = before[-1].end_s if before else begin_s
    last = after[0].begin_s if after else end_s
    main = _ornamented(note, first, last, trill)
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


def _ornamented(note: Note, begin_s: float, end_s: float, trill: float | None) -> list[Touch]:
    """The note itself, held all along, and what other fingers touch meanwhile."""
    held = Touch(begin_s, end_s, note.pitch)
    for mark in note.marks:
        if mark.name == "trill":
            trill = _step(mark.value, WHOLE)
        elif mark.name in ("mordent", "inverted-mordent"):
            is_up = mark.name == "inverted-mordent"
            step = abs(_step(mark.value, WHOLE if is_up else HALF)) * (1.0 if is_up else -1.0)
            tap_s = min(TAP_S, (end_s - begin_s) / 4.0)
            return [held, Touch(begin_s + tap_s, begin_s + 2.0 * tap_s, note.pitch + step)]
        elif mark.name in ("turn", "inverted-turn"):
            return _turn(held, _step(mark.value, WHOLE), from_above=mark.name == "turn")
    return [held, *_trill(held, _step(trill, WHOLE))] if trill else [held]


def _step(semitones: float | None, default: float) -> float:
    return default if semitones is None else min(max(semitones, -WIDEST), WIDEST)


def _turn(held: Touch, above: float, *, from_above: bool) -> list[Touch]:
    """Other, own, opposite, own: the own note is held under the other two."""
    tap_s = min(TAP_S, TURN_SHARE * (held.end_s - held.begin_s))
    steps = (above, -HALF) if from_above else (-HALF, above)
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
    if length_s <= LAST_S or not (note.marks or note.contour):
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
    way = AWAY * (bool(note.marked("slide-out-up")) - bool(note.marked("slide-out-down")))
    slide_s = min(SLIDE_S, SLIDE_SHARE * (end_s - begin_s))
    if not way:
        return []
    shares = [step / SLIDE_STEPS for step in range(SLIDE_STEPS + 1)]
    bends = [(end_s - (1.0 - share) * slide_s, way * logistic(share)) for share in shares]
    return [(begin_s, 0.0), *bends]
