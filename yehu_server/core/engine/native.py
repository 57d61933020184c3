"""The audio callback, and the other functions of the instrument that C can call. Compiled.

All state of the instruments that play together, and of their stage, lies in one piece of memory:
``rig``. Its address is the `userdata` of the audio stream, in this process or another one. The same
callback computes live and offline sound.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import Int32, UInt64, compiled_with_aliasing, native
from yehu_server.compile.memory import carray
from yehu_server.core.controls.record import CHUNK, CONTROLS
from yehu_server.core.engine.atomics import (
    at,
    fence_acquire,
    fence_release,
    load_acquire,
    record_at,
    store_release,
)
from yehu_server.core.engine.event_dispatch import interpret_events
from yehu_server.core.engine.mailbox import MAIL, RING, SERVER, WRITERS
from yehu_server.core.engine.mixing import mix
from yehu_server.core.engine.output import OUTPUT
from yehu_server.core.engine.processor import (
    flush_denormals,
    monotonic_ns,
    restore_denormals,
    thread_cpu_ns,
)
from yehu_server.core.engine.rig import (
    CONTROLS_AT,
    CURSOR_BYTES,
    DRAINED_AT,
    MAIL_AT,
    METERS_AT,
    OUTPUT_AT,
    PLAYER_AT,
    POSTED_AT,
    PUBLISHED_AT,
    READ_AT,
    REPORTED_AT,
    REPORTS_AT,
    RIG_BYTES,
    RING_SIZES,
    RINGS_AT,
    SOUNDED_AT,
    STATE_AT,
    TAPED_AT,
    VERSION_AT,
    count_parts,
)
from yehu_server.core.engine.sounding import sound
from yehu_server.core.engine.telemetry import METERS, account, update_clock
from yehu_server.core.physics.layout import STATE
from yehu_server.core.player.commands import COMMAND
from yehu_server.core.player.notes import sounding_pitch
from yehu_server.core.player.record import PLAYER
from yehu_server.core.stage.record import STAGE

STALL_NS = 20_000_000
TRIES = 100


@native
def publish(rig: Any) -> None:
    """Publish the meters by a seqlock: readers get all of a block's, or none."""
    version = load_acquire(rig, VERSION_AT)
    store_release(rig, VERSION_AT, version + 1)
    fence_release()
    carray(at(rig, PUBLISHED_AT), (1,), METERS)[0] = record_at(rig, METERS_AT, METERS)
    store_release(rig, VERSION_AT, version + 2)


@native
def callback(
    _input: Any, output: Any, frames: UInt64, _times: Any, flags: UInt64, rigs: Any
) -> Int32:
    """Compute one block for PortAudio (a PaStreamCallback) into float32 [shape=(frames, channels)].

    `rigs` points to records of dtype RIG, and one of dtype STAGE after them. Real time: safe; no
    Python, no lock, no allocation, no exception.
    """
    if frames == 0:
        return 0
    started_ns, cpu_ns = monotonic_ns(), thread_cpu_ns()
    mode = flush_denormals()
    t = record_at(rigs, METERS_AT, METERS)
    c = record_at(rigs, CONTROLS_AT, CONTROLS)
    parts = count_parts(rigs)
    channels = record_at(rigs, parts * RIG_BYTES, STAGE).channels
    t.running = 1
    block: Any = np.int64(frames)
    update_clock(t, c.frame, started_ns, block)
    publish(rigs)  # at once, so that messages that arrive now are stamped by this block
    done = 0
    while done < block:
        first = c.frame
        count = interpret_events(rigs, first + min(block - done, CHUNK)) - first
        for part in range(parts):
            rig = at(rigs, part * RIG_BYTES)
            sound(rig, count, at(rig, SOUNDED_AT))
        here = at(output, 4 * channels * done)
        mix(rigs, at(rigs, SOUNDED_AT), RIG_BYTES, first, count, here, here, 0)
        done += count
    for part in range(parts):
        update_meters(at(rigs, part * RIG_BYTES), t.frame, block)
    restore_denormals(mode)
    account(t, thread_cpu_ns() - cpu_ns, flags)
    t.running, t.ended_ns = 0, monotonic_ns()
    store_release(rigs, TAPED_AT, c.frame)
    for part in range(parts):
        publish(at(rigs, part * RIG_BYTES))
    return 0


@compiled_with_aliasing
def update_meters(rig: Any, frame: int, block: int) -> None:
    """Write what a block did to one instrument into its meters."""
    t = record_at(rig, METERS_AT, METERS)
    mail = record_at(rig, MAIL_AT, MAIL)
    state = record_at(rig, STATE_AT, STATE)
    o = record_at(rig, OUTPUT_AT, OUTPUT)
    t.frame, t.block = frame, block
    t.unconverged, t.lost = state.unconverged, state.lost + o.invalid_samples
    t.late_events = 0
    for writer in range(WRITERS):
        t.late_events += mail.late[writer]
    t.applied, t.drained = mail.applied, mail.drained[SERVER, 0]
    t.next_frame = record_at(rig, CONTROLS_AT, CONTROLS).frame
    t.pitch = sounding_pitch(record_at(rig, PLAYER_AT, PLAYER))
    t.waiting, t.unreported = mail.pending_events + mail.waiting, mail.unreported


@native
def read_meters(rig: Any, into: Any) -> int:
    """Copy the published meters; return 0 where they were written meanwhile (try again)."""
    version = load_acquire(rig, VERSION_AT)
    carray(into, (1,), METERS)[0] = record_at(rig, PUBLISHED_AT, METERS)
    fence_acquire()
    return 1 if version % 2 == 0 and load_acquire(rig, VERSION_AT) == version else 0


@native
def frame_at(rig: Any, time_ns: int) -> float:
    """The frame that is played at a time of the monotonic clock, by the last callback's time.

    Without further callbacks it stops `STALL_NS` after the last block.
    """
    published = record_at(rig, PUBLISHED_AT, METERS)
    frame, elapsed_ns, ns_per_frame = 0, 0, 1.0
    for _ in range(TRIES):
        version = load_acquire(rig, VERSION_AT)
        frame, elapsed_ns = published.frame, time_ns - published.loop.due_ns
        ns_per_frame, block = published.loop.ns_per_frame, published.block
        elapsed_ns = min(elapsed_ns, STALL_NS + int(block * ns_per_frame))
        fence_acquire()
        if version % 2 == 0 and load_acquire(rig, VERSION_AT) == version:
            break
    return frame + elapsed_ns / ns_per_frame


@native
def post(rig: Any, frame: int, kind: int, index: int, value: float, other: float) -> int:
    """Post an event, by its fields; return 0 where it was dropped because the ring is full.

    Only one thread at a time may post.
    """
    return post_to(rig, SERVER, frame, kind, index, value, other)


@native
def post_from(
    rig: Any, writer: int, frame: int, kind: int, index: int, value: float, other: float
) -> int:
    """Post an event to the ring of one of ``mailbox.WRITERS``; see `post`."""
    return post_to(rig, writer, frame, kind, index, value, other)


@compiled_with_aliasing
def post_to(
    rig: Any, writer: int, frame: int, kind: int, index: int, value: float, other: float
) -> int:
    """See `post_from`."""
    mail = record_at(rig, MAIL_AT, MAIL)
    posted, size = mail.posted[writer, 0], RING_SIZES[writer]
    if posted - load_acquire(rig, DRAINED_AT + writer * CURSOR_BYTES) >= size:
        mail.dropped[writer, 0] += 1
        return 0
    entry = carray(at(rig, RINGS_AT[writer]), (size,), COMMAND)[posted & (size - 1)]
    entry.frame, entry.kind, entry.index = frame, kind, index
    entry.value, entry.other = value, other
    store_release(rig, POSTED_AT + writer * CURSOR_BYTES, posted + 1)
    return 1


@native
def read_reports(rig: Any, into: Any, room: int) -> int:
    """Move reports of commands to an array of COMMAND [shape=(room,)]; return their number."""
    mail = record_at(rig, MAIL_AT, MAIL)
    reports = carray(at(rig, REPORTS_AT), (RING,), COMMAND)
    commands = carray(into, (room,), COMMAND)
    read = mail.read[0]
    count = int(min(load_acquire(rig, REPORTED_AT) - read, room))
    for i in range(count):
        commands[i] = reports[(read + i) & (RING - 1)]
    store_release(rig, READ_AT, read + count)
    return count


@native
def taped(rig: Any) -> int:
    """Number of frames played and on the tape."""
    return int(load_acquire(rig, TAPED_AT))
