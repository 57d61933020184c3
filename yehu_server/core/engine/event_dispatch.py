"""Dispatches posted events: interprets each when it is due, and distributes its commands. Compiled.

The events of a part lie with its first instrument. Each is interpreted once, before the frames
that it is for are computed (``midi.interpret_events``); its commands go to the heaps of those who
play.
"""

from __future__ import annotations

import math
from typing import Any

from yehu_server.compile.jit import compiled_with_aliasing, native
from yehu_server.compile.memory import carray
from yehu_server.core.controls.record import CONTROLS
from yehu_server.core.engine.atomics import at, load_acquire, record_at, store_release
from yehu_server.core.engine.mailbox import (
    HEAP,
    MAIL,
    MIDI_INPUTS,
    ROOM,
    SERVER,
    SOUND_INPUT,
    WAITING,
    WRITERS,
    pop,
    push,
)
from yehu_server.core.engine.rig import (
    CONTROLS_AT,
    CURSOR_BYTES,
    DRAINED_AT,
    EVENTS_AT,
    HEAP_AT,
    MAIL_AT,
    METERS_AT,
    MIDI_AT,
    POSTED_AT,
    RIG_BYTES,
    RING_SIZES,
    RINGS_AT,
    TABLES_AT,
    count_parts,
)
from yehu_server.core.engine.telemetry import METERS
from yehu_server.core.midi.events import FINGER_ON, NOTE_OFF, NOTE_ON, RELEASE_ALL
from yehu_server.core.midi.interpret_events import interpret
from yehu_server.core.midi.part_keys import find_key
from yehu_server.core.midi.record import MIDI, NONE
from yehu_server.core.player.commands import BEGIN, COMMAND, END

NOTHING = -1  # the kind of an event that was cancelled
# Frames from now that an event may be: the server plays whole scores ahead, other writers play
# now, so that what is nonsense of theirs fills the heap for seconds at most.
FARTHEST, FARTHEST_AHEAD = 1 << 40, 1 << 20


@native
def interpret_events(rigs: Any, end: int) -> int:
    """Interpret what all parts were sent for frames before `end`.

    Returns the frame before which that is done: sooner than `end`, where commands find no room
    until others are applied.

    Parameters
    ----------
    rigs : pointer to records of dtype RIG

    Real time: safe.
    """
    now = record_at(rigs, CONTROLS_AT, CONTROLS).frame
    done = end
    for part in range(count_parts(rigs)):
        if record_at(rigs, part * RIG_BYTES + MIDI_AT, MIDI).players > 0:
            done = min(done, interpret_part_events(rigs, part, now, end))
    return int(max(done, now + 1))


@compiled_with_aliasing
def interpret_part_events(rigs: Any, part: int, now: int, end: int) -> int:
    """Interpret the events of the part with this first instrument; see `interpret_events`."""
    rig = at(rigs, part * RIG_BYTES)
    mail = record_at(rig, MAIL_AT, MAIL)
    m = record_at(rig, MIDI_AT, MIDI)
    events = carray(at(rig, EVENTS_AT), (HEAP,), WAITING)
    drain(rigs, rig, mail, now)
    while mail.pending_events > 0 and events[0].command.frame < end:
        if not have_room(rigs, part, m.players):
            return int(max(events[0].command.frame, now))
        is_full = mail.pending_events == HEAP
        event, order = events[0].command, events[0].order
        frame, kind, index = max(event.frame, now), event.kind, event.index
        value, other = event.value, event.other
        pop(events, mail.pending_events)
        mail.pending_events -= 1
        if kind in (NOTE_OFF, END, RELEASE_ALL):
            cancel(events, mail.pending_events, m, order, kind, index, value)
        interpret(m, at(rig, TABLES_AT), frame, kind, index, value, other)
        hand_over(rigs, part, m)
        if is_full:
            drain(rigs, rig, mail, now)
    return end


@compiled_with_aliasing
def drain(rigs: Any, rig: Any, mail: Any, now: int) -> None:
    """Move posted events to the heap of a part, up to the budget of a callback.

    A writer that lost its count, or laps the reader, loses what it wrote; and so does one that
    writes frames too far from now, which would fill the heap for ever. Both are counted.
    """
    events = carray(at(rig, EVENTS_AT), (HEAP,), WAITING)
    for writer in range(WRITERS):
        farthest = FARTHEST if writer == SERVER else FARTHEST_AHEAD
        size = RING_SIZES[writer]
        ring = carray(at(rig, RINGS_AT[writer]), (size,), COMMAND)
        posted = load_acquire(rig, POSTED_AT + writer * CURSOR_BYTES)
        drained = mail.drained[writer, 0]
        if posted < drained or posted - drained > size:
            mail.dropped[writer, 0] += 1
            drained = posted
        last = min(posted, drained + mail.budget)
        while drained < last and mail.pending_events < HEAP:
            event = ring[drained & (size - 1)]
            frame = event.frame
            if writer in (MIDI_INPUTS, SOUND_INPUT):
                frame = frame_of_arrival(rigs, mail, frame)
            drained += 1
            if not now - FARTHEST < frame < now + farthest:
                mail.dropped[writer, 0] += 1
                continue
            mail.late[writer] += 1 if frame < now else 0
            mail.most_late[writer] = max(mail.most_late[writer], now - frame)
            push(
                events,
                mail.pending_events,
                frame,
                event.kind,
                event.index,
                event.value,
                event.other,
                mail.ordered,
            )
            mail.pending_events += 1
            mail.ordered += 1
        store_release(rig, DRAINED_AT + writer * CURSOR_BYTES, drained)


@compiled_with_aliasing
def frame_of_arrival(rigs: Any, mail: Any, time_ns: int) -> int:
    """The frame at which a message sounds that arrived at a time of the monotonic clock.

    Small corrections of the clock must not swap messages that arrive close together.
    """
    t = record_at(rigs, METERS_AT, METERS)
    elapsed = (time_ns - t.loop.due_ns) / t.loop.ns_per_frame
    frame = t.frame + math.floor(elapsed) + mail.delay[0]
    if mail.arrived - frame > t.rate:  # no small correction
        mail.arrived = frame
    mail.arrived = max(mail.arrived, frame)
    return int(mail.arrived)


@compiled_with_aliasing
def have_room(rigs: Any, part: int, players: int) -> bool:
    """Whether all who play a part have room for the commands of another event."""
    for who in range(players):
        rig = at(rigs, (part + who) * RIG_BYTES)
        if HEAP - record_at(rig, MAIL_AT, MAIL).waiting < ROOM:
            return False
    return True


@compiled_with_aliasing
def hand_over(rigs: Any, part: int, m: Any) -> None:
    """Give those who play a part the commands that an event came to."""
    for n in range(m.commands):
        rig = at(rigs, (part + m.out_player[n]) * RIG_BYTES)
        mail = record_at(rig, MAIL_AT, MAIL)
        if mail.waiting == HEAP:
            mail.dropped[0, 0] += 1
            continue
        heap = carray(at(rig, HEAP_AT), (HEAP,), WAITING)
        push(
            heap,
            mail.waiting,
            m.out_frame[n],
            m.out_kind[n],
            m.out_index[n],
            m.out_value[n],
            m.out_other[n],
            mail.ordered,
        )
        mail.waiting += 1
        mail.ordered += 1


@compiled_with_aliasing
def cancel(
    events: Any, coming: int, m: Any, order: int, kind: int, channel: int, key: float
) -> None:
    """Cancel scheduled note-ons whose note-off arrives before they begin.

    Parameters
    ----------
    order : int
        Of the event that ends it: what was posted later stays.
    """
    if kind != RELEASE_ALL and find_key(m, channel, key) != NONE:
        return
    for n in range(coming):
        event = events[n].command
        if event.kind not in (NOTE_ON, FINGER_ON, BEGIN) or events[n].order > order:
            continue
        if kind == RELEASE_ALL or (event.index == channel and event.value == key):
            event.kind = NOTHING
