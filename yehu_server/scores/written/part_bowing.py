"""The strokes of a written part: when each note begins and ends, and which notes share a bow."""

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import NamedTuple

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
        or not all(BOWING_MARKS.isdisjoint(note.names) for note in part.notes)
        or any(sign.name in BOWING_SIGNS for sign in part.signs)
    )


def bowed(part: Part, actives: Sequence[Active], clock: WrittenClock) -> list[Played]:
    """Return each note of a part as it is played; `actives` are the signs that hold at each."""
    notes = part.notes
    slurs, *sliding = (_Over(part.spans, name) for name in ("slur", *SLIDES))
    slides = dict(zip(SLIDES, sliding, strict=True))
    breaths = sorted(sign.beat for sign in part.signs if sign.name == "breath")
    silences = {sign.beat for sign in part.signs if sign.name == "caesura"}
    played = []
    begins, ends = part.begins_at, part.ends_at
    times = (clock.seconds_of(np.array(beats)).tolist() for beats in (begins, ends))
    for note, active, begin_s, written_end_s in zip(notes, actives, *times, strict=True):
        end_s = written_end_s
        if note.marks or active.short:
            end_s = _sounding_end(note, active, begin_s, end_s, slurs.over(note))
        if breaths:
            at = bisect_right(breaths, note.beat)
            if at < len(breaths) and breaths[at] <= note.end:
                end_s = _breathe(begin_s, end_s)
        if silences and note.end in silences:
            end_s -= min(CAESURA_S, 0.9 * (end_s - begin_s))
        played.append(Played(note, begin_s, end_s))
    for at, (one, other) in enumerate(pairwise(notes)):
        beat = ends[at]
        if beat != begins[at + 1] or is_plucked(other, actives[at + 1]):
            continue
        slide = next((name for name in SLIDES if slides[name].joins(beat)), "")
        if slide and not other.before:
            played[at + 1] = _slid_to(played[at], played[at + 1], slide)
            played[at] = played[at]._replace(end_s=played[at + 1].begin_s)
        is_slurred = slurs.joins(beat) or actives[at].slurred
        if (slide or is_slurred) and _can_slur(one, other):
            length_s = played[at + 1].end_s - played[at + 1].begin_s
            end_s = played[at + 1].begin_s + min(OVERLAP_S, 0.5 * length_s)
            played[at] = played[at]._replace(end_s=end_s)
        elif is_slurred:
            _go_on(played, at)
    return played


def _can_slur(one: Note, other: Note) -> bool:
    """Whether the second note can follow without a new stroke."""
    return APART.isdisjoint(one.names) and round(one.pitch) != round(other.pitch)


def _go_on(played: list[Played], at: int) -> None:
    """Let a note go on in the direction of the one before: apart, but on one bow."""
    direction = played[at].direction
    if not direction:
        before = played[at - 1].direction if at else 0.0
        direction = -before or (UP if played[at].note.marked("up-bow") else DOWN)
        played[at] = played[at]._replace(direction=direction)
    played[at + 1] = played[at + 1]._replace(direction=direction)


def _sounding_end(
    note: Note, active: Active, begin_s: float, end_s: float, is_slurred: bool
) -> float:
    names = note.names
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

    def joins(self, beat: float) -> bool:
        """Whether a span is over both the note that ends and the one that begins at a beat."""
        at = bisect_left(self._begins, beat) - 1
        return at >= 0 and self._ends[at] >= beat

    def over(self, note: Note) -> bool:
        """Whether a span is over a note."""
        at = bisect_left(self._begins, note.ends_at) - 1
        return at >= 0 and self._ends[at] >= note.begins_at
