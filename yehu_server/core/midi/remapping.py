"""Takes the start values and binds of tables, and of others in their place while played. Compiled.

A move stays where its source is still bound. A parameter whose start value differs takes the new
one, unless it was moved since.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.emit_commands import write
from yehu_server.core.midi.record import NONE, Midi
from yehu_server.core.midi.resets import restore_moves
from yehu_server.core.midi.sources import set_directly
from yehu_server.core.midi.tables import KEY_COUNT, MAX_BINDS, POLY_PRESSURE, Tables
from yehu_server.core.midi.values import keep_target, resolve_values
from yehu_server.core.player.parameter_indices import PARAMETER_COUNT
from yehu_server.params.table import TABLE

DEFAULTS = np.array([param.default for param in TABLE])


@compiled_exactly
def start(m: Any, t: Any, frame: int) -> None:
    """Set parameters to the start values of the tables."""
    for i in range(int(t.starts)):
        set_directly(m, frame, int(t.start_row[i]), t.start_value[i], 0.0)


@compiled_exactly
def start_value(t: Any, index: int) -> float:
    """The value that a parameter starts with."""
    for i in range(int(t.starts)):
        if int(t.start_row[i]) == index:
            return float(t.start_value[i])
    return float(DEFAULTS[index])


@native
def change_binds(m: Midi, before: Tables, t: Tables, frame: int) -> None:
    """Take the binds of other tables."""
    for i in range(m.actives):
        change_moves(m, before, t, m.active[i])
    change_faders(m, before, t)
    for bind in range(int(t.binds)):
        keep_target(m, int(t.target[bind]))
    for index in range(PARAMETER_COUNT):
        m.resolved_number[index] = 0  # until its start value has been checked
    for i in range(int(before.starts)):
        change_start(m, before, t, frame, int(before.start_row[i]))
    for i in range(int(t.starts)):
        change_start(m, before, t, frame, int(t.start_row[i]))
    if m.has_last != 0:
        resolve_values(m, t, m.last_channel, m.last_key)
        for i in range(m.targets):
            index = m.target[i]
            write(m, frame, index, m.resolved_value[index], False, 0.0, NONE)


@compiled_exactly
def change_start(m: Any, before: Any, t: Any, frame: int, index: int) -> None:
    """Give a parameter its new start value, once, if it still has the old one."""
    if m.resolved_number[index] != 0:
        return
    m.resolved_number[index] = 1
    old, new = start_value(before, index), start_value(t, index)
    now = m.set_to[index] if m.is_target[index] != 0 else m.value[index]
    if old != new and now == old:
        keep_target(m, index)
        m.set_number[index], m.set_to[index] = 0, new  # moves made before still count
        if m.has_last == 0:
            write(m, frame, index, new, False, 0.0, NONE)


@compiled_exactly
def change_moves(m: Any, before: Any, t: Any, channel: int) -> None:
    """Give the moves of a channel the numbers of other binds."""
    for bind in range(MAX_BINDS):
        m.saved_move_number[bind] = m.saved_taken_number[bind] = 0
    is_pressed = False
    for bind in range(int(t.binds)):
        source = int(t.source[bind])
        is_pressed = is_pressed or source == POLY_PRESSURE
        for old in range(int(before.binds)):
            if int(before.source[old]) != source:
                continue
            first = int(before.first[old])
            if int(t.first[bind]) == bind:
                m.saved_move_number[bind] = m.move_number[channel, first]
                m.saved_position[bind] = m.position[channel, first]
            if t.soft[bind] == 0.0 or int(before.target[old]) != int(t.target[bind]):
                continue
            if before.soft[old] != 0.0:
                number, position = m.taken_number[channel, old], m.taken_position[channel, old]
            else:
                number, position = m.move_number[channel, first], m.position[channel, first]
            if number != 0:
                m.saved_taken_number[bind], m.saved_taken_position[bind] = number, position
    restore_moves(m, channel)
    if not is_pressed:
        for key in range(KEY_COUNT):
            m.pressure_number[channel, key] = 0


@compiled_exactly
def change_faders(m: Any, before: Any, t: Any) -> None:
    """Let named controls stay where their bind is the same."""
    for bind in range(MAX_BINDS):
        m.saved_move_number[bind], m.saved_position[bind] = (
            m.has_control_position[bind],
            m.control_position[bind],
        )
        m.saved_taken_position[bind] = m.control_wrote[bind]
        m.has_control_position[bind], m.control_wrote[bind] = 0, math.nan
    for bind in range(int(t.binds)):
        for old in range(int(before.binds)):
            if before.same[old] == t.same[bind] and m.saved_move_number[old] != 0:
                m.has_control_position[bind], m.control_position[bind] = 1, m.saved_position[old]
                m.control_wrote[bind] = m.saved_taken_position[old]
