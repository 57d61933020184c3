"""Leave out the lower notes of chords: one player has one line, as in written scores."""

from collections.abc import Collection
from typing import Any

import numpy as np

from yehu_server.scores.events import Array, NoteColumns
from yehu_server.scores.score import Score, without_notes

STRUM_S = 0.03  # from the first to the last note of a chord, as of sections


def without_lower_notes(score: Score, channels: Collection[int]) -> tuple[Score, int]:
    """A score whose notes on some channels are single ones, and how many it leaves out.

    Of notes that begin together, or are strummed up or down, the highest stays. A written score has
    single notes; where two of it begin together, one bends to the other.
    """
    if score.is_written:
        return score, 0
    notes = score.note_columns
    notes = notes.where(np.isin(notes.channel, [*channels]))
    lower = notes.begins[~is_single(tops_of(notes))]
    return without_notes(score, lower), len(lower)


def tops_of(notes: NoteColumns, part: Any = 0) -> Array:
    """The place of the highest note of each note's chord; its own where it is single.

    Notes come by part, then in the order of their beginnings. Notes of a chord sound together for
    most of the shorter: a grace note does not.
    """
    count, part = len(notes.key), np.broadcast_to(part, notes.key.shape)
    is_near = np.diff(notes.start_s, prepend=-np.inf) <= STRUM_S
    is_near &= (np.diff(part, prepend=-1) == 0) & (notes.end_s > notes.start_s)
    if not is_near.any():
        return np.arange(count)
    is_first = (~is_near).tolist()
    first_s = top_end_s = top_s = top_key = 0.0  # of the chord, and its highest note so far
    rows = zip(*(each.tolist() for each in (notes.start_s, notes.end_s, notes.key)), strict=True)
    for at, (start_s, end_s, key) in enumerate(rows):
        length_s, lasts = end_s - start_s, end_s > top_end_s
        lasts = lasts and 2.0 * (top_end_s - start_s) <= min(top_s, length_s)
        is_first[at] = is_first[at] or lasts or start_s - first_s > STRUM_S
        if is_first[at] or key > top_key:
            first_s = start_s if is_first[at] else first_s
            top_end_s, top_s, top_key = end_s, length_s, key
    chord, place = np.cumsum(is_first) - 1, np.arange(count)
    highest = np.maximum.reduceat(notes.key * count - place, np.flatnonzero(is_first))
    return (-highest % count)[chord]


def is_single(tops: Array) -> Array:
    """Whether each note is a single one, or the highest of a chord, by `tops_of`."""
    return tops == np.arange(len(tops))
