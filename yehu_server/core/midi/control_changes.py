"""Acts on control changes, that is, on MIDI controllers, by their numbers. Compiled.

Those with a meaning in the MIDI standard act by themselves: bank, sustain, all sound off, reset,
all notes off, RPN and NRPN. Every other one moves what the mapping binds to it (``sources``).
"""

from typing import Any

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.channels import is_in_zone, plays
from yehu_server.core.midi.emit_commands import stop_sound
from yehu_server.core.midi.note_ends import (
    SUSTAIN_CONTROL,
    end_notes,
    hold_by_pedal,
    lift_pedal,
    list_channel,
)
from yehu_server.core.midi.part_keys import list_key
from yehu_server.core.midi.record import CHANNELS_PER_PORT, NONE, Midi
from yehu_server.core.midi.registered_parameters import (
    DATA_ENTRY,
    DATA_ENTRY_FINE,
    DECREMENT,
    INCREMENT,
    NRPN_COARSE,
    NRPN_FINE,
    RPN_COARSE,
    RPN_FINE,
    enter_data,
    select,
)
from yehu_server.core.midi.resets import reset_controllers
from yehu_server.core.midi.sources import move_source, move_source_coarse, move_source_fine
from yehu_server.core.midi.tables import PAIR, Tables

# Control changes with a meaning of their own, beside SUSTAIN_CONTROL and those of registered
# parameters.
BANK, BANK_FINE = 0, 32
ALL_SOUND_OFF, RESET_CONTROLLERS, ALL_NOTES_OFF = 120, 121, 123
PAIRS = 32  # controllers with a fine half, as many higher


@native
def change_control(m: Midi, t: Tables, frame: int, channel: int, control: int, value: int) -> None:
    """Act on a control change."""
    if control >= ALL_SOUND_OFF and not plays(m, t, channel):
        return
    if control == BANK:
        m.bank[channel] = value
    elif control == BANK_FINE:
        m.bank_fine[channel] = value
    if control == SUSTAIN_CONTROL and not is_bound(t, SUSTAIN_CONTROL):
        m.sustain[channel] = 1 if value >= 64 else 0
        if value < 64:
            lift_pedal(m, t, frame, channel)
    elif control == ALL_SOUND_OFF:
        all_sound_off(m, t, frame, channel)
    elif control >= ALL_NOTES_OFF:  # the mode messages 124-127 include it
        all_notes_off(m, t, frame, channel)
    elif control == RESET_CONTROLLERS:
        reset_sustain(m, t, frame, channel)
        m.is_registered[channel] = 1
        m.coarse[channel] = m.fine[channel] = NONE
        reset_controllers(m, t, frame, channel)
    elif control in (RPN_COARSE, RPN_FINE, NRPN_COARSE, NRPN_FINE):
        select(m, channel, control, value)
    elif control in (DATA_ENTRY, DATA_ENTRY_FINE, INCREMENT, DECREMENT):
        enter_data(m, t, frame, channel, control, value)
    else:
        move_both(m, t, frame, channel, control, value)


@compiled_exactly
def reset_sustain(m: Any, t: Any, frame: int, channel: int) -> None:
    """Lift the sustain pedal, or what is bound to it."""
    if is_bound(t, SUSTAIN_CONTROL):
        move_both(m, t, frame, channel, SUSTAIN_CONTROL, 0)
    else:
        lift_pedal(m, t, frame, channel)


@compiled_exactly
def move_both(m: Any, t: Any, frame: int, channel: int, control: int, value: int) -> None:
    """Move the sources of a control change: the 7-bit one, then the 14-bit pair."""
    move_source(m, t, frame, control, channel, value / 127.0)
    if control < PAIRS:
        move_source_coarse(m, t, frame, PAIR + control, channel, value)
    elif control < 2 * PAIRS:
        move_source_fine(m, t, frame, PAIR + control - PAIRS, channel, value)


@compiled_exactly
def is_bound(t: Any, source: int) -> bool:
    """Whether a source moves anything."""
    for bind in range(int(t.binds)):
        if int(t.source[bind]) == source:
            return True
    return False


@compiled_exactly
def all_sound_off(m: Any, t: Any, frame: int, channel: int) -> None:
    """End the notes of a channel, of its zone, and of its pedal, and the sound."""
    for n in range(m.held):
        if m.held_by[n] == channel and not is_in_zone(m, m.held_channel[n], channel):
            list_key(m, n)
    list_zone(m, channel)
    end_notes(m, t, frame)
    stop_sound(m, frame, False)


@compiled_exactly
def list_zone(m: Any, channel: int) -> None:
    """List the keys of a channel and, where it is a master, of its members."""
    first = CHANNELS_PER_PORT * (channel // CHANNELS_PER_PORT)
    list_channel(m, channel)
    for member in range(first, first + CHANNELS_PER_PORT):
        if member != channel and is_in_zone(m, member, channel):
            list_channel(m, member)


@compiled_exactly
def all_notes_off(m: Any, t: Any, frame: int, channel: int) -> None:
    """End the notes of a channel and of its zone, as if their keys were released."""
    list_zone(m, channel)
    if m.sustain[channel] == 0:
        end_notes(m, t, frame)
        return
    for i in range(m.listed):
        hold_by_pedal(m, m.list[i], channel)
        m.is_listed[m.list[i]] = 0
    m.listed = 0
