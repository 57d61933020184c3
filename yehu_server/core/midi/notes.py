"""Notes of keys, with their velocity, and the pedals that hold them. Compiled."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.compile.memory import address_of, carray
from yehu_server.core.midi.channels import forget_channel, is_midi, master_of, moves_all
from yehu_server.core.midi.emit_wishes import (
    begin_key,
    begin_key_native,
    end_listed,
    end_listed_native,
    express,
)
from yehu_server.core.midi.held_keys import find_key, list_key, next_sounding_key
from yehu_server.core.midi.record import CHANNELS, IN_PORT, MIDI, NONE
from yehu_server.core.midi.tables import CLAMP, KEYS, NOTE, SKIP, TABLES, VELOCITY
from yehu_server.core.midi.values import (
    find_values,
    find_values_native,
    keep_targets_of,
    remember_last,
)
from yehu_server.core.player.fingering import HIGHEST_NOTE, LOWEST_NOTE, OPEN_WITHIN

# -- pitches --------------------------------------------------------------------------------------


@compiled_exactly
def tuned(t: Any, key: float) -> float:
    """The pitch of a key (fractional MIDI note) by the tuning; NaN for none.

    A fractional key lies between the mapped keys below and above.
    """
    if t.is_equal != 0.0:
        return key
    if not 0.0 <= key <= KEYS - 1.0:  # also refuses NaN
        return math.nan
    below, above = math.floor(key), math.ceil(key)
    if below != above:
        while below > 0 and math.isnan(t.pitch[below]):
            below -= 1
        while above < KEYS - 1 and math.isnan(t.pitch[above]):
            above += 1
    low, high = t.pitch[below], t.pitch[above]
    if below != above:  # NaN where one is not mapped
        low += (high - low) * (key - below) / (above - below)
    return float(low)


@compiled_exactly
def fitted(policy: int, note: float) -> float:
    """The note to play for a note out of range; NaN for none.

    One that a tuning puts less than a quarter tone out of range is moved to its end.
    """
    is_near = LOWEST_NOTE - OPEN_WITHIN < note < HIGHEST_NOTE + OPEN_WITHIN
    if is_near or policy == CLAMP:
        return float(min(max(note, LOWEST_NOTE), HIGHEST_NOTE))
    if policy == SKIP or math.isnan(note):
        return math.nan
    if note < LOWEST_NOTE:
        return note + 12.0 * math.ceil((LOWEST_NOTE - note) / 12.0)
    return note - 12.0 * math.ceil((note - HIGHEST_NOTE) / 12.0)


# -- keys -----------------------------------------------------------------------------------------


@native(
    "void(voidptr, voidptr, int64, int64, float64, float64, float64)",
    calls=[find_values_native, begin_key_native],
)
def note_on_native(
    midi_at: Any,
    tables_at: Any,
    frame: int,
    channel: int,
    key: float,
    velocity: float,
    pitch: float,
) -> None:
    """See `note_on`."""
    m = carray(midi_at, (1,), MIDI)[0]
    t = carray(tables_at, (1,), TABLES)[0]
    n = find_key(m, channel, key)
    if n != NONE:
        if m.held_by[n] == NONE:
            m.held_again[n] = frame
        m.held_by[n] = NONE
    wanted = tuned(t, key) if math.isnan(pitch) else pitch
    playable = fitted(int(t.policy), wanted)
    keep_targets_of(m, t, VELOCITY)
    keep_targets_of(m, t, NOTE)
    is_in_range = abs(playable - wanted) <= OPEN_WITHIN  # not where either is NaN
    m.out_of_range += 0 if is_in_range else 1
    if math.isnan(playable):
        return
    if is_midi(channel):
        m.is_keyboard[channel // IN_PORT] = 1
        if key == np.rint(key) and 0 <= key < KEYS:
            m.pressed[channel, int(key)] = 0
    m.count += 1
    place = channel if is_midi(channel) else CHANNELS
    m.struck[place], m.struck_velocity[place], m.struck_key[place] = m.count, velocity, key
    m.notes_of[place] += 1
    m.has_last, m.last_channel, m.last_key = 1, channel, key
    m.last_struck, m.last_velocity = m.count, velocity
    if n != NONE:
        m.held_struck[n], m.held_velocity[n] = m.count, velocity
    struck = m.count
    if velocity >= 0.0:
        express_key(m, t, frame, channel, key)
    begin_key(m, frame, channel, key, playable, velocity, struck)


_note_on = note_on_native.symbol


@compiled_exactly
def note_on(
    m: Any, t: Any, frame: int, channel: int, key: float, velocity: float, pitch: float
) -> None:
    """Begin a note; where the pitch is NaN, at that of the tuning.

    Parameters
    ----------
    velocity : float
        0 to 1; below 0 where the note was given its values before.
    """
    _note_on(address_of(m), address_of(t), frame, channel, key, velocity, pitch)


@compiled_exactly
def express_key(m: Any, t: Any, frame: int, channel: int, key: float) -> None:
    """Give a note that begins, or sounds again, its own values of parameters."""
    find_values(m, t, channel, key)
    for i in range(m.targets):
        row = m.target[i]
        express(m, frame, row, m.found_value[row])


@compiled_exactly
def note_off(m: Any, t: Any, frame: int, channel: int, key: float) -> None:
    """End a note, unless a pedal keeps it."""
    n = find_key(m, channel, key)
    if n == NONE:
        return
    again = m.held_again[n]
    m.held_again[n] = NONE
    if again != NONE and again == frame:
        return  # the note-off of the note before, which some files write after the new note-on
    release_key(m, t, n)
    end_notes(m, t, frame)


@compiled_exactly
def release_key(m: Any, t: Any, number: int) -> None:
    """List a released key among those that end, unless a pedal holds it."""
    pedal = pedal_of(m, t, m.held_channel[number])
    if pedal == NONE:
        m.held_by[number] = NONE
        list_key(m, number)
    else:
        hold_by_pedal(m, number, pedal)


@native("void(voidptr, voidptr, int64)", calls=[find_values_native, end_listed_native])
def end_notes_native(midi_at: Any, tables_at: Any, frame: int) -> None:
    """See `end_notes`."""
    m = carray(midi_at, (1,), MIDI)[0]
    t = carray(tables_at, (1,), TABLES)[0]
    n = next_sounding_key(m)
    if n != NONE:
        channel, key = m.held_channel[n], m.held_key[n]
        remember_last(m, channel, key)
        express_key(m, t, frame, channel, key)
    end_listed(m, frame)


_end_notes = end_notes_native.symbol


@compiled_exactly
def end_notes(m: Any, t: Any, frame: int) -> None:
    """End the notes of the keys listed at once; the one that sounds again has its own values."""
    _end_notes(address_of(m), address_of(t), frame)


@compiled_exactly
def end_all(m: Any, t: Any, frame: int) -> None:
    """End all notes, whatever pedals hold."""
    for n in range(m.held):
        list_key(m, n)
    end_notes(m, t, frame)


# -- pedals ---------------------------------------------------------------------------------------


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


# -- of a channel ----------------------------------------------------------------------------------


@compiled_exactly
def list_channel(m: Any, channel: int) -> None:
    """List the keys of a channel."""
    for n in range(m.held):
        if m.held_channel[n] == channel:
            list_key(m, n)


@compiled_exactly
def end_channel(m: Any, t: Any, frame: int, channel: int) -> None:
    """End the notes of a channel and those its pedal holds, and forget its state."""
    list_channel(m, channel)
    end_notes(m, t, frame)
    lift_pedal(m, t, frame, channel)
    forget_channel(m, channel)
