"""The keys that a part holds, in the order pressed; those that end together. Compiled."""

from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.record import NONE
from yehu_server.core.player.record import MAX_HELD


@compiled_exactly
def find_key(m: Any, channel: int, key: float) -> int:
    """The number of a held key, or NONE."""
    for i in range(m.held):
        if m.held_channel[i] == channel and m.held_key[i] == key:
            return i
    return NONE


@compiled_exactly
def hold_key(
    m: Any, channel: int, key: float, velocity: float, strike_number: int, again: int
) -> None:
    """Hold a key as the last one, which sounds; the key held longest makes room."""
    before = find_key(m, channel, key)
    if before != NONE:
        forget_key(m, before)
    elif m.held == MAX_HELD:
        forget_key(m, 0)
    n = m.held
    m.held_channel[n], m.held_key[n] = channel, key
    m.held_velocity[n], m.held_strike_number[n] = velocity, strike_number
    m.held_again[n], m.held_by[n], m.held_since[n] = again, NONE, 0
    m.is_listed[n] = 0
    m.sounding = n
    m.held += 1


@compiled_exactly
def forget_key(m: Any, number: int) -> None:
    """Hold a key no longer."""
    for i in range(number, m.held - 1):
        m.held_channel[i], m.held_key[i] = m.held_channel[i + 1], m.held_key[i + 1]
        m.held_velocity[i], m.held_strike_number[i] = (
            m.held_velocity[i + 1],
            m.held_strike_number[i + 1],
        )
        m.held_again[i], m.held_by[i] = m.held_again[i + 1], m.held_by[i + 1]
        m.held_since[i], m.is_listed[i] = m.held_since[i + 1], m.is_listed[i + 1]
    m.held -= 1
    left = 0
    for i in range(m.listed):
        if m.list[i] != number:
            m.list[left] = m.list[i] - 1 if m.list[i] > number else m.list[i]
            left += 1
    m.listed = left
    if m.sounding == number:
        m.sounding = NONE
    elif m.sounding > number:
        m.sounding -= 1


@compiled_exactly
def list_key(m: Any, number: int) -> None:
    """Let a held key end with the others that are listed."""
    if m.is_listed[number] == 0:
        m.is_listed[number] = 1
        m.list[m.listed] = number
        m.listed += 1


@compiled_exactly
def next_sounding_key(m: Any) -> int:
    """Index of the held key that sounds again when the listed keys end; NONE if there is none."""
    if m.sounding == NONE or m.is_listed[m.sounding] == 0:
        return NONE
    for n in range(m.held - 1, -1, -1):
        if m.is_listed[n] == 0:
            return n
    return NONE


@compiled_exactly
def forget_listed(m: Any) -> None:
    """Hold the keys that are listed no longer; the last one that is left sounds, if one did."""
    was_ended = m.sounding != NONE and m.is_listed[m.sounding] != 0
    for n in range(m.held - 1, -1, -1):
        if m.is_listed[n] != 0:
            forget_key(m, n)
    m.listed = 0
    if was_ended:
        m.sounding = m.held - 1  # NONE where none is left
