"""Ends notes together, unless a sustain pedal holds them; the key left sounds again. Compiled."""

from typing import Any

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.channels import master_of, moves_all
from yehu_server.core.midi.emit_commands import end_listed, set_for_next_note
from yehu_server.core.midi.part_keys import list_key, next_sounding_key
from yehu_server.core.midi.record import CHANNEL_COUNT, NONE, Midi
from yehu_server.core.midi.tables import Tables
from yehu_server.core.midi.values import remember_last, resolve_values

SUSTAIN_CONTROL = 64  # the control change; a mapping may bind it to something else


@compiled_exactly
def express_key(m: Any, t: Any, frame: int, channel: int, key: float) -> None:
    """Give a note that begins, or sounds again, its own values of parameters."""
    resolve_values(m, t, channel, key)
    for i in range(m.targets):
        index = m.target[i]
        set_for_next_note(m, frame, index, m.resolved_value[index])


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


# -- the sustain pedal, which holds the notes of released keys -------------------------------------


@compiled_exactly
def pedal_of(m: Any, t: Any, channel: int) -> int:
    """A channel whose pedal holds the notes of this one; NONE where none does."""
    master = master_of(m, channel)
    for each in range(CHANNEL_COUNT):
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


@native
def lift_pedal(m: Midi, t: Tables, frame: int, channel: int) -> None:
    """Lift a channel's pedal; the keys that it alone holds end, in the order released."""
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
