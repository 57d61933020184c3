"""Divide a voice into phrases, by its notes alone."""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterable

from yehu_server.scores.score import ScoreNote

# A phrase ends with a rest, with a note that lasts much longer than those about it, or when it is
# this long.
REST_S, LONG_NOTE, LONGEST_PHRASE_BEATS = 0.3, 2.5, 16.0


def phrases_of(notes: Iterable[ScoreNote]) -> list[list[ScoreNote]]:
    """Divide the notes of one voice into phrases."""
    phrases: list[list[ScoreNote]] = []
    lengths: list[float] = []  # of the last phrase, sorted
    for note in notes:
        if not phrases or _ends_before(phrases[-1], lengths, note):
            phrases.append([])
            lengths = []
        phrases[-1].append(note)
        insort(lengths, note.length_s)
    return phrases


def _ends_before(phrase: list[ScoreNote], lengths: list[float], note: ScoreNote) -> bool:
    last = phrase[-1]
    if note.start_s - last.end_s >= REST_S:
        return True
    if note.beat - phrase[0].beat >= LONGEST_PHRASE_BEATS:
        return True
    median_s = lengths[len(lengths) // 2]
    return len(phrase) > 3 and last.length_s > LONG_NOTE * median_s
