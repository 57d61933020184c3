"""The keys that one instrument holds, in order (a part's: ``midi.part_keys``). Compiled."""

from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.record import ENDING, MAX_HELD

NOT_HELD = -1


@compiled_exactly
def find_key(p: Any, channel: int, key: float) -> int:
    """The number of a held key, or NOT_HELD."""
    for i in range(p.held):
        if p.held_channel[i] == channel and p.held_key[i] == key:
            return i
    return NOT_HELD


@compiled_exactly
def add_key(p: Any, channel: int, key: float, pitch: float) -> None:
    """Hold a key, as the last one; the key held longest makes room."""
    if p.held == MAX_HELD:
        remove_key(p, 0)
    last = p.held
    p.held_channel[last], p.held_key[last], p.held_pitch[last] = channel, key, pitch
    p.held += 1


@compiled_exactly
def remove_key(p: Any, number: int) -> None:
    """Let go of a held key; where it sounds, its note is ENDING."""
    for i in range(number, p.held - 1):
        p.held_channel[i] = p.held_channel[i + 1]
        p.held_key[i] = p.held_key[i + 1]
        p.held_pitch[i] = p.held_pitch[i + 1]
    p.held -= 1
    if p.sounding == number:
        p.sounding = ENDING
    elif p.sounding > number:
        p.sounding -= 1
