"""Dispatches posted events: interprets each when it is due, and distributes its commands. Compiled.

The events of a part lie with its first instrument. Each is interpreted once, before the frames
that it is for are computed (``midi.interpret_events``); its commands go to the heaps of those who
play.

Whatever is sent, the work for a frame is bounded: events beyond a budget of what their commands
cost (``mailbox.ready_at``) come at a later frame, MIDI's first. Then the server, each sender of OSC
and each page have an even share each (`next_queue`). Each has a queue of its own.
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_with_aliasing, native
from yehu_server.compile.memory import carray
from yehu_server.core.controls.record import CONTROLS
from yehu_server.core.engine.atomics import at, load_acquire, record_at, store_release
from yehu_server.core.engine.mailbox import (
    FIRST_SENDER,
    HEAP,
    KIND_BITS,
    MAIL,
    MIDI_INPUTS,
    PAGE_QUEUES,
    PAGES,
    QUEUE_SIZES,
    QUEUE_STARTS,
    QUEUES,
    RESERVE,
    ROOM,
    SENDER_QUEUES,
    SERVER,
    SOUND_INPUT,
    STARTS,
    WAITING,
    WRITERS,
    pop,
    push,
    ready_at,
    spend,
)
from yehu_server.core.engine.note_index import (
    NOTES,
    SLOTS_PER_EVENT,
    add_note,
    end_notes,
    take_note,
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
    NOTES_AT,
    POSTED_AT,
    RIG_BYTES,
    RING_SIZES,
    RINGS_AT,
    TABLES_AT,
    count_parts,
)
from yehu_server.core.engine.telemetry import METERS
from yehu_server.core.midi.events import LEAVE, NOTE_OFF, RELEASE_ALL
from yehu_server.core.midi.interpret_events import interpret
from yehu_server.core.midi.part_keys import find_key
from yehu_server.core.midi.record import MIDI, NONE
from yehu_server.core.player.commands import COMMAND, END, LIFT, cost

# Frames from now that an event may be: the server plays whole scores ahead, other writers play
# now, so that what is nonsense of theirs fills the heap for seconds at most.
FARTHEST, FARTHEST_AHEAD = 1 << 40, 1 << 20
LEAST_COST = 2  # of an event, also where it comes to no command
WAITING_BYTES = WAITING.itemsize
SLOT_BYTES = SLOTS_PER_EVENT * NOTES.itemsize


@native
def interpret_events(rigs: Any, end: int) -> int:
    """Interpret what all parts were sent for frames before `end`.

    Returns the frame before which that is done: sooner than `end`, where commands find no room
    until others are applied. `rigs` points to records of dtype RIG. Real time: safe.
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
    drain(rigs, rig, mail, now)
    while mail.pending_events > 0:
        frame = max(now, first_frame(mail), ready_at(mail.interpreting, mail.at_once))
        if frame >= end:
            break
        if not have_room(rigs, part, m.players):
            return int(frame)
        number = next_queue(mail, frame)
        queue = events_of(rig, number)
        is_full = mail.pending[number] == len(queue)
        event, order = queue[0].command, queue[0].order
        kind, index, value, other = event.kind, event.index, event.value, event.other
        pop(queue, mail.pending[number])
        count_event(mail, queue, number, -1)
        price, is_cancelled = LEAST_COST, False
        if kind in STARTS:
            is_cancelled = take_note(notes_of(rig, number), mail.secret, order, index, value)
            is_cancelled = is_cancelled or order < mail.released
        elif kind in (NOTE_OFF, END):
            if find_key(m, index, value) == NONE:
                end_notes(notes_of(rig, number), mail.secret, order, index, value)
        elif kind == RELEASE_ALL:
            mail.released = max(mail.released, order)
        if not is_cancelled:
            interpret(m, at(rig, TABLES_AT), frame, kind, index, value, other)
            price = max(price, hand_over(rigs, part, m))
        spend(mail.interpreting, frame, price)
        mail.finish_tag[number] = mail.virtual_time + price
        if is_full:
            drain(rigs, rig, mail, now)
    return end


@compiled_with_aliasing
def events_of(rig: Any, number: int) -> Any:
    """The entries of a queue of events."""
    start = EVENTS_AT + QUEUE_STARTS[number] * WAITING_BYTES
    return carray(at(rig, start), (QUEUE_SIZES[number],), WAITING)


@compiled_with_aliasing
def notes_of(rig: Any, number: int) -> Any:
    """The index of the note-ons that wait in a queue."""
    start = NOTES_AT + QUEUE_STARTS[number] * SLOT_BYTES
    return carray(at(rig, start), (SLOTS_PER_EVENT * QUEUE_SIZES[number],), NOTES)


@compiled_with_aliasing
def count_event(mail: Any, queue: Any, number: int, more: int) -> None:
    """Count an event that came into a queue (1) or left it (-1)."""
    mail.pending[number] += more
    mail.pending_events += more
    mail.first[number] = queue[0].command.frame


@compiled_with_aliasing
def first_frame(mail: Any) -> int:
    """The frame of the first event of all."""
    frame = FARTHEST
    for number in range(QUEUES):
        if mail.pending[number] > 0:
            frame = min(frame, mail.first[number])
    return int(frame)


@compiled_with_aliasing
def next_queue(mail: Any, frame: int) -> int:
    """The queue whose first event is next, of those that have one due at a frame.

    Inputs come first. Of the others it is the one that had the least work: start-time fair
    queueing (Goyal, Vin and Cheng 1996), which takes one that was idle as even with those it meets,
    and here before them.
    """
    chosen, least = -1, 0
    for number in range(QUEUES):
        if mail.pending[number] == 0 or mail.first[number] > frame:
            continue
        if number in (MIDI_INPUTS, SOUND_INPUT):
            return number
        start_tag = max(mail.finish_tag[number], mail.virtual_time)
        is_less = start_tag == least and mail.finish_tag[number] < mail.finish_tag[chosen]
        if chosen < 0 or start_tag < least or is_less:
            chosen, least = number, start_tag
    mail.virtual_time = least
    return chosen


@compiled_with_aliasing
def drain(rigs: Any, rig: Any, mail: Any, now: int) -> None:
    """Move posted events to the queues of a part, so many from each ring.

    A writer that lost its count, or laps the reader, loses what it wrote; and so does one that
    writes frames too far from now, and a page or sender of OSC whose queue is full. All are
    counted. What finds the queue of the server or of an input full waits in the ring.
    """
    for writer in range(WRITERS):
        farthest = FARTHEST if writer == SERVER else FARTHEST_AHEAD
        size = RING_SIZES[writer]
        ring = carray(at(rig, RINGS_AT[writer]), (size,), COMMAND)
        posted = load_acquire(rig, POSTED_AT + writer * CURSOR_BYTES)
        drained = mail.drained[writer, 0]
        if posted < drained or posted - drained > size:
            mail.dropped[writer, 0] += 1
            drained = posted
        last = min(posted, drained + mail.intake)
        while drained < last:
            event = ring[drained & (size - 1)]
            frame, kind, number = event.frame, event.kind, writer
            index, value = event.index, event.value
            sender = kind >> KIND_BITS
            if writer == PAGES or (writer == SERVER and 0 < sender <= SENDER_QUEUES):
                number = queue_of(writer, sender)
                kind &= (1 << KIND_BITS) - 1
            if number < PAGES and mail.pending[number] == QUEUE_SIZES[number]:
                break
            if writer in (MIDI_INPUTS, SOUND_INPUT):
                frame = frame_of_arrival(rigs, mail, frame)
            drained += 1
            is_near = now - FARTHEST < frame < now + farthest
            if not is_near or not takes(number, mail.pending[number], kind):
                mail.dropped[writer, 0] += 1
                continue
            mail.late[writer] += 1 if frame < now else 0
            mail.most_late[writer] = max(mail.most_late[writer], now - frame)
            queue, pending = events_of(rig, number), mail.pending[number]
            if kind in STARTS:
                add_note(notes_of(rig, number), mail.secret, index, value)
            push(queue, pending, frame, kind, index, value, event.other, mail.ordered)
            count_event(mail, queue, number, 1)
            mail.ordered += 1
        store_release(rig, DRAINED_AT + writer * CURSOR_BYTES, drained)


@compiled_with_aliasing
def queue_of(writer: int, number: int) -> int:
    """The queue of a page, or of a sender, which the server numbers from 1."""
    return PAGES + (number & (PAGE_QUEUES - 1)) if writer == PAGES else FIRST_SENDER + number - 1


@compiled_with_aliasing
def takes(number: int, pending: int, kind: int) -> bool:
    """Whether a queue takes an event: the last entries of pages and senders are for what ends."""
    is_any = number < PAGES or kind in (LEAVE, LIFT, RELEASE_ALL)
    return bool(pending < (QUEUE_SIZES[number] if is_any else QUEUE_SIZES[number] - RESERVE))


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
def hand_over(rigs: Any, part: int, m: Any) -> int:
    """Give those who play a part the commands that an event came to; return what they cost."""
    price = 0
    for n in range(m.commands):
        price += cost(m.out_kind[n], m.out_index[n], m.out_other[n])
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
    return int(price)


@native
def index_notes(rig: Any) -> int:
    """Index all note-ons that wait, anew; return how many there are."""
    mail, count = record_at(rig, MAIL_AT, MAIL), 0
    for number in range(QUEUES):
        queue = events_of(rig, number)
        for n in range(mail.pending[number]):
            event = queue[n].command
            if event.kind in STARTS:
                add_note(notes_of(rig, number), mail.secret, event.index, event.value)
                count += 1
    return count
