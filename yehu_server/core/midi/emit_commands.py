"""Emits commands for all players of a part: parameters, notes, a bow drawn directly. Compiled.

It knows what is held and kept, and passes each command on to the one player of the part, or to
those of a section.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.part_keys import find_key, forget_listed, hold_key, list_key
from yehu_server.core.midi.record import NONE, SECTION, Midi, emit
from yehu_server.core.midi.section import (
    add_value,
    begin_together,
    emit_to_all,
    end_together,
    set_playing_count,
)
from yehu_server.core.midi.section_players import (
    DISTANCE_INDEX,
    GAIN_INDEX,
    PAN_INDEX,
    begin_sequence,
)
from yehu_server.core.player.commands import BEGIN, END, EXPRESS, HOLD, RELEASE, STOP, WRITE
from yehu_server.core.player.parameter_indices import (
    ENGINE,
    IS_PLAYER_CONTROLLED,
    LOWER_BOUNDS,
    UPPER_BOUNDS,
)

# -- parameters -----------------------------------------------------------------------------------


@compiled_exactly
def in_range(index: int, value: float) -> float:
    """The value nearest to one that a parameter can have."""
    return float(min(max(value, LOWER_BOUNDS[index]), UPPER_BOUNDS[index]))


@compiled_exactly
def pass_on(m: Any, frame: int, kind: int, index: int, value: float, other: float) -> None:
    """Command something of all who play the part."""
    if m.players == 1:
        emit(m, 0, frame, kind, index, value, other)
    else:
        emit_to_all(m, frame, kind, index, value, other, False, 0, 0.0)


@native
def write(
    m: Midi, frame: int, index: int, value: float, hold: bool, glide_ms: float, of_key: int
) -> float:
    """Set a parameter; return the value it then has.

    The moves of bow and fingers that follow take at least `glide_ms`. Where a section divides, it
    is for the players of a held key by its number, or NONE for all.
    """
    value = in_range(index, value)
    if index == SECTION:
        value = min(np.rint(value), float(m.players))
    if not IS_PLAYER_CONTROLLED[index]:
        if m.is_held[index] != 0 and not hold:
            value = m.value[index]
            if index == ENGINE.seed and m.players > 1:
                begin_sequence(m, int(np.rint(value)))
            return value
        m.value[index] = value
    if hold:
        m.is_held[index] = 1
    kind = HOLD if hold else WRITE
    if m.players == 1:
        emit(m, 0, frame, kind, index, value, glide_ms)
        return value
    if of_key == NONE:
        emit_to_all(m, frame, kind, index, value, glide_ms, False, 0, 0.0)
    else:
        channel, key = m.held_channel[of_key], m.held_key[of_key]
        emit_to_all(m, frame, kind, index, value, glide_ms, True, channel, key)
    if index == SECTION and int(value) != m.playing:
        set_playing_count(m, int(value), frame)
        for own in (GAIN_INDEX, PAN_INDEX, DISTANCE_INDEX):
            own_kind = HOLD if m.is_held[own] != 0 else WRITE
            emit_to_all(m, frame, own_kind, own, m.value[own], 0.0, False, 0, 0.0)
    elif index == ENGINE.seed:
        begin_sequence(m, int(np.rint(value)))
    return value


@compiled_exactly
def set_for_next_note(m: Any, frame: int, index: int, value: float) -> None:
    """Set a parameter for the note that begins next, or sounds again."""
    if m.is_held[index] != 0:
        return
    m.value[index] = in_range(index, value)
    if m.players == 1:
        emit(m, 0, frame, EXPRESS, index, m.value[index], 0.0)
    else:
        add_value(m, index, m.value[index])


@compiled_exactly
def release_held(m: Any) -> None:
    """Hold no parameter any more."""
    for index in range(len(LOWER_BOUNDS)):
        m.is_held[index] = 0


# -- notes ----------------------------------------------------------------------------------------


@native
def begin_key(
    m: Midi, frame: int, channel: int, key: float, pitch: float, velocity: float, strike_number: int
) -> None:
    """Begin a note at a pitch within range; what `set_for_next_note` was given applies to it."""
    again = NONE
    before = find_key(m, channel, key)
    if before != NONE:
        again = m.held_again[before]
    hold_key(m, channel, key, velocity, strike_number, again)
    m.notes += 1
    if m.players == 1:
        emit(m, 0, frame, BEGIN, channel, key, pitch)
    else:
        begin_together(m, frame, channel, key, pitch)


@native
def end_listed(m: Midi, frame: int) -> None:
    """End the keys that are listed, all at once; of those still held the last sounds again.

    What was given to `set_for_next_note` before is for that one.
    """
    if m.listed == 0:
        return
    if m.players == 1:
        for i in range(m.listed):
            n = m.list[i]
            more = 1.0 if i < m.listed - 1 else 0.0
            emit(m, 0, frame, END, m.held_channel[n], m.held_key[n], more)
    else:
        end_together(m, frame)
    forget_listed(m)


@compiled_exactly
def end_key(m: Any, frame: int, channel: int, key: float, more: bool) -> None:
    """End a note of a section that somebody asked for directly; `more` end at the same time."""
    n = find_key(m, channel, key)
    if n != NONE:
        list_key(m, n)
    if not more:
        end_listed(m, frame)
        m.values = 0


@compiled_exactly
def record_command(m: Any, kind: int, index: int, value: float, other: float) -> None:
    """Record what a command does that goes directly to the only player of the part."""
    if kind in (WRITE, HOLD, EXPRESS):
        if kind == HOLD:
            m.is_held[index] = 1
        if not IS_PLAYER_CONTROLLED[index] and (kind == HOLD or m.is_held[index] == 0):
            m.value[index] = in_range(index, value)
    elif kind == BEGIN:
        hold_key(m, index, value, 0.0, 0, NONE)
        m.notes += 1
    elif kind == END:
        n = find_key(m, index, value)
        if n != NONE:
            list_key(m, n)
        if other == 0.0:
            forget_listed(m)
    elif kind == RELEASE:
        if value == 0.0:
            release_held(m)
    elif kind == STOP and value != 0.0:
        clear_held_keys(m)


@compiled_exactly
def stop_sound(m: Any, frame: int, is_panic: bool) -> None:
    """Lift bow and fingers and stop the sound at once, unless a note sounds; in a panic, all."""
    if is_panic or m.sounding == NONE:
        pass_on(m, frame, STOP, 0, 1.0 if is_panic else 0.0, 0.0)


@compiled_exactly
def clear_held_keys(m: Any) -> None:
    """Forget all held keys, whose sound ends."""
    m.held, m.sounding, m.listed, m.values = 0, NONE, 0, 0
    m.chord, m.is_divided = 0, 0
    for who in range(m.players):
        m.holds[who] = m.has_note[who] = 0
