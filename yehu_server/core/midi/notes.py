"""Notes of keys: their pitches, how they begin and end. Compiled."""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.midi import note_ends
from yehu_server.core.midi.channels import forget_channel, is_midi
from yehu_server.core.midi.emit_commands import begin_key
from yehu_server.core.midi.part_keys import find_key
from yehu_server.core.midi.record import CHANNEL_COUNT, CHANNELS_PER_PORT, NONE, Midi
from yehu_server.core.midi.sources import set_directly
from yehu_server.core.midi.tables import CLAMP, KEY_COUNT, NOTE, SKIP, VELOCITY, Tables
from yehu_server.core.midi.values import keep_targets_of
from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.params.articulations import ARTICULATIONS

# -- pitches, which Python asks for as well, uncompiled (``playing.tuning``) -----------------------


@compiled_exactly
def pitch_of_key(pitches: Any, key: float) -> float:
    """The pitch of a key, between its neighbours where it is fractional; NaN for none."""
    if not 0.0 <= key <= KEY_COUNT - 1.0:  # also refuses NaN
        return math.nan
    below, above = math.floor(key), math.ceil(key)
    if below != above:
        while below > 0 and math.isnan(pitches[below]):
            below -= 1
        while above < KEY_COUNT - 1 and math.isnan(pitches[above]):
            above += 1
    low, high = pitches[below], pitches[above]
    if below != above:  # NaN where one is not mapped
        low += (high - low) * (key - below) / (above - below)
    return float(low)


@compiled_exactly
def fitted(policy: int, lowest: float, highest: float, note: float) -> float:
    """The note to play for a note out of the range of an instrument; NaN for none.

    One that a tuning puts less than a quarter tone out of range is moved to its end.
    """
    is_near = lowest - OPEN_WITHIN < note < highest + OPEN_WITHIN
    if is_near or policy == CLAMP:
        return float(min(max(note, lowest), highest))
    if policy == SKIP or math.isnan(note):
        return math.nan
    if note < lowest:
        return note + 12.0 * math.ceil((lowest - note) / 12.0)
    return note - 12.0 * math.ceil((note - highest) / 12.0)


# -- keys ------------------------------------------------------------------------------------------

SWITCH_COUNT = len(ARTICULATIONS)  # keys that choose an articulation, where a mapping has them


@compiled_exactly
def is_switch(t: Any, channel: int, key: float) -> bool:
    """Whether a key chooses an articulation and plays no note."""
    place = key - t.first_switch  # NaN where there are no such keys
    return bool(is_midi(channel) and 0.0 <= place < SWITCH_COUNT)


@native
def note_on(
    m: Midi, t: Tables, frame: int, channel: int, key: float, velocity: float, pitch: float
) -> None:
    """Begin a note; at the tuning's pitch for NaN; of a velocity below 0 its values were given."""
    if is_switch(t, channel, key):
        set_directly(m, frame, PLAYING.articulation, key - t.first_switch, 0.0)
        return
    n = find_key(m, channel, key)
    if n != NONE:
        if m.held_by[n] == NONE:
            m.held_again[n] = frame
        m.held_by[n] = NONE
    wanted = pitch
    if math.isnan(pitch):
        wanted = key if t.is_equal != 0.0 else pitch_of_key(t.pitch, key)
        if is_midi(channel):
            wanted += m.coarse_tuning[channel] + m.fine_tuning[channel]
    playable = fitted(int(t.policy), t.lowest, t.highest, wanted)
    keep_targets_of(m, t, VELOCITY)
    keep_targets_of(m, t, NOTE)
    is_in_range = abs(playable - wanted) <= OPEN_WITHIN  # not where either is NaN
    m.out_of_range += 0 if is_in_range else 1
    if math.isnan(playable):
        return
    if is_midi(channel):
        m.is_keyboard[channel // CHANNELS_PER_PORT] = 1
        if key == np.rint(key) and 0 <= key < KEY_COUNT:
            m.pressure_number[channel, int(key)] = 0
    m.moves += 1
    place = channel if is_midi(channel) else CHANNEL_COUNT
    m.strike_number[place], m.strike_velocity[place], m.strike_key[place] = m.moves, velocity, key
    m.notes_of[place] += 1
    m.has_last, m.last_channel, m.last_key = 1, channel, key
    m.last_strike_number, m.last_velocity = m.moves, velocity
    if n != NONE:
        m.held_strike_number[n], m.held_velocity[n] = m.moves, velocity
    strike_number = m.moves
    if velocity >= 0.0:
        note_ends.express_key(m, t, frame, channel, key)
    begin_key(m, frame, channel, key, playable, velocity, strike_number)


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
    note_ends.release_key(m, t, n)
    note_ends.end_notes(m, t, frame)


@compiled_exactly
def end_channel(m: Any, t: Any, frame: int, channel: int) -> None:
    """End the notes of a channel and those its pedal holds, and forget its state."""
    note_ends.list_channel(m, channel)
    note_ends.end_notes(m, t, frame)
    note_ends.lift_pedal(m, t, frame, channel)
    forget_channel(m, channel)
