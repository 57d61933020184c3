"""Take one part out of a score: what one channel, or one track, has to play."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from yehu_server.midi.channels import PERCUSSION
from yehu_server.score.score import Score, ScoreEvent


def channels_with_notes(scores: Iterable[Score]) -> list[int]:
    """The channels that have notes, counted from 0, in order; percussion is among them."""
    return sorted({event.message.channel for event in _notes(scores)})


def tracks_with_notes(scores: Iterable[Score]) -> list[int]:
    """The tracks that have notes, counted from 1, in order; percussion does not count."""
    notes = (event for event in _notes(scores) if event.message.channel != PERCUSSION)
    return sorted({event.track for event in notes})


def percussion_notes(scores: Iterable[Score]) -> int:
    """How many notes channel 10 has."""
    return sum(event.message.channel == PERCUSSION for event in _notes(scores))


def part_of(score: Score, channel: int | None = None, track: int | None = None) -> Score:
    """The part of a score that one channel and one track have; None means any.

    What moves all, such as a reset, is in each part. Controllers that a file has in a track
    without notes belong to all tracks that play on their channel.
    """
    keeps: list[Callable[[ScoreEvent], bool]] = []
    if channel is not None:
        keeps.append(lambda event: _channel(event) in (channel, None))
    if track is not None:
        silent = {event.track for event in score.events} - {e.track for e in _notes([score])}
        on = {_channel(event) for event in _notes([score]) if event.track == track}
        keeps.append(
            lambda event: (
                event.track == track
                or _channel(event) is None
                or (event.track in silent and _channel(event) in on)
            )
        )
    events = (event for event in score.events if all(keep(event) for keep in keeps))
    return replace(score, events=tuple(events))


def has_notes(scores: Sequence[Score]) -> bool:
    """Whether there is a note in some scores."""
    return any(True for _ in _notes(scores))


def _notes(scores: Iterable[Score]) -> Iterable[ScoreEvent]:
    for score in scores:
        for event in score.events:
            if event.message.type == "note_on" and event.message.velocity > 0:
                yield event


def _channel(event: ScoreEvent) -> int | None:
    return getattr(event.message, "channel", None)
