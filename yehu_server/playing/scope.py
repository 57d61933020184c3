"""Which notes hear what is moved on a channel: those of the channel, or all.

A box without keys is for whatever is played: what a port moves that has played no note is for
all notes, and what a bind moves that is global, on any port. But in an MPE zone each member
channel is one note's, and what is moved on it stays with that.
"""

from __future__ import annotations

from typing import Protocol

from yehu_server.playing.sources import CHANNELS


class Channels(Protocol):
    """What MIDI has told of channels beside moves; they are counted from 0 over all ports."""

    def master(self, channel: int) -> int | None:
        """The master of a virtual channel in an MPE zone."""

    def bend_range(self, channel: int) -> float:
        """How far its wheel bends (semitones)."""

    def plays(self, channel: int) -> bool:
        """Whether its notes are played."""


class Scope:
    """Knows which ports have played notes."""

    def __init__(self, rules: Channels) -> None:
        self._rules = rules
        self._keyboards: set[int] = set()

    def add(self, channel: int) -> bool:
        """A note of the channel begins; return whether it is the first of its port."""
        port = channel // CHANNELS
        is_first = port not in self._keyboards
        self._keyboards.add(port)
        return is_first

    def remove(self, channel: int) -> None:
        """It was no note of this instrument, and the first of its port."""
        self._keyboards.discard(channel // CHANNELS)

    def is_for_all(self, channel: int, *, is_global: bool = False) -> bool:
        """Whether what is moved on a channel is for all notes; `is_global` is of its bind."""
        if not is_global and channel // CHANNELS in self._keyboards:
            return False
        if self._rules.master(channel) is not None:
            return False
        return is_global or self._rules.plays(channel)
