"""Resets and ends the moves of controllers: RP-015, a port that is gone, a panic. Compiled."""

from typing import Any

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.channels import add_active, forget_moves, moves_all
from yehu_server.core.midi.emit_commands import write
from yehu_server.core.midi.record import CHANNEL_COUNT, NONE, Midi
from yehu_server.core.midi.sources import write_targets
from yehu_server.core.midi.tables import (
    BEND,
    KEY_COUNT,
    MAX_BINDS,
    NOTE,
    PRESSURE,
    VELOCITY,
    Tables,
)
from yehu_server.core.player.parameter_indices import INDEX

# "Reset all controllers" leaves volume, as the recommended practice RP-015 asks.
VOLUME, PAN = INDEX["/playing/volume"], INDEX["/room/pan"]


@native
def reset_controllers(m: Midi, t: Tables, frame: int, channel: int) -> None:
    """Act on "reset all controllers"."""
    for key in range(KEY_COUNT):
        m.pressure_number[channel, key] = 0
    for bind in range(int(t.binds)):
        if int(t.target[bind]) not in (VOLUME, PAN):
            m.move_number[channel, int(t.first[bind])] = 0
            m.taken_number[channel, bind] = 0
    for bind in range(int(t.binds)):
        source = int(t.source[bind])
        if int(t.first[bind]) == bind and source not in (VELOCITY, NOTE):
            write_targets(m, t, frame, source, channel, False)


@compiled_exactly
def disconnect_channel(m: Any, t: Any, frame: int, channel: int) -> None:
    """Forget the moves on a channel whose port is gone, but keep those for all notes.

    So a loose cable changes nothing, except that wheel and aftertouch spring back.
    """
    if m.is_active[channel] == 0:
        forget_moves(m, channel)  # velocities
        return
    has_bend, has_pressure, is_saved = False, False, False
    for bind in range(MAX_BINDS):
        m.saved_move_number[bind] = m.saved_taken_number[bind] = 0
    for bind in range(int(t.binds)):
        first, source = int(t.first[bind]), int(t.source[bind])
        if m.move_number[channel, first] == 0 or not moves_all(
            m, t, channel, t.for_all[bind] != 0.0
        ):
            continue
        has_bend = has_bend or source == BEND
        has_pressure = has_pressure or source == PRESSURE
        if source not in (BEND, PRESSURE):  # faders and pedals stay where they are
            is_saved = True
            m.saved_move_number[first], m.saved_position[first] = (
                m.move_number[channel, first],
                m.position[channel, first],
            )
            m.saved_taken_number[bind] = m.taken_number[channel, bind]
            m.saved_taken_position[bind] = m.taken_position[channel, bind]
    forget_moves(m, channel)
    if is_saved:
        restore_moves(m, channel)
    if has_bend:
        write_targets(m, t, frame, BEND, channel, False)
    if has_pressure:
        write_targets(m, t, frame, PRESSURE, channel, False)


@compiled_exactly
def restore_moves(m: Any, channel: int) -> None:
    """Give a channel the moves that were set aside."""
    add_active(m, channel)
    for bind in range(MAX_BINDS):
        m.move_number[channel, bind], m.position[channel, bind] = (
            m.saved_move_number[bind],
            m.saved_position[bind],
        )
        m.taken_number[channel, bind] = m.saved_taken_number[bind]
        m.taken_position[channel, bind] = m.saved_taken_position[bind]


@compiled_exactly
def forget_all_moves(m: Any, frame: int) -> None:
    """Forget the moves on all channels; targets go back to where they were before."""
    while m.actives > 0:
        forget_moves(m, m.active[0])
    for n in range(m.held):
        m.held_strike_number[n] = 0
    m.last_strike_number = 0
    m.strike_number[CHANNEL_COUNT] = 0
    for i in range(m.targets):
        index = m.target[i]
        write(m, frame, index, m.set_to[index], False, 0.0, NONE)
