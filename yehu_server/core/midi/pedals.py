"""The sustain pedal, which holds the notes of released keys. Compiled."""

from __future__ import annotations

from typing import Any

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.compile.memory import address_of, carray
from yehu_server.core.midi.channels import master_of, moves_all
from yehu_server.core.midi.held_keys import list_key
from yehu_server.core.midi.note_ends import end_notes, end_notes_native
from yehu_server.core.midi.record import CHANNELS, MIDI, NONE
from yehu_server.core.midi.tables import TABLES

SUSTAIN = 64  # the control change; a mapping may bind it to something else


@compiled_exactly
def pedal_of(m: Any, t: Any, channel: int) -> int:
    """A channel whose pedal holds the notes of this one; NONE where none does."""
    master = master_of(m, channel)
    for each in range(CHANNELS):
        if m.sustain[each] != 0 and (each in (channel, master) or moves_all(m, t, each, False)):
            return each
    return NONE


@compiled_exactly
def hold_by_pedal(m: Any, number: int, pedal: int) -> None:
    """Let a channel's pedal hold a released key."""
    if m.held_by[number] != pedal:
        m.pedalled += 1
        m.held_by[number], m.held_since[number] = pedal, m.pedalled


@compiled_exactly
def release_key(m: Any, t: Any, number: int) -> None:
    """List a released key among those that end, unless a pedal holds it."""
    pedal = pedal_of(m, t, m.held_channel[number])
    if pedal == NONE:
        m.held_by[number] = NONE
        list_key(m, number)
    else:
        hold_by_pedal(m, number, pedal)


@native("void(voidptr, voidptr, int64, int64)", calls=[end_notes_native])
def lift_pedal_native(midi_at: Any, tables_at: Any, frame: int, channel: int) -> None:
    """See `lift_pedal`."""
    m = carray(midi_at, (1,), MIDI)[0]
    t = carray(tables_at, (1,), TABLES)[0]
    m.sustain[channel] = 0
    after = -1
    while True:
        next_key = NONE
        for n in range(m.held):
            is_left = m.held_by[n] == channel and m.held_since[n] > after
            if is_left and (next_key == NONE or m.held_since[n] < m.held_since[next_key]):
                next_key = n
        if next_key == NONE:
            break
        after = m.held_since[next_key]
        release_key(m, t, next_key)
    end_notes(m, t, frame)


_lift_pedal = lift_pedal_native.symbol


@compiled_exactly
def lift_pedal(m: Any, t: Any, frame: int, channel: int) -> None:
    """Lift a channel's pedal; the keys that it alone holds end, in the order released."""
    _lift_pedal(address_of(m), address_of(t), frame, channel)
