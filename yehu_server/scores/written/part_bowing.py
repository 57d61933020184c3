"""The strokes of a written part: when each note begins and ends, and which notes share a bow."""

from bisect import bisect_right
from collections.abc import Sequence
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from yehu_server.scores.phrasing import OVERLAP_S
from yehu_server.scores.written.mark_settings import DOWN, UP, Active, is_plucked
from yehu_server.scores.written.notated import Note, Part, Span
from yehu_server.scores.written.tempo import CAESURA_S, WrittenClock

# Sounding shares of the written length, by ear. The shortest that is marked counts.
SHARES = {
    "staccatissimo": 0.3, "spiccato": 0.35, "staccato": 0.5, "portato": 0.85, "marcato": 0.85,
    "tenuto": 1.0,
}  # fmt: skip
LOURE = 0.75  # tenuto and staccato together
BREATH_S, BREATH_SHARE = 0.18, 0.3
# Shares of the note that they leave: a glissando fills so much; a portamento so much at most.
GLISSANDO_SHARE, LONGEST_SLIDE_S = 0.7, 2.0
PORTAMENTO_S, PORTAMENTO_SHARE = 0.14, 0.5
SLIDES = ("glissando", "portamento")
BOWING_MARKS = {
    "staccato", "staccatissimo", "spiccato", "portato", "up-bow", "down-bow", "tremolo",
    "pizzicato",
}  # fmt: skip
APART = {"staccato", "staccatissimo", "spiccato", "portato", "breath"}
Array = Any
BOWING_SIGNS = {"pizz", "legato", "non-legato", "staccato", "tremolo"}


class Played(NamedTuple):
    """A note as the hands play it."""

    note: Note
    begin_s: float
    end_s: float
    direction: float = 0.0  # of its bow, as `/playing/direction` has it; 0: the next one
    slide_s: float = 0.0  # how long the finger slides to it from the note before; 0: it does not


def has_bowing(part: Part) -> bool:
    """Whether a part says which notes share a bow, or how they are bowed."""
    return (
        any(span.name == "slur" for span in part.spans)
        or not all(BOWING_MARKS.isdisjoint(names) for names in {*part.names})
        or any(sign.name in BOWING_SIGNS for sign in part.signs)
    )


def bowed(part: Part, actives: Sequence[Active], clock: WrittenClock) -> list[Played]:
    """Return each note of a part as it is played; `actives` are the signs that hold at each."""
    notes, names = part.notes, part.names
    slurs, *sliding = (_Over(part.spans, name) for name in ("slur", *SLIDES))
    begins, ends = np.array(part.begins_at), np.array(part.ends_at)
    begins_s, ends_s = clock.seconds_of(begins).tolist(), clock.seconds_of(ends).tolist()
    are_slurred = slurs.over(begins, ends).tolist()
    for at, (its_names, active) in enumerate(zip(names, actives, strict=True)):
        if its_names or active.short:
            ends_s[at] = _sounding_end(
                notes[at], its_names, active, begins_s[at], ends_s[at], are_slurred[at]
            )
    _breathe_by_signs(part, begins_s, ends_s)
    played = [*map(Played, notes, begins_s, ends_s)]
    joined, *slides = (each.join(ends[:-1]) for each in (slurs, *sliding))
    joined |= np.array([active.slurred for active in actives[:-1]], bool)
    follow = (ends[:-1] == begins[1:]) & np.logical_or.reduce([joined, *slides])
    for at in np.flatnonzero(follow).tolist():
        one, other = notes[at], notes[at + 1]
        if is_plucked(other, actives[at + 1]):
            continue
        slide = next((name for name, own in zip(SLIDES, slides, strict=True) if own[at]), "")
        if slide and not other.before:
            played[at + 1] = _slid_to(played[at], played[at + 1], slide)
            played[at] = played[at]._replace(end_s=played[at + 1].begin_s)
        if APART.isdisjoint(names[at]) and round(one.pitch) != round(other.pitch):
            length_s = played[at + 1].end_s - played[at + 1].begin_s
            end_s = played[at + 1].begin_s + min(OVERLAP_S, 0.5 * length_s)
            note, begin_s, _, direction, slide_s = played[at]
            played[at] = Played(note, begin_s, end_s, direction, slide_s)
        elif joined[at]:  # the second note needs a new stroke
            _go_on(played, at)
    return played


def _breathe_by_signs(part: Part, begins_s: list[float], ends_s: list[float]) -> None:
    """End notes early before breaths and caesuras that are signs of the part."""
    breaths = sorted(sign.beat for sign in part.signs if sign.name == "breath")
    silences = {sign.beat for sign in part.signs if sign.name == "caesura"}
    for at, note in enumerate(part.notes if breaths or silences else ()):
        after = bisect_right(breaths, note.beat)
        if after < len(breaths) and breaths[after] <= note.end:
            ends_s[at] = _breathe(begins_s[at], ends_s[at])
        if note.end in silences:
            ends_s[at] -= min(CAESURA_S, 0.9 * (ends_s[at] - begins_s[at]))


def _go_on(played: list[Played], at: int) -> None:
    """Let a note go on in the direction of the one before: apart, but on one bow."""
    direction = played[at].direction
    if not direction:
        before = played[at - 1].direction if at else 0.0
        direction = -before or (UP if played[at].note.marked("up-bow") else DOWN)
        played[at] = played[at]._replace(direction=direction)
    played[at + 1] = played[at + 1]._replace(direction=direction)


def _sounding_end(
    note: Note,
    names: frozenset[str],
    active: Active,
    begin_s: float,
    end_s: float,
    is_slurred: bool,
) -> float:
    if not names and is_slurred:
        return end_s
    if "caesura" in names:
        end_s -= CAESURA_S
    shares = [SHARES[mark.name] for mark in note.marks if mark.name in SHARES]
    if active.short and not shares and not is_slurred:
        shares = [SHARES["staccato"]]
    share = min(shares, default=1.0)
    if "tenuto" in names and share < 1.0:
        share = max(share, LOURE)
    if "fermata" in names:
        share = 1.0
    end_s = begin_s + share * (end_s - begin_s)
    return _breathe(begin_s, end_s) if "breath" in names else end_s


def _breathe(begin_s: float, end_s: float) -> float:
    return end_s - min(BREATH_S, BREATH_SHARE * (end_s - begin_s))


def _slid_to(one: Played, other: Played, slide: str) -> Played:
    """The second of two notes, begun early so that the finger is there on the beat."""
    length_s = other.begin_s - one.begin_s
    slide_s = min(PORTAMENTO_S, PORTAMENTO_SHARE * length_s)
    if slide == "glissando":
        slide_s = min(GLISSANDO_SHARE * length_s, LONGEST_SLIDE_S)
    return other._replace(begin_s=other.begin_s - slide_s, slide_s=slide_s)


class _Over:
    """Spans of one kind, found by the notes under them."""

    def __init__(self, spans: Sequence[Span], name: str) -> None:
        own = sorted((float(each.begin), float(each.end)) for each in spans if each.name == name)
        self._begins = [begin for begin, _ in own]
        # The farthest end of the spans up to each: enough to answer for any note.
        self._ends = [*accumulate((end for _, end in own), max)]

    def join(self, beats: Array) -> Array:
        """Whether a span is over both notes, one that ends and one that begins at each beat."""
        return self.over(beats, beats)

    def over(self, begins: Array, ends: Array) -> Array:
        """Whether a span is over each note, of those that begin and end at beats."""
        at = np.searchsorted(self._begins, ends) - 1
        return (at >= 0) & (np.append(self._ends, -1.0)[at] >= begins)
