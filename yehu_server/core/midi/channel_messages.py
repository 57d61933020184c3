"""Acts on MIDI channel messages: notes, programs, and moves of controllers. Compiled.

What each controller does is in ``control_changes``. Notes of the percussion channel are played
only if it is chosen, or a member of an MPE zone.
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.channels import begin_port, forget_channel, plays
from yehu_server.core.midi.control_changes import change_control
from yehu_server.core.midi.note_ends import end_all
from yehu_server.core.midi.notes import end_channel, note_off, note_on
from yehu_server.core.midi.packing import BYTE_BITS, LENGTH_SHIFT, PORT_SHIFT
from yehu_server.core.midi.record import CHANNEL_COUNT, CHANNELS_PER_PORT, PORT_COUNT, Midi
from yehu_server.core.midi.resets import disconnect_channel, forget_all_moves
from yehu_server.core.midi.sources import move_poly_pressure, move_source, set_directly
from yehu_server.core.midi.tables import BEND, PRESSURE, Tables
from yehu_server.core.player.parameter_indices import PARAMETER_COUNT

# High halves of status bytes.
NOTE_OFF, NOTE_ON, POLY_PRESSURE, CONTROL_CHANGE = 0x80, 0x90, 0xA0, 0xB0
PROGRAM_CHANGE, CHANNEL_PRESSURE, PITCH_BEND, SYSTEM = 0xC0, 0xD0, 0xE0, 0xF0
SYSTEM_RESET = 0xFF


@compiled_exactly
def receive(m: Any, t: Any, frame: int, index: int) -> None:
    """Act on a channel message or a system reset, as ``packing.packed``; ignore others.

    Each port has 16 channels of its own.
    """
    length, port = index >> LENGTH_SHIFT & 0xFF, index >> PORT_SHIFT
    status, one, two = index & 0xFF, index >> BYTE_BITS & 0xFF, index >> 2 * BYTE_BITS & 0xFF
    m.messages += 1
    if not 0 <= port < PORT_COUNT or length == 0 or status < NOTE_OFF:
        count_malformed(m, index)
        return
    if status >= SYSTEM:
        if status == SYSTEM_RESET and length == 1:
            system_reset(m, t, frame)
        return
    kind, channel = status & 0xF0, CHANNELS_PER_PORT * port + (status & 0x0F)
    wanted = 2 if kind in (PROGRAM_CHANGE, CHANNEL_PRESSURE) else 3
    if length != wanted or one >= NOTE_OFF or (wanted == 3 and two >= NOTE_OFF):
        count_malformed(m, index)
        return
    is_strike = kind == NOTE_ON and two > 0
    if not plays(m, t, channel) and not passes(t, kind):
        m.percussion += 1 if is_strike and int(t.received) < 0 else 0
    elif is_strike:
        note_on(m, t, frame, channel, float(one), two / 127.0, math.nan)
    elif kind in (NOTE_OFF, NOTE_ON):
        note_off(m, t, frame, channel, float(one))
    elif kind == PITCH_BEND:
        bend = max(-1.0, ((two << 7 | one) - 8192) / 8191.0)
        move_source(m, t, frame, BEND, channel, 0.5 * (bend + 1.0))
    elif kind == CHANNEL_PRESSURE:
        move_source(m, t, frame, PRESSURE, channel, one / 127.0)
    elif kind == POLY_PRESSURE:
        move_poly_pressure(m, t, frame, channel, one, two / 127.0)
    elif kind == CONTROL_CHANGE:
        change_control(m, t, frame, channel, one, two)
    else:
        change_program(m, t, frame, channel, one)


@compiled_exactly
def count_malformed(m: Any, index: int) -> None:
    """Count an invalid message, and store it for `status` to report."""
    m.malformed += 1
    m.malformed_last = index


@compiled_exactly
def passes(t: Any, kind: int) -> bool:
    """Whether global binds receive a message on channels whose notes are not played."""
    if int(t.received) >= 0 or kind not in (CONTROL_CHANGE, PITCH_BEND, CHANNEL_PRESSURE):
        return False
    for bind in range(int(t.binds)):
        if t.for_all[bind] != 0.0:
            return True
    return False


@compiled_exactly
def change_program(m: Any, t: Any, frame: int, channel: int, program: int) -> None:
    """Set the parameters of the preset of a program, from 0, except held ones."""
    if t.has_programs == 0.0 or m.bank[channel] != 0 or m.bank_fine[channel] != 0:
        return
    if t.has_program[program] == 0.0:
        m.unknown_program[program] += 1
        return
    for i in range(PARAMETER_COUNT):
        if math.isnan(t.program_row[program, i]):
            return
        index = int(t.program_row[program, i])
        if m.is_held[index] == 0:
            set_directly(m, frame, index, t.program_value[program, i], 0.0)


# -- ends -----------------------------------------------------------------------------------------


@compiled_exactly
def disconnect(m: Any, t: Any, frame: int, port: int) -> None:
    """End the notes of a port that is gone; see `disconnect_channel`."""
    if not 0 <= port < PORT_COUNT:
        return
    for channel in range(CHANNELS_PER_PORT * port, CHANNELS_PER_PORT * (port + 1)):
        end_channel(m, t, frame, channel)
        disconnect_channel(m, t, frame, channel)
    begin_port(m, t, port)


@native
def system_reset(m: Midi, t: Tables, frame: int) -> None:
    """End all notes, and forget pedals, zones and moves."""
    end_all(m, t, frame)
    for channel in range(CHANNEL_COUNT):
        forget_channel(m, channel)
    for port in range(PORT_COUNT):
        begin_port(m, t, port)
    forget_all_moves(m, frame)
