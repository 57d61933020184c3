"""The values that tables give their targets, for each note. Compiled.

Of several sources of one target the one moved last counts; a direct write counts as a move. Moves
on a channel affect the notes of that channel, or all notes (``channels.moves_all``).
"""

from typing import Any

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi.channels import bend_range, is_midi, master_of, moves_all
from yehu_server.core.midi.curves import along_curve, from_unit, inverted
from yehu_server.core.midi.part_keys import find_key
from yehu_server.core.midi.record import CHANNELS_PER_PORT, NONE, Midi
from yehu_server.core.midi.tables import KEY_COUNT, NOTE, POLY_PRESSURE, VELOCITY, Tables

STEPS = 127.0  # largest value of 7 bits
NO_KEY = -1.0


@compiled_exactly
def receives(t: Any, bind: int, channel: int) -> bool:
    """Whether a bind receives on a channel."""
    channels = int(t.channels[bind])
    return channels == 0 or (channel >= 0 and channels >> (channel % CHANNELS_PER_PORT) & 1 != 0)


@compiled_exactly
def is_of_note(source: int) -> bool:
    """Whether a source belongs to one note."""
    return source in (POLY_PRESSURE, VELOCITY, NOTE)


@compiled_exactly
def keep_target(m: Any, index: int) -> None:
    """Record the present value of a target, before its first move."""
    if m.is_target[index] == 0:
        m.is_target[index] = 1
        m.target[m.targets] = index
        m.targets += 1
        m.set_number[index], m.set_to[index] = 0, m.value[index]


@compiled_exactly
def keep_targets_of(m: Any, t: Any, source: int) -> None:
    """Record the present values of a source's targets, before its first move."""
    for bind in range(int(t.binds)):
        if int(t.source[bind]) == source:
            keep_target(m, int(t.target[bind]))


@compiled_exactly
def set_target(m: Any, index: int, value: float) -> None:
    """Record a direct write."""
    keep_target(m, index)
    m.moves += 1
    m.set_number[index], m.set_to[index] = m.moves, value


@compiled_exactly
def struck_by(m: Any, channel: int, key: float) -> tuple[int, float]:
    """Number and value of the velocity of a note; 0 for none."""
    n = find_key(m, channel, key)
    if n != NONE:
        return m.held_strike_number[n], m.held_velocity[n]
    if m.has_last != 0 and m.last_channel == channel and m.last_key == key:
        return m.last_strike_number, m.last_velocity
    return 0, 0.0


@compiled_exactly
def move_of(m: Any, t: Any, bind: int, channel: int, key: float) -> tuple[int, float]:
    """Number and position of the move that a bind acts on, for a note of a channel; 0: none."""
    source = int(t.source[bind])
    if not receives(t, bind, channel):
        return 0, 0.0
    if source in (VELOCITY, NOTE):
        number, velocity = struck_by(m, channel, key)
        return number, (key / STEPS if source == NOTE else velocity)
    if not is_midi(channel):
        return 0, 0.0
    if source == POLY_PRESSURE:
        n = int(key)
        if not 0 <= n < KEY_COUNT or n != key:
            return 0, 0.0
        return m.pressure_number[channel, n], m.pressure[channel, n]
    if t.soft[bind] != 0.0:
        return m.taken_number[channel, bind], m.taken_position[channel, bind]
    first = int(t.first[bind])
    return m.move_number[channel, first], m.position[channel, first]


@compiled_exactly
def latest_for_all(m: Any, t: Any, bind: int, but: int) -> tuple[int, float, int]:
    """The latest move for all notes that a bind acts on, but of one channel; and its channel.

    Before the first note there is none: each move applies as it comes, and that note sees them all.
    """
    number, position, channel = 0, 0.0, NONE
    if m.has_last == 0 or is_of_note(int(t.source[bind])):
        return number, position, channel
    is_global = t.for_all[bind] != 0.0
    for i in range(m.actives):
        other = m.active[i]
        if other != but and moves_all(m, t, other, is_global):
            its_number, its_position = move_of(m, t, bind, other, NO_KEY)
            if its_number > number:
                number, position, channel = its_number, its_position, other
    return number, position, channel


@native
def resolve_values(m: Midi, t: Tables, channel: int, key: float) -> None:
    """Find the values of all targets that were ever moved, for a note of a channel.

    The latest counts of the write to a target, the channel's own moves, and the moves for all
    notes. A note in an MPE zone has its master's moves where its channel has none. Bends add up:
    that of the note's channel, of the master, and for all notes.
    """
    for i in range(m.targets):
        index = m.target[i]
        m.resolved_number[index], m.resolved_value[index] = m.set_number[index], m.set_to[index]
    master = master_of(m, channel)
    for bind in range(int(t.binds)):
        number, position = move_of(m, t, bind, channel, key)
        if number == 0 and master != NONE:
            number, position = move_of(m, t, bind, master, key)
        other, at, other_channel = latest_for_all(m, t, bind, channel)
        if other > number:
            number, position = other, at
        index = int(t.target[bind])
        if number == 0 or number < m.resolved_number[index]:
            continue
        value = from_unit(t, bind, position)
        if int(t.source[bind]) == VELOCITY:
            value *= velocity_factor(m, t, index)
        elif t.by_range[bind] != 0.0:
            value = bend_of(m, t, bind, channel)
            if master != NONE:
                value += bend_of(m, t, bind, master)
            if other_channel not in (NONE, master):
                value += bend_of(m, t, bind, other_channel)
        m.resolved_number[index], m.resolved_value[index] = number, value


@compiled_exactly
def velocity_factor(m: Any, t: Any, index: int) -> float:
    """Ratio of a target's set value to its start value.

    Velocity comes with every note: without this factor a preset's value would last only until the
    next note.
    """
    start = t.usual[index]
    return float(m.set_to[index] / start if start > 0.0 else 1.0)


@compiled_exactly
def bend_of(m: Any, t: Any, bind: int, channel: int) -> float:
    """Bend of a channel (semitones)."""
    if not receives(t, bind, channel):
        return 0.0
    position = 0.5
    if is_midi(channel):
        first = int(t.first[bind])
        if m.move_number[channel, first] != 0:
            position = m.position[channel, first]
    unit = along_curve(t, bind, inverted(t, bind, position), 0.0, 1.0)
    return (2.0 * unit - 1.0) * bend_range(m, channel)


@compiled_exactly
def remember_last(m: Any, channel: int, key: float) -> None:
    """Record the key whose note sounds, or will; it is held."""
    m.last_strike_number, m.last_velocity = struck_by(m, channel, key)
    m.has_last, m.last_channel, m.last_key = 1, channel, key
