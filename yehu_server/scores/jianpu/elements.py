"""The elements of a jianpu text: what sounds, and what changes the time."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

from yehu_server.scores.jianpu.mark_words import Action
from yehu_server.scores.jianpu.note_words import Kind
from yehu_server.scores.written.notated import Grace


@dataclass(slots=True)
class Sounding:
    """A note, rest or dash as it will be played, perhaps several times.

    Attributes
    ----------
    pitch : float or None
        MIDI note; None for a rest or dash.
    other : float or None
        The other note of a tremolo between two.
    living : str
        The character, of a living note of 二四谱.
    actions : list of Action
        What the words after it do, in order.
    """

    kind: Kind
    length: Fraction
    pitch: float | None = None
    other: float | None = None
    living: str = ""
    before: tuple[Grace, ...] = ()
    after: tuple[Grace, ...] = ()
    actions: list[Action] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class TempoMark:
    """A tempo from here on."""

    quarters_per_minute: float


@dataclass(frozen=True, slots=True)
class MetreMark:
    """A metre from here on, and how long the bar is that it begins with (quarters)."""

    bar: Fraction
    first: Fraction
