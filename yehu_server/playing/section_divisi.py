"""How the players of a section divide among the notes of a chord."""

from __future__ import annotations

from collections.abc import Sequence

CHORD_MS = 30.0  # keys struck within this time are a chord


def deal(people: int, pitches: Sequence[float]) -> list[int]:
    """Deal players evenly among notes, from the top: ten play three notes by 4, 3 and 3.

    Where there are more notes than players, the highest are played.

    Returns
    -------
    list of int [len=people]
        For each player, the index of its note in `pitches`.
    """
    order = sorted(range(len(pitches)), key=lambda note: -pitches[note])
    each, more = divmod(people, len(order))
    return [
        note for place, note in enumerate(order) for _ in range(each + 1 if place < more else each)
    ]
