"""Moves the sources of a mapping, and by its binds parameters of the sounding note. Compiled.

A source is a controller, a bend, an aftertouch or a named control. Moves on a channel affect its
notes, or all notes (``channels.moves_all``): while one of them sounds, and after it until a note of
another channel begins.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.channels import add_active, moves_key, plays
from yehu_server.core.midi.curves import from_unit, picks_up, to_unit
from yehu_server.core.midi.emit_commands import write
from yehu_server.core.midi.record import NONE, Midi
from yehu_server.core.midi.section import sounds
from yehu_server.core.midi.tables import POLY_PRESSURE, Tables
from yehu_server.core.midi.values import (
    NO_KEY,
    STEPS,
    keep_targets_of,
    receives,
    resolve_values,
    set_target,
)
from yehu_server.core.player.parameter_indices import IS_PLAYER_CONTROLLED

FINE_BITS, MAX_14_BITS = 7, 16383.0


# -- the sounding notes ---------------------------------------------------------------------------


@native
def write_targets(m: Midi, t: Tables, frame: int, source: int, channel: int, glides: bool) -> None:
    """Write the targets of a source moved on a channel; with their smoothing if it `glides`."""
    keep_targets_of(m, t, source)
    if m.sounding == NONE:
        if m.has_last != 0:
            write_key_targets(
                m, t, frame, source, channel, glides, m.last_channel, m.last_key, NONE
            )
        else:
            resolve_values(m, t, channel, NO_KEY)
            write_resolved(m, t, frame, source, channel, glides, False, 0, NONE)
        return
    sounding = count_sounding(m)
    for n in range(m.held):
        if sounds(m, n):
            only_key = n if sounding > 1 else NONE
            key_channel, key = m.held_channel[n], m.held_key[n]
            write_key_targets(m, t, frame, source, channel, glides, key_channel, key, only_key)


@compiled_exactly
def write_key_targets(
    m: Any,
    t: Any,
    frame: int,
    source: int,
    channel: int,
    glides: bool,
    key_channel: int,
    key: float,
    only_key: int,
) -> None:
    """Write the targets of a moved source as a key has them.

    Only to the players of that key where the section is divided.
    """
    resolve_values(m, t, key_channel, key)
    write_resolved(m, t, frame, source, channel, glides, True, key_channel, only_key)


@compiled_exactly
def write_resolved(
    m: Any,
    t: Any,
    frame: int,
    source: int,
    channel: int,
    glides: bool,
    has_key: bool,
    key_channel: int,
    only_key: int,
) -> None:
    """Write what `resolve_values` resolved for the targets of a source."""
    for bind in range(int(t.binds)):
        if int(t.source[bind]) != source:
            continue
        if has_key and not affects_key_channel(m, t, bind, channel, key_channel):
            continue
        index = int(t.target[bind])
        glide_ms = glide_of(m, t, source, channel, index) if glides else 0.0
        write(m, frame, index, m.resolved_value[index], False, glide_ms, only_key)


@compiled_exactly
def glide_of(m: Any, t: Any, source: int, channel: int, index: int) -> float:
    """The smoothing of a target (ms): that of the last bind which moves it."""
    glide_ms = 0.0
    for bind in range(int(t.binds)):
        is_moved = int(t.source[bind]) == source and int(t.target[bind]) == index
        if is_moved and (source == POLY_PRESSURE or is_receiving(m, t, bind, channel)):
            glide_ms = t.smoothing_ms[bind]
    return glide_ms


@compiled_exactly
def affects_key_channel(m: Any, t: Any, bind: int, channel: int, key_channel: int) -> bool:
    """Whether a bind's moves on a channel affect the notes of another, or of the same."""
    return bool(moves_key(m, t, channel, key_channel, t.for_all[bind] != 0.0))


@compiled_exactly
def count_sounding(m: Any) -> int:
    """The number of keys that sound: more than one where a section divides."""
    count = 0
    for n in range(m.held):
        count += 1 if sounds(m, n) else 0
    return count


# -- moves ----------------------------------------------------------------------------------------


@compiled_exactly
def is_receiving(m: Any, t: Any, bind: int, channel: int) -> bool:
    """Whether a bind receives moves on a channel: a global one, also where no notes are played."""
    return receives(t, bind, channel) and (t.for_all[bind] != 0.0 or plays(m, t, channel))


@compiled_exactly
def first_receiving(m: Any, t: Any, source: int, channel: int) -> int:
    """The first bind that receives a source on a channel, or NONE."""
    for bind in range(int(t.binds)):
        if int(t.source[bind]) == source and is_receiving(m, t, bind, channel):
            return bind
    return NONE


@native
def move_source(m: Midi, t: Tables, frame: int, source: int, channel: int, position: float) -> None:
    """Move a source of a channel to a position, 0 to 1."""
    if first_receiving(m, t, source, channel) == NONE:
        return
    keep_targets_of(m, t, source)
    add_active(m, channel)
    m.moves += 1
    number = m.moves
    for bind in range(int(t.binds)):
        if int(t.source[bind]) != source or t.soft[bind] == 0.0:
            continue
        is_moved = is_receiving(m, t, bind, channel)
        if is_moved and takes_over(m, t, bind, channel, position):
            m.taken_number[channel, bind], m.taken_position[channel, bind] = number, position
    for bind in range(int(t.binds)):
        if int(t.source[bind]) == source:
            first = int(t.first[bind])
            m.move_number[channel, first], m.position[channel, first] = number, position
            break
    write_targets(m, t, frame, source, channel, True)


@compiled_exactly
def takes_over(m: Any, t: Any, bind: int, channel: int, position: float) -> bool:
    """Whether a soft bind moves its target: it set its present value, or reaches it now."""
    of_channel, key = channel, NO_KEY
    if m.sounding != NONE:
        key_channel = m.held_channel[m.sounding]
        if affects_key_channel(m, t, bind, channel, key_channel):
            of_channel, key = key_channel, m.held_key[m.sounding]
    elif m.has_last != 0 and affects_key_channel(m, t, bind, channel, m.last_channel):
        of_channel, key = m.last_channel, m.last_key
    resolve_values(m, t, of_channel, key)
    present = m.resolved_value[int(t.target[bind])]
    had = from_unit(t, bind, m.taken_position[channel, bind])
    if m.taken_number[channel, bind] != 0 and had == present:
        return True
    first = int(t.first[bind])
    before = m.position[channel, first] if m.move_number[channel, first] != 0 else math.nan
    return bool(picks_up(t, bind, position, before, present))


@compiled_exactly
def move_source_coarse(m: Any, t: Any, frame: int, source: int, channel: int, value: int) -> None:
    """Move a 14-bit source by its coarse half, 0 to 127; the fine half is set to 0."""
    move_source(m, t, frame, source, channel, (value << FINE_BITS) / MAX_14_BITS)


@compiled_exactly
def position_of(m: Any, t: Any, source: int, channel: int) -> float:
    """Where a source was last moved to on a channel; NaN: nowhere."""
    for bind in range(int(t.binds)):
        if int(t.source[bind]) == source:
            is_moved = m.move_number[channel, bind] != 0
            return float(m.position[channel, bind] if is_moved else math.nan)
    return math.nan


@compiled_exactly
def move_source_fine(m: Any, t: Any, frame: int, source: int, channel: int, value: int) -> None:
    """Set the fine half, 0 to 127, of a source that `move_source_coarse` moved."""
    before = position_of(m, t, source, channel)
    if not math.isnan(before):
        coarse = int(np.rint(before * MAX_14_BITS)) >> FINE_BITS
        move_source(m, t, frame, source, channel, (coarse << FINE_BITS | value) / MAX_14_BITS)


@compiled_exactly
def step_source(m: Any, t: Any, frame: int, source: int, channel: int, steps: float) -> None:
    """Move a source by 127ths of its range, from its position or that of its target."""
    bind = first_receiving(m, t, source, channel)
    if bind == NONE:
        return
    position = position_of(m, t, source, channel)
    if math.isnan(position):
        position = to_unit(t, bind, m.value[int(t.target[bind])])
    moved = min(max(position + steps / STEPS, 0.0), 1.0)
    move_source(m, t, frame, source, channel, moved)


@compiled_exactly
def move_poly_pressure(m: Any, t: Any, frame: int, channel: int, key: int, position: float) -> None:
    """Move the aftertouch of one key to a position, 0 to 1."""
    is_bound = False
    for bind in range(int(t.binds)):
        is_bound = is_bound or int(t.source[bind]) == POLY_PRESSURE
    if is_bound:
        add_active(m, channel)
        m.moves += 1
        m.pressure_number[channel, key], m.pressure[channel, key] = m.moves, position
        write_targets(m, t, frame, POLY_PRESSURE, channel, True)


@compiled_exactly
def move_control(m: Any, t: Any, frame: int, source: int, argument: float) -> None:
    """Move the targets of a named control, for all channels."""
    for bind in range(int(t.binds)):
        if int(t.source[bind]) != source:
            continue
        lo, hi = t.input_lo[bind], t.input_hi[bind]
        position = 0.0
        if lo != hi:
            position = (min(max(argument, min(lo, hi)), max(lo, hi)) - lo) / (hi - lo)
        index = int(t.target[bind])
        present, wrote = m.value[index], m.control_wrote[bind]
        is_waiting = t.soft[bind] != 0.0 and present != wrote
        before = m.control_position[bind] if m.has_control_position[bind] != 0 else math.nan
        m.has_control_position[bind], m.control_position[bind] = 1, position
        if not is_waiting or picks_up(t, bind, position, before, present):
            value = from_unit(t, bind, position)
            m.control_wrote[bind] = set_directly(m, frame, index, value, t.smoothing_ms[bind])


@compiled_exactly
def set_directly(m: Any, frame: int, index: int, value: float, glide_ms: float) -> float:
    """Set a parameter for all channels, until a controller moves it; return the value it has."""
    accepted = write(m, frame, index, value, False, glide_ms, NONE)
    if not IS_PLAYER_CONTROLLED[index]:
        set_target(m, index, accepted)
    return float(accepted)
