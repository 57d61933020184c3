"""A section: several players who play one part, each an instrument of their own. Compiled.

Commands are passed on to the players: notes at the frame at which each of them begins, which is at
most ``section_players.MAX_LATE_MS`` after the planned one; all else as it is requested, but not
before an earlier note. Keys struck within `CHORD_MS` are a chord, whose notes the players divide;
one line is played by all. Where a note of a chord ends, its players rest until the next note, which
is theirs.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.part_keys import find_key
from yehu_server.core.midi.record import MAX_CHORD, NONE, emit
from yehu_server.core.midi.section_players import own_value, plan_onset, plan_release
from yehu_server.core.player.commands import BEGIN, END, EXPRESS, HOLD, RAMP, SLIDE, WRITE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.core.player.record import MAX_HELD
from yehu_server.params.table import ENGINE

CHORD_MS = 30.0  # keys struck within this time are a chord
INDEX_OF_SLOT = np.array([INDEX[param.address] for param in ENGINE])


# -- when -----------------------------------------------------------------------------------------


@compiled_exactly
def time_of(m: Any, who: int, frame: int) -> int:
    """When a player applies a command for a frame: not before an earlier note."""
    return int(m.waits[who] if m.requested[who] <= frame < m.waits[who] else frame)


@compiled_exactly
def act(m: Any, who: int, frame: int, late: int) -> int:
    """The frame at which a player acts that is `late` frames late; its later commands wait."""
    at = max(time_of(m, who, frame), frame + late)
    m.requested[who], m.waits[who] = frame, at
    return at


# -- passing on -----------------------------------------------------------------------------------


@compiled_exactly
def emit_to_all(
    m: Any,
    frame: int,
    kind: int,
    index: int,
    value: float,
    other: float,
    of_key: bool,
    channel: int,
    key: float,
) -> None:
    """Command something of all players; where `of_key`, of those who play a key, or rest."""
    for who in range(m.players):
        last = m.holds[who] - 1
        if of_key and last >= 0:
            is_theirs = m.holds_channel[who, last] == channel and m.holds_key[who, last] == key
            if not is_theirs:
                continue
        own = own_of(m, who, kind, index, value)
        emit(m, who, time_of(m, who, frame), kind, index, own, other)


@compiled_exactly
def own_of(m: Any, who: int, kind: int, index: int, value: float) -> float:
    """The value of a parameter that is a player's own."""
    parameter = NONE
    if kind in (WRITE, HOLD, EXPRESS):
        parameter = index
    elif kind == RAMP and 0 <= index < len(INDEX_OF_SLOT):
        parameter = INDEX_OF_SLOT[index]
    return float(own_value(parameter, value, who, m.playing))


@compiled_exactly
def sounds(m: Any, number: int) -> bool:
    """Whether a held key sounds: of a section, whether anybody plays it."""
    if number == m.sounding:
        return True
    if m.players == 1:
        return False
    for who in range(m.playing):
        last = m.holds[who] - 1
        if (
            last >= 0
            and m.holds_channel[who, last] == m.held_channel[number]
            and m.holds_key[who, last] == m.held_key[number]
        ):
            return True
    return False


@compiled_exactly
def add_value(m: Any, index: int, value: float) -> None:
    """Keep a value for the note that begins next, or sounds again."""
    for i in range(m.values):
        if m.values_index[i] == index:
            m.values_value[i] = value
            return
    m.values_index[m.values], m.values_value[m.values] = index, value
    m.values += 1


@compiled_exactly
def set_playing_count(m: Any, players: int, frame: int) -> None:
    """Let a number of players play; the others end their notes and rest."""
    for who in range(players, m.players):
        at = act(m, who, frame, 0)
        for _ in range(m.holds[who]):
            n = m.holds[who] - 1
            end_hold(m, who, 0, at, 1.0 if n > 0 else 0.0)
    m.playing = players


@compiled_exactly
def slide_players(m: Any, frame: int, pitch: float) -> None:
    """Slide the fingers of those who play the key pressed last; of all, where nobody does."""
    anybody = False
    for everybody in range(2):
        for who in range(m.playing):
            last = m.holds[who] - 1
            is_theirs = (
                m.sounding != NONE
                and last >= 0
                and m.holds_channel[who, last] == m.held_channel[m.sounding]
                and m.holds_key[who, last] == m.held_key[m.sounding]
            )
            if is_theirs or everybody == 1:
                anybody = True
                emit(m, who, time_of(m, who, frame), SLIDE, 0, pitch, 0.0)
        if anybody:
            return


# -- notes ----------------------------------------------------------------------------------------


@compiled_exactly
def begin_together(m: Any, frame: int, channel: int, key: float, pitch: float) -> None:
    """Begin a note: another one of a chord, or one that all who are free play."""
    n = m.chord if joins_chord(m, frame, channel, key) else 0
    m.chord_channel[n], m.chord_key[n], m.chord_pitch[n] = channel, key, pitch
    m.chord_values[n] = m.values
    for i in range(m.values):
        m.chord_index[n, i], m.chord_value[n, i] = m.values_index[i], m.values_value[i]
    m.values = 0
    m.chord = n + 1
    if n > 0:
        divide(m, frame)
        return
    free = 0
    for who in range(m.playing):
        free += 1 if m.holds[who] == 0 else 0
    m.is_divided = 1 if m.is_divided != 0 and 0 < free < m.playing else 0
    m.assigned = 0
    for who in range(m.playing):
        if m.is_divided == 0 or m.holds[who] == 0:
            m.assigned_player[m.assigned] = who
            m.assigned += 1
    m.chord_at = frame
    plan_onset(m, frame)
    for i in range(m.assigned):
        who = m.assigned_player[i]
        begin_of(m, who, 0, act(m, who, frame, m.late[who]))


@compiled_exactly
def joins_chord(m: Any, frame: int, channel: int, key: float) -> bool:
    """Whether a key is struck soon enough after a chord's, and all of those are held."""
    window = int(np.rint(CHORD_MS * 1e-3 * m.rate))
    if not 0 <= frame - m.chord_at < window or not 0 < m.chord < MAX_CHORD:
        return False
    for n in range(m.chord):
        if m.chord_channel[n] == channel and m.chord_key[n] == key:
            return False
        if find_key(m, m.chord_channel[n], m.chord_key[n]) == NONE:
            return False
    return True


@compiled_exactly
def divide(m: Any, frame: int) -> None:
    """Deal the chord's notes among the players of the onset, evenly, from the top.

    Ten play three notes by 4, 3 and 3. Of more notes than players the highest are played.
    """
    m.is_divided = 1
    for n in range(m.chord):  # by pitch; those of one pitch in the order struck
        place = n
        while place > 0 and m.chord_pitch[m.order[place - 1]] < m.chord_pitch[n]:
            m.order[place] = m.order[place - 1]
            place -= 1
        m.order[place] = n
    each, more = m.assigned // m.chord, m.assigned % m.chord
    assigned = 0
    for place in range(m.chord):
        for _ in range(each + 1 if place < more else each):
            who = m.assigned_player[assigned]
            assigned += 1
            reassign_note(m, who, m.order[place], time_of(m, who, frame))


@compiled_exactly
def reassign_note(m: Any, who: int, note: int, at: int) -> None:
    """Give a player a note of the chord, in place of the one it has."""
    had, channel, key = m.has_note[who], m.note_channel[who], m.note_key[who]
    if had != 0 and channel == m.chord_channel[note] and key == m.chord_key[note]:
        return
    begin_of(m, who, note, at)  # before it began, the same stroke
    if had != 0:
        before = find_hold(m, who, channel, key)
        if before != NONE:
            end_hold(m, who, before, at, 0.0)


@compiled_exactly
def begin_of(m: Any, who: int, note: int, at: int) -> None:
    """Let a player begin a note of the chord."""
    channel, key = m.chord_channel[note], m.chord_key[note]
    m.has_note[who], m.note_channel[who], m.note_key[who] = 1, channel, key
    before = find_hold(m, who, channel, key)
    if before != NONE:
        remove_hold(m, who, before)
    if m.holds[who] == MAX_HELD:
        remove_hold(m, who, 0)
    n = m.holds[who]
    m.holds_channel[who, n], m.holds_key[who, n], m.holds_from[who, n] = channel, key, at
    m.holds[who] += 1
    for i in range(m.chord_values[note]):
        index = m.chord_index[note, i]
        own = own_of(m, who, EXPRESS, index, m.chord_value[note, i])
        emit(m, who, at, EXPRESS, index, own, 0.0)
    emit(m, who, at, BEGIN, channel, key, m.chord_pitch[note])


@compiled_exactly
def find_hold(m: Any, who: int, channel: int, key: float) -> int:
    """The number of a key that a player holds, or NONE."""
    for i in range(m.holds[who]):
        if m.holds_channel[who, i] == channel and m.holds_key[who, i] == key:
            return i
    return NONE


@compiled_exactly
def remove_hold(m: Any, who: int, number: int) -> None:
    """Let a player hold a key no longer."""
    for i in range(number, m.holds[who] - 1):
        m.holds_channel[who, i] = m.holds_channel[who, i + 1]
        m.holds_key[who, i] = m.holds_key[who, i + 1]
        m.holds_from[who, i] = m.holds_from[who, i + 1]
    m.holds[who] -= 1


@compiled_exactly
def end_hold(m: Any, who: int, number: int, at: int, more: float) -> None:
    """End a key that a player holds; 1 where more of its keys end with it."""
    channel, key = m.holds_channel[who, number], m.holds_key[who, number]
    remove_hold(m, who, number)
    emit(m, who, at, END, channel, key, more)


@compiled_exactly
def end_together(m: Any, frame: int) -> None:
    """End the listed keys; a player that holds other keys goes on with the last of those.

    The values that are kept are those of the key that sounds again.
    """
    plan_release(m, frame)
    last = m.held - 1
    while last >= 0 and m.is_listed[last] != 0:
        last -= 1
    for who in range(m.players):
        own, begun = 0, 0
        for i in range(m.listed):
            n = m.list[i]
            hold = find_hold(m, who, m.held_channel[n], m.held_key[n])
            if hold != NONE:
                begun = m.holds_from[who, hold] if own == 0 else max(begun, m.holds_from[who, hold])
                own += 1
        if own == 0:
            continue
        at = act(m, who, frame, max(m.late[who], begun - frame))
        if m.values > 0 and last >= 0 and next_sounding_key_of(m, who) == last:
            for i in range(m.values):
                index = m.values_index[i]
                value = own_of(m, who, EXPRESS, index, m.values_value[i])
                emit(m, who, at, EXPRESS, index, value, 0.0)
        for i in range(m.listed):
            n = m.list[i]
            hold = find_hold(m, who, m.held_channel[n], m.held_key[n])
            if hold != NONE:
                own -= 1
                end_hold(m, who, hold, at, 1.0 if own > 0 else 0.0)
    m.values = 0


@compiled_exactly
def next_sounding_key_of(m: Any, who: int) -> int:
    """Number, among the keys that the part holds, of the one that a player goes on with, or NONE.

    Those that are listed end.
    """
    for hold in range(m.holds[who] - 1, -1, -1):
        for n in range(m.held):
            if m.held_channel[n] == m.holds_channel[who, hold] and (
                m.held_key[n] == m.holds_key[who, hold]
            ):
                if m.is_listed[n] == 0:
                    return n
                break
    return NONE
