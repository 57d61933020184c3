"""A performance to be played: messages at times, whatever file they come from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import mido

from yehu_server.score.duration import LONGEST_DURATION_H, check_duration


@dataclass(frozen=True)
class ScoreEvent:
    """One channel-voice message at its time (s) from the start of the score.

    `beat` is its time in quarter notes; NaN where the file counts frames of a film. `track` is
    counted from 1; 0 where there are no tracks.
    """

    time_s: float
    message: mido.Message
    beat: float = math.nan
    track: int = 0


@dataclass(frozen=True)
class Metre:
    """A time signature: the beat (quarter notes) from which it holds, and its bars' length."""

    beat: float
    quarters: float


COMMON_TIME = Metre(0.0, 4.0)


@dataclass(frozen=True)
class Score:
    """A performance: events in order, and warnings about damage in the file.

    Parameters
    ----------
    events : tuple of ScoreEvent
        Sorted by time; at equal times, in the order of the tracks, then of the file.
    duration_s : float
        Up to the last event or end-of-track of the longest track, but not more than 30 s
        beyond the last event.
    name : str
        The file's name, without folder and extension.
    warnings : tuple of str
        One line for each kind of damage, with its count and the byte where it is first.
    metres : tuple of Metre
        The time signatures, in order.

    Raises
    ------
    ScoreError
        If the score lasts longer than 1000 hours.
    """

    events: tuple[ScoreEvent, ...]
    duration_s: float
    name: str = ""
    warnings: tuple[str, ...] = ()
    metres: tuple[Metre, ...] = (COMMON_TIME,)

    def bar_at(self, beat: float) -> tuple[float, float]:
        """Return the beat from which the metre of a beat holds, and the quarters in its bars."""
        metre = COMMON_TIME
        for each in self.metres:
            if each.beat > beat + 1e-9:
                break
            metre = each
        return metre.beat, metre.quarters

    def __post_init__(self) -> None:
        check_duration(self.duration_s, LONGEST_DURATION_H)


def concatenate(scores: Sequence[Score]) -> Score:
    """Join several scores, each beginning at the end of the one before.

    A system reset between them ends all notes, pedals and bends.
    """
    events: list[ScoreEvent] = []
    start = 0.0
    for number, score in enumerate(scores, start=1):
        events += (replace(event, time_s=start + event.time_s) for event in score.events)
        start += score.duration_s
        if number < len(scores):
            events.append(ScoreEvent(start, mido.Message("reset")))
    names = " + ".join(score.name for score in scores)
    warnings = (f"{score.name}: {warning}" for score in scores for warning in score.warnings)
    return Score(tuple(events), start, names, tuple(warnings))
