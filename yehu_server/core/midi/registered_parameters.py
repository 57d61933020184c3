"""Registered and other parameters (RPN, NRPN): selects one, and enters its value. Compiled.

Registered are the bend range, the tuning of a channel and MPE's configuration; others are sources
of a mapping. The bend range that a part begins with is a row of ``params.table``.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi import sources
from yehu_server.core.midi.channels import (
    bend_range,
    configure_zone,
    forget_moves,
    is_in_zone,
    master_of,
)
from yehu_server.core.midi.emit_commands import in_range
from yehu_server.core.midi.notes import end_channel
from yehu_server.core.midi.record import CHANNELS_PER_PORT, NONE
from yehu_server.core.midi.tables import BEND, NRPN
from yehu_server.core.player.parameter_indices import PLAYING

# Control changes that select a parameter, and enter its value.
DATA_ENTRY, DATA_ENTRY_FINE = 6, 38
INCREMENT, DECREMENT = 96, 97
NRPN_FINE, NRPN_COARSE, RPN_FINE, RPN_COARSE = 98, 99, 100, 101
BEND_RANGE, FINE_TUNING, COARSE_TUNING, MPE_CONFIGURATION = 0, 1, 2, 6  # registered parameters
CENTRE, FINE_STEPS = 64, 8192.0  # no tuning, of 7 bits; and the steps of a semitone, of 14


@compiled_exactly
def select(m: Any, channel: int, control: int, value: int) -> None:
    """Select a parameter by one half of its number; RPN and NRPN do not mix."""
    is_registered = 1 if control in (RPN_COARSE, RPN_FINE) else 0
    if m.is_registered[channel] != is_registered:
        m.is_registered[channel] = is_registered
        m.coarse[channel] = m.fine[channel] = NONE
    if control in (RPN_COARSE, NRPN_COARSE):
        m.coarse[channel] = value
    else:
        m.fine[channel] = value


@compiled_exactly
def enter_data(m: Any, t: Any, frame: int, channel: int, control: int, value: int) -> None:
    """Set the parameter that is selected."""
    coarse, fine = m.coarse[channel], m.fine[channel]
    if min(coarse, fine) == NONE:
        return
    number = coarse << 7 | fine
    if m.is_registered[channel] == 0:
        source = NRPN + number
        if control == DATA_ENTRY:
            sources.move_source_coarse(m, t, frame, source, channel, value)
        elif control == DATA_ENTRY_FINE:
            sources.move_source_fine(m, t, frame, source, channel, value)
        else:
            sources.step_source(m, t, frame, source, channel, 1.0 if control == INCREMENT else -1.0)
    elif number == MPE_CONFIGURATION and control == DATA_ENTRY:
        set_zone(m, t, frame, channel, value)
    elif number == BEND_RANGE:
        set_bend_range(m, t, frame, channel, control, value)
    elif number in (FINE_TUNING, COARSE_TUNING):
        set_tuning(m, channel, number, control, value)


@compiled_exactly
def set_tuning(m: Any, channel: int, number: int, control: int, value: int) -> None:
    """Set the coarse or fine tuning of a channel, for notes that begin from now on."""
    way = 1 if control == INCREMENT else -1
    if number == COARSE_TUNING:
        if control == DATA_ENTRY:
            m.coarse_tuning[channel] = value - CENTRE
        elif control in (INCREMENT, DECREMENT):
            m.coarse_tuning[channel] += way
        m.coarse_tuning[channel] = min(max(m.coarse_tuning[channel], -64.0), 63.0)
        return
    steps = int(np.rint((m.fine_tuning[channel] + 1.0) * FINE_STEPS))
    if control == DATA_ENTRY:
        steps = value << 7
    elif control == DATA_ENTRY_FINE:
        steps = (steps >> 7 << 7) | value
    else:
        steps += way
    m.fine_tuning[channel] = min(max(steps / FINE_STEPS - 1.0, -1.0), 1.0 - 1.0 / FINE_STEPS)


@compiled_exactly
def set_bend_range(m: Any, t: Any, frame: int, channel: int, control: int, value: int) -> None:
    """Set a channel's bend range; that of a member of an MPE zone is that of all members."""
    whole = int(np.rint(bend_range(m, channel) * 100.0))
    semitones, cents = whole // 100, whole % 100
    if control == DATA_ENTRY:
        semitones = value
    elif control == DATA_ENTRY_FINE:
        cents = min(value, 99)
    else:
        semitones += 1 if control == INCREMENT else -1
    found = in_range(PLAYING.bend_range, semitones + cents / 100.0)
    m.bend_range[channel] = found
    master = master_of(m, channel)
    if master != NONE:
        for member in range(
            CHANNELS_PER_PORT * (channel // CHANNELS_PER_PORT),
            CHANNELS_PER_PORT * (channel // CHANNELS_PER_PORT + 1),
        ):
            if master_of(m, member) == master:
                m.bend_range[member] = found
    sources.write_targets(m, t, frame, BEND, channel, False)


@compiled_exactly
def set_zone(m: Any, t: Any, frame: int, channel: int, members: int) -> None:
    """Create or end an MPE zone; the notes of its channels end and their state is forgotten."""
    port = channel // CHANNELS_PER_PORT
    first = CHANNELS_PER_PORT * port
    was_member = 0
    for own in range(CHANNELS_PER_PORT):
        was_member |= (1 << own) if is_in_zone(m, first + own, channel) else 0
    if not configure_zone(m, channel, members):
        return
    for own in range(CHANNELS_PER_PORT):
        if was_member >> own & 1 != 0 or is_in_zone(m, first + own, channel):
            end_channel(m, t, frame, first + own)
            forget_moves(m, first + own)
    m.is_registered[channel] = 1
    m.coarse[channel], m.fine[channel] = MPE_CONFIGURATION >> 7, MPE_CONFIGURATION & 0x7F
