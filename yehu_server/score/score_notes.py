"""The notes of a score: each with its beginning, its end and its beat."""

from __future__ import annotations

from dataclasses import dataclass

from yehu_server.score.score import Score


@dataclass(frozen=True)
class ScoreNote:
    """A note of a score, by the numbers of its events; times in seconds.

    Attributes
    ----------
    begins, ends : int
        Numbers of its note-on and its note-off; `ends` is -1 where nothing ends it.
    beat : float
        Quarter notes since the beginning of the score; NaN where it has none.
    """

    begins: int
    ends: int
    channel: int
    key: int
    velocity: int
    start_s: float
    end_s: float
    beat: float

    @property
    def length_s(self) -> float:
        """How long it lasts (s)."""
        return self.end_s - self.start_s


def notes_of(score: Score) -> list[ScoreNote]:
    """Pair the note-ons of a score with what ends them, in the order of their beginnings.

    A key that is struck again ends its note, as the instrument has it.
    """
    held: dict[tuple[int, int], int] = {}
    ends: dict[int, int] = {}
    for number, event in enumerate(score.events):
        message = event.message
        if message.type not in ("note_on", "note_off"):
            continue
        key = (message.channel, message.note)
        if key in held:
            ends[held.pop(key)] = number
        if message.type == "note_on" and message.velocity > 0:
            held[key] = number
    found = []
    for number, event in enumerate(score.events):
        message = event.message
        if message.type == "note_on" and message.velocity > 0:
            end = ends.get(number, -1)
            end_s = score.events[end].time_s if end >= 0 else score.duration_s
            at = (message.channel, message.note, message.velocity)
            found.append(ScoreNote(number, end, *at, event.time_s, end_s, event.beat))
    return found
