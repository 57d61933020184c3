"""Which notes a move on a channel affects: those of the channel, or all.

Moves are for all notes if their port has played no note, as of a box of pedals or faders, or
if their bind is global. But a member channel of an MPE zone belongs to one note, and so do its
moves.
"""

from __future__ import annotations

from typing import Protocol

from yehu_server.playing.sources import CHANNELS


class ChannelRules(Protocol):
    """What MIDI messages have set up for each channel, counted from 0 over all ports."""

    def master(self, channel: int) -> int | None:
        """The master channel of a member of an MPE zone; None for any other channel."""

    def bend_range(self, channel: int) -> float:
        """Pitch bend range (semitones)."""

    def plays(self, channel: int) -> bool:
        """Whether the notes of a channel are played."""


class Scope:
    """Keeps which ports have played notes, and tells which moves are for all notes."""

    def __init__(self, rules: ChannelRules) -> None:
        self._rules = rules
        self._keyboards: set[int] = set()

    def add(self, channel: int) -> bool:
        """Record a note of a channel; return whether it is the first of its port."""
        port = channel // CHANNELS
        is_first = port not in self._keyboards
        self._keyboards.add(port)
        return is_first

    def remove(self, channel: int) -> None:
        """Undo `add` where it returned true and the instrument does not have the note."""
        self._keyboards.discard(channel // CHANNELS)

    def is_for_all(self, channel: int, *, is_global: bool = False) -> bool:
        """Whether a move on a channel is for all notes; `is_global` is that of its bind."""
        if not is_global and channel // CHANNELS in self._keyboards:
            return False
        if self._rules.master(channel) is not None:
            return False
        return is_global or self._rules.plays(channel)
