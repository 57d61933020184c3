"""What happens to notes outside the range of the instrument."""

from __future__ import annotations

from enum import Enum

from yehu_server.player.fingering import HIGHEST_NOTE, LOWEST_NOTE, OPEN_WITHIN


class RangePolicy(Enum):
    """What happens to a note outside the range of the instrument."""

    TRANSPOSE = "transpose"
    CLAMP = "clamp"
    SKIP = "skip"

    def fit(self, note: float) -> float | None:
        """Return the note to play for `note`, or None for none.

        A note that a tuning puts less than a quarter tone out of range is moved to its end.
        """
        if LOWEST_NOTE - OPEN_WITHIN < note < HIGHEST_NOTE + OPEN_WITHIN:
            return min(max(note, LOWEST_NOTE), HIGHEST_NOTE)
        if self is RangePolicy.SKIP:
            return None
        if self is RangePolicy.CLAMP:
            return min(max(note, LOWEST_NOTE), HIGHEST_NOTE)
        if note < LOWEST_NOTE:
            return note + 12 * -(-(LOWEST_NOTE - note) // 12)
        return note - 12 * -(-(note - HIGHEST_NOTE) // 12)
