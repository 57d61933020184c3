"""Ends notes together; the key that is left sounds again, with its own values. Compiled."""

from __future__ import annotations

from typing import Any

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.emit_wishes import end_listed, express
from yehu_server.core.midi.held_keys import list_key, next_sounding_key
from yehu_server.core.midi.record import NONE, Midi
from yehu_server.core.midi.tables import Tables
from yehu_server.core.midi.values import find_values, remember_last


@compiled_exactly
def express_key(m: Any, t: Any, frame: int, channel: int, key: float) -> None:
    """Give a note that begins, or sounds again, its own values of parameters."""
    find_values(m, t, channel, key)
    for i in range(m.targets):
        row = m.target[i]
        express(m, frame, row, m.found_value[row])


@native
def end_notes(m: Midi, t: Tables, frame: int) -> None:
    """End the notes of the keys listed at once; the one that sounds again has its own values."""
    n = next_sounding_key(m)
    if n != NONE:
        channel, key = m.held_channel[n], m.held_key[n]
        remember_last(m, channel, key)
        express_key(m, t, frame, channel, key)
    end_listed(m, frame)


@compiled_exactly
def end_all(m: Any, t: Any, frame: int) -> None:
    """End all notes, whatever pedals hold."""
    for n in range(m.held):
        list_key(m, n)
    end_notes(m, t, frame)


@compiled_exactly
def list_channel(m: Any, channel: int) -> None:
    """List the keys of a channel."""
    for n in range(m.held):
        if m.held_channel[n] == channel:
            list_key(m, n)
