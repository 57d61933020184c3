"""Interprets events: which commands each produces, for whoever plays the part. Compiled."""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.compile.memory import carray
from yehu_server.core.midi import emit_commands
from yehu_server.core.midi.channel_messages import disconnect, receive, system_reset
from yehu_server.core.midi.control_changes import is_bound
from yehu_server.core.midi.events import (
    CONTROL,
    DISCONNECT,
    FINGER_ON,
    LEAVE,
    LOAD,
    MESSAGE,
    NOTE_OFF,
    NOTE_ON,
    RELEASE_ALL,
    SET,
    START,
    TABLES_TO,
)
from yehu_server.core.midi.note_ends import SUSTAIN_CONTROL, end_all, end_notes, lift_pedal
from yehu_server.core.midi.notes import note_off, note_on
from yehu_server.core.midi.part_keys import list_key
from yehu_server.core.midi.record import CHANNEL_COUNT, NONE, Midi, emit
from yehu_server.core.midi.remapping import change_binds, start
from yehu_server.core.midi.section import slide_players
from yehu_server.core.midi.sources import move_control, set_directly
from yehu_server.core.midi.tables import CONTROL as CONTROL_SOURCE
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.core.player.commands import (
    BEGIN,
    END,
    EXPRESS,
    HOLD,
    KINDS,
    RELEASE,
    SLIDE,
    STOP,
    WRITE,
)
from yehu_server.core.player.parameter_indices import INDEX, PARAMETER_COUNT
from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE

# Parameters in the order in which all are given their start values, and those values.
PLAYERS_FIRST = sorted(TABLE, key=lambda param: param.place is Place.ENGINE)
START_INDICES = np.array([INDEX[param.address] for param in PLAYERS_FIRST])
START_VALUES = np.array([param.default for param in PLAYERS_FIRST])


@native
def interpret(
    m: Midi, tables: Any, frame: int, kind: int, index: int, value: float, other: float
) -> None:
    """Interpret an event, given by its fields; the commands that it produces are in the record.

    An event of unknown kind, for an unknown parameter, or with a number that is not finite is
    ignored. `tables` points to TABLE_SLOTS records. Real time: safe; no allocation, no exception.
    """
    all_tables = carray(tables, (TABLE_SLOTS,), TABLES)
    t = all_tables[m.tables]
    m.commands = 0
    if kind < len(KINDS) or kind > TABLES_TO:
        command(m, frame, kind, index, value, other)
    elif not (math.isfinite(value) and math.isfinite(other)):
        return
    elif kind == MESSAGE:
        receive(m, t, frame, index)
    elif kind == TABLES_TO and 0 <= index < TABLE_SLOTS:
        change_tables(m, t, all_tables[index], frame)
        m.tables = index  # the other slots may be overwritten from here on
    elif kind in (NOTE_ON, FINGER_ON, NOTE_OFF):
        act_on_key(m, t, frame, kind, index, value, min(other, 1.0))
    elif kind in (SET, LOAD) and 0 <= index < PARAMETER_COUNT:
        if kind == SET or m.is_held[index] == 0:
            set_directly(m, frame, index, value, max(other, 0.0))
    elif kind == CONTROL and index >= 0:
        move_control(m, t, frame, CONTROL_SOURCE + index, value)
    elif kind in (DISCONNECT, LEAVE, RELEASE_ALL):
        act_on_end(m, t, frame, kind, index, value)
    elif kind == START:
        apply_start_values(m, t, frame, value != 0.0)


@compiled_exactly
def act_on_key(
    m: Any, t: Any, frame: int, kind: int, channel: int, key: float, velocity: float
) -> None:
    """Begin or end the note of a key."""
    if kind == NOTE_OFF:
        note_off(m, t, frame, channel, key)
    else:
        note_on(m, t, frame, channel, key, velocity, key if kind == FINGER_ON else math.nan)


@compiled_exactly
def act_on_end(m: Any, t: Any, frame: int, kind: int, index: int, value: float) -> None:
    """End the notes of a port, of somebody who left, or all."""
    if kind == DISCONNECT:
        disconnect(m, t, frame, index)
    elif kind == LEAVE:
        leave(m, t, frame, index, value)
    elif value == 0.0:
        end_all(m, t, frame)
    else:
        system_reset(m, t, frame)


@compiled_exactly
def apply_start_values(m: Any, t: Any, frame: int, with_all: bool) -> None:
    """Set parameters to the start values of the tables; first `with_all` to those of their own."""
    if with_all:
        for i in range(len(START_INDICES)):
            set_directly(m, frame, START_INDICES[i], START_VALUES[i], 0.0)
    start(m, t, frame)


@compiled_exactly
def command(m: Any, frame: int, kind: int, index: int, value: float, other: float) -> None:
    """Pass on a command (``player.commands``) that was posted as an event."""
    is_valid = math.isfinite(value) and math.isfinite(other)
    if kind in (WRITE, HOLD, EXPRESS):
        is_valid = is_valid and 0 <= index < PARAMETER_COUNT
    if m.players == 1:  # as it is: it may be one of a replay
        if is_valid:
            emit_commands.record_command(m, kind, index, value, other)
        emit(m, 0, frame, kind, index, value, other)
    elif not is_valid or not 0 <= kind < len(KINDS):
        return
    elif kind == EXPRESS:
        emit_commands.set_for_next_note(m, frame, index, value)
    elif kind in (WRITE, HOLD):
        emit_commands.write(m, frame, index, value, kind == HOLD, max(other, 0.0), NONE)
    elif kind == BEGIN:
        emit_commands.begin_key(m, frame, index, value, other, 0.0, 0)
    elif kind == END:
        emit_commands.end_key(m, frame, index, value, other != 0.0)
    elif kind == SLIDE:
        slide_players(m, frame, value)
    else:
        if kind == RELEASE and value == 0.0:
            emit_commands.release_held(m)
        elif kind == STOP and value != 0.0:
            emit_commands.clear_held_keys(m)
        emit_commands.pass_on(m, frame, kind, index, value, other)


@compiled_exactly
def leave(m: Any, t: Any, frame: int, first: int, channels: float) -> None:
    """End what is held on the channels of somebody who left."""
    for n in range(m.held):
        if first <= m.held_channel[n] < first + channels:
            list_key(m, n)
    end_notes(m, t, frame)


@compiled_exactly
def change_tables(m: Any, before: Any, t: Any, frame: int) -> None:
    """Use other tables from now on, while notes sound."""
    change_binds(m, before, t, frame)
    if t.mpe != before.mpe:
        system_reset(m, t, frame)
    if is_bound(t, SUSTAIN_CONTROL):  # the pedal no longer holds notes
        for channel in range(CHANNEL_COUNT):
            m.sustain[channel] = 0
        for channel in range(CHANNEL_COUNT):
            lift_pedal(m, t, frame, channel)
