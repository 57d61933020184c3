"""How the pitch of a note moves: slides into it and out of it, and contours."""

from __future__ import annotations

from bisect import bisect_right

from yehu_server.scores.written.notated import Note

# By ear: a slide takes so long, or so much of its note.
SLIDE_S, SLIDE_SHARE = 0.13, 0.4
USUAL_SLIDE = 2.0  # semitones
STEP_S = 0.01  # between points; the finger takes 8 ms for each
LAST_S = 0.002
MOST_POINTS = 3000
WIDEST = 24.0  # semitones

Curve = list[tuple[float, float]]


def curve_of(note: Note, begin_s: float, end_s: float) -> Curve:
    """Return the semitones from a note's pitch, at seconds; empty where it stays.

    The first point is at the note's beginning.
    """
    length_s = end_s - begin_s
    if length_s <= LAST_S:
        return []
    points = [(begin_s + share * length_s, bend) for share, bend in note.contour]
    points = points or _slides(note, begin_s, end_s)
    if not points:
        return []
    if points[0][0] > begin_s:
        points.insert(0, (begin_s, points[0][1]))
    count = min(max(int(length_s / STEP_S), 1), MOST_POINTS)
    curve: Curve = []
    for number in range(count + 1):
        at_s = begin_s + length_s * number / count
        bend = min(max(_between(points, at_s), -WIDEST), WIDEST)
        at_s = min(at_s, end_s - LAST_S)  # before the next note begins
        if not curve or abs(bend - curve[-1][1]) > 1e-4:
            curve.append((at_s, bend))
    return curve if len(curve) > 1 or curve[0][1] != 0.0 else []


def _slides(note: Note, begin_s: float, end_s: float) -> Curve:
    """The slides into a note and out of it."""
    slide_s = min(SLIDE_S, SLIDE_SHARE * (end_s - begin_s))
    points: Curve = []
    for name, sign in (("slide-in-up", -1.0), ("slide-in-down", 1.0)):
        mark = note.marked(name)
        if mark is not None and not points:
            by = USUAL_SLIDE if mark.value is None else abs(mark.value)
            points = [(begin_s, sign * by), (begin_s + slide_s, 0.0)]
    for name, sign in (("slide-out-up", 1.0), ("slide-out-down", -1.0)):
        mark = note.marked(name)
        if mark is not None:
            by = USUAL_SLIDE if mark.value is None else abs(mark.value)
            return [*(points or [(begin_s, 0.0)]), (end_s - slide_s, 0.0), (end_s, sign * by)]
    return points


def _between(points: Curve, at_s: float) -> float:
    """The value at a time on the lines between points; beyond them, that of the nearest."""
    after = bisect_right(points, at_s, key=lambda point: point[0])
    if after == 0:
        return points[0][1]
    if after == len(points):
        return points[-1][1]
    (begin, first), (end, last) = points[after - 1], points[after]
    return first + (last - first) * (at_s - begin) / (end - begin)
