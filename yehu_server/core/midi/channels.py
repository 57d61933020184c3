"""What messages have set up for each channel: MPE zones, bend ranges, notes it moves. Compiled.

Channels are counted from 0 over all ports, 16 in each. Notes that come from no MIDI port have other
numbers, and nothing set up.

Source of zones: MIDI Polyphonic Expression, version 1.0 (MIDI Association).
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.record import CHANNEL_COUNT, CHANNELS_PER_PORT, NONE
from yehu_server.core.midi.tables import MAX_BINDS
from yehu_server.core.player.parameter_indices import PLAYING

LOWER_MASTER, UPPER_MASTER = 0, 15  # in a port
MAX_MEMBERS = 15
MEMBER_BEND, MASTER_BEND = 48.0, 2.0  # semitones, until RPN 0 sets another range
PERCUSSION_CHANNEL = 9  # channel 10, counted from 0
ALL_BUT_PERCUSSION = -1  # of channels that are received


@compiled_exactly
def is_midi(channel: int) -> bool:
    """Whether a channel is one of a port."""
    return 0 <= channel < CHANNEL_COUNT


# -- MPE zones ------------------------------------------------------------------------------------


@compiled_exactly
def begin_port(m: Any, t: Any, port: int) -> None:
    """Give a port the zones that it starts with: none, or one of all channels."""
    m.lower[port] = MAX_MEMBERS if t.mpe != 0.0 else 0
    m.upper[port] = 0


@compiled_exactly
def configure_zone(m: Any, channel: int, members: int) -> bool:
    """Act on an MPE configuration, over older ones; return whether the channel can be a master."""
    port, own = channel // CHANNELS_PER_PORT, channel % CHANNELS_PER_PORT
    members = min(members, MAX_MEMBERS)
    room = max(MAX_MEMBERS - 1 - members, 0)  # left for the other zone, between the two masters
    if own == LOWER_MASTER:
        m.lower[port] = members
        m.upper[port] = min(m.upper[port], room)
    elif own == UPPER_MASTER:
        m.upper[port] = members
        m.lower[port] = min(m.lower[port], room)
    return own in (LOWER_MASTER, UPPER_MASTER)


@compiled_exactly
def master_of(m: Any, channel: int) -> int:
    """The master channel of a member of an MPE zone; NONE for any other channel."""
    if not is_midi(channel):
        return NONE
    port, own = channel // CHANNELS_PER_PORT, channel % CHANNELS_PER_PORT
    if LOWER_MASTER < own <= m.lower[port]:
        return CHANNELS_PER_PORT * port + LOWER_MASTER
    if UPPER_MASTER - m.upper[port] <= own < UPPER_MASTER:
        return CHANNELS_PER_PORT * port + UPPER_MASTER
    return NONE


@compiled_exactly
def is_in_zone(m: Any, channel: int, master: int) -> bool:
    """Whether a channel is another one or, where that is a master, one of its members."""
    return bool(channel == master or (is_midi(channel) and master_of(m, channel) == master))


@compiled_exactly
def bend_range(m: Any, channel: int) -> float:
    """Pitch bend range of a channel (semitones)."""
    usual = m.value[PLAYING.bend_range]
    if m.is_held[PLAYING.bend_range] != 0 or not is_midi(channel):
        return float(usual)
    if not math.isnan(m.bend_range[channel]):
        return float(m.bend_range[channel])
    if master_of(m, channel) != NONE:
        return MEMBER_BEND
    port, own = channel // CHANNELS_PER_PORT, channel % CHANNELS_PER_PORT
    is_lower = own == LOWER_MASTER and m.lower[port] > 0
    is_upper = own == UPPER_MASTER and m.upper[port] > 0
    return MASTER_BEND if is_lower or is_upper else float(usual)


# -- which notes a move affects -------------------------------------------------------------------


@compiled_exactly
def plays(m: Any, t: Any, channel: int) -> bool:
    """Whether the notes of a MIDI channel are played."""
    own = channel % CHANNELS_PER_PORT
    received = int(t.received)
    if received != ALL_BUT_PERCUSSION:
        return received >> own & 1 != 0
    return own != PERCUSSION_CHANNEL or master_of(m, channel) != NONE


@compiled_exactly
def moves_all(m: Any, t: Any, channel: int, is_global: bool) -> bool:
    """Whether moves on a MIDI channel are for all notes.

    They are if its port has played no note, as of a box of pedals or faders, or if their bind is
    global. But a member channel of an MPE zone belongs to one note, and so do its moves.
    """
    if not is_global and m.is_keyboard[channel // CHANNELS_PER_PORT] != 0:
        return False
    if master_of(m, channel) != NONE:
        return False
    return is_global or plays(m, t, channel)


@compiled_exactly
def moves_key(m: Any, t: Any, channel: int, of_key: int, is_global: bool) -> bool:
    """Whether moves on a MIDI channel affect the notes of a channel."""
    own = channel == of_key or (is_midi(of_key) and channel == master_of(m, of_key))
    return own or moves_all(m, t, channel, is_global)


# -- forgetting -----------------------------------------------------------------------------------


@compiled_exactly
def forget_channel(m: Any, channel: int) -> None:
    """Forget what messages have set up, except moves."""
    m.bend_range[channel] = math.nan
    m.coarse_tuning[channel] = m.fine_tuning[channel] = 0.0
    m.sustain[channel] = 0
    m.is_registered[channel] = 1
    m.coarse[channel] = m.fine[channel] = NONE
    m.bank[channel] = m.bank_fine[channel] = 0


@compiled_exactly
def forget_moves(m: Any, channel: int) -> None:
    """Forget all moves on a channel."""
    if m.is_active[channel] != 0:
        for bind in range(MAX_BINDS):
            m.move_number[channel, bind] = m.taken_number[channel, bind] = 0
        for key in range(m.pressure_number.shape[1]):
            m.pressure_number[channel, key] = 0
        drop_active(m, channel)
    m.strike_number[channel] = 0
    for n in range(m.held):
        if m.held_channel[n] == channel:
            m.held_strike_number[n] = 0
    if m.last_channel == channel:
        m.last_strike_number = 0


@compiled_exactly
def add_active(m: Any, channel: int) -> None:
    """Record that something was moved on a channel."""
    if m.is_active[channel] == 0:
        m.is_active[channel] = 1
        m.active[m.actives] = channel
        m.actives += 1


@compiled_exactly
def drop_active(m: Any, channel: int) -> None:
    """Record that nothing is moved on a channel any more."""
    m.is_active[channel] = 0
    place = 0
    while m.active[place] != channel:
        place += 1
    for i in range(place, m.actives - 1):
        m.active[i] = m.active[i + 1]
    m.actives -= 1
