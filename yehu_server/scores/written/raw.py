"""Bars as they stand on the page, before repeats are unfolded: what readers of notation make.

Readers of formats in bars, such as MusicXML and ABC, make these; `assembly` makes a `Written` of
them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

from yehu_server.scores.written.notated import Mark
from yehu_server.scores.written.repeats import BarLines

FINEST = 1 << 24  # the smallest part of a quarter note is this one


@dataclass
class RawNote:
    """A note in its bar, before ties are joined; beats in quarters since the bar's beginning."""

    at: Fraction
    length: Fraction
    pitch: float
    voice: tuple[str, str]  # staff and voice
    marks: list[Mark] = field(default_factory=list)
    is_grace: bool = False
    is_after: bool = False  # a grace note that belongs to the note before it
    ties: set[str] = field(default_factory=set)  # start, stop
    # Spans that begin or end here: their name, `start` or `stop`, and their number.
    ends: list[tuple[str, str, str]] = field(default_factory=list)


@dataclass(frozen=True)
class RawDirection:
    """What a direction says, at a beat of its bar."""

    at: Fraction
    # Sign, wedge, hairpin (words, until the next dynamic), dashes, change (of tempo), back (to
    # the tempo before) or tempo.
    kind: str
    # Of the sign or span; of a wedge also `stop`; of a tempo where it is from, in RANKS.
    name: str = ""
    value: float | None = None
    number: str = ""  # by which a wedge's end finds its beginning


# Where a tempo is from: of several at one beat the highest counts. What a program plays goes over
# what is printed, and figures over words.
RANKS = {"words": 0, "figures": 1, "playback": 2}


@dataclass
class RawBar:
    """A bar as written."""

    number: str
    lines: BarLines
    notes: list[RawNote] = field(default_factory=list)
    directions: list[RawDirection] = field(default_factory=list)
    length: Fraction = Fraction(0)  # as filled
    metre: Fraction | None = None  # quarters in a bar, where a time signature stands
    fifths: int | None = None  # sharps of a key signature that stands here, below 0 flats
