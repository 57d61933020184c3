"""MPE zones: member channels of one note each, and a master channel for all of them.

Source: MIDI Polyphonic Expression, version 1.0 (MIDI Association).
"""

from __future__ import annotations

LOWER_MASTER, UPPER_MASTER = 0, 15  # channels, counted from 0
MOST_MEMBERS = 15
MEMBER_BEND, MASTER_BEND = 48.0, 2.0  # semitones, until RPN 0 sets another range


class Zones:
    """The zones of one MIDI port: at first none, or one of all channels."""

    def __init__(self, *, whole: bool = False) -> None:
        self._lower = MOST_MEMBERS if whole else 0
        self._upper = 0

    def configure(self, channel: int, members: int) -> bool:
        """Act on an MPE configuration message; return whether the channel can be a master.

        Where two zones overlap, the one configured last keeps its channels.
        """
        members = min(members, MOST_MEMBERS)
        room = MOST_MEMBERS - 1 - members  # left for the other zone, between the two masters
        if channel == LOWER_MASTER:
            self._lower = members
            self._upper = min(self._upper, max(room, 0))
        elif channel == UPPER_MASTER:
            self._upper = members
            self._lower = min(self._lower, max(room, 0))
        return channel in (LOWER_MASTER, UPPER_MASTER)

    def master(self, channel: int) -> int | None:
        """The master of a member channel; None for any other channel."""
        if LOWER_MASTER < channel <= self._lower:
            return LOWER_MASTER
        if UPPER_MASTER - self._upper <= channel < UPPER_MASTER:
            return UPPER_MASTER
        return None

    def members(self, channel: int) -> range:
        """The member channels of a master; none for any other channel."""
        if channel == LOWER_MASTER:
            return range(1, self._lower + 1)
        if channel == UPPER_MASTER:
            return range(UPPER_MASTER - self._upper, UPPER_MASTER)
        return range(0)

    def bend_range(self, channel: int) -> float | None:
        """Default bend range of a channel (semitones); None outside all zones."""
        if self.master(channel) is not None:
            return MEMBER_BEND
        return MASTER_BEND if self.members(channel) else None
