"""Leave out the lower notes of chords: one player has one line, as in written scores."""

from collections.abc import Collection

import numpy as np

from yehu_server.scores.score import Score, ScoreNote, without_notes

STRUM_S = 0.03  # from the first to the last note of a chord, as of sections


def without_lower_notes(score: Score, channels: Collection[int]) -> tuple[Score, int]:
    """A score whose notes on some channels are single ones, and how many it leaves out.

    Of notes that begin together, or are strummed up or down, the highest stays. A written score has
    single notes; where two of it begin together, one bends to the other.
    """
    if score.is_written:
        return score, 0
    lower: list[ScoreNote] = []
    first_s, top = 0.0, None
    for note in score.notes:
        if note.channel not in channels:
            continue
        if top is None or note.start_s - first_s > STRUM_S or not _sound_together(top, note):
            first_s, top = note.start_s, note
        else:
            low, top = sorted((note, top), key=lambda each: each.key)
            lower.append(low)
    return without_notes(score, np.array([note.begins for note in lower])), len(lower)


def _sound_together(one: ScoreNote, other: ScoreNote) -> bool:
    """Whether two notes sound together for most of the shorter: a grace note does not."""
    both_s = min(one.end_s, other.end_s) - max(one.start_s, other.start_s)
    return 2.0 * both_s > min(one.length_s, other.length_s)
