"""The audio callback, and the other functions of the instrument that C can call. Compiled.

All state of an instrument lies in one record, the rig. Its address is the `userdata` of the
audio stream, in this process or another one. The same callback computes live and offline sound.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.controls.gains import TO_BODY, TO_LIMITER, amplitude, level
from yehu_server.controls.hands import write_controls
from yehu_server.controls.ramps import move
from yehu_server.controls.record import CHUNK, CONTROLS
from yehu_server.controls.slots import BLEND, BODY, LIMITER, LOSS, TUNING
from yehu_server.controls.strings import has_new_strings
from yehu_server.engine.atomics import (
    at,
    fence_acquire,
    fence_release,
    load_acquire,
    store_release,
)
from yehu_server.engine.mailbox import (
    APPLIED_AT_ONCE,
    HEAP,
    LINE,
    MAIL,
    RING,
    WAITING,
    copy_wish,
    leave,
    wait,
)
from yehu_server.engine.output import OUTPUT, fall_silent, play_out
from yehu_server.engine.processor import (
    flush_denormals,
    monotonic_ns,
    restore_denormals,
    thread_cpu_ns,
)
from yehu_server.engine.telemetry import METERS, account, close_window, hear, tell_time
from yehu_server.jit import compiled, compiled_to_share, native
from yehu_server.memory import carray
from yehu_server.physics import kernel
from yehu_server.physics.layout import MODEL, RELATIVE_VELOCITY, STATE, STRINGS
from yehu_server.player.attention import attend
from yehu_server.player.ear import HEARD, remember
from yehu_server.player.notes import told_pitch
from yehu_server.player.record import PLAYER
from yehu_server.player.wishes import WISH, fulfil

Array = Any

TAPE = 1 << 19  # the last samples, for recorders: 10 s at 48 kHz
STALL_NS = 20_000_000
TRIES = 100

RIG = np.dtype(
    [
        ("model", MODEL),
        ("state", STATE),
        ("controls", CONTROLS),
        ("player", PLAYER),
        ("heard", np.float64, 2 * HEARD),
        ("output", OUTPUT),
        ("mail", MAIL),
        ("meters", METERS),
        ("version", np.int64, LINE),
        ("published", METERS),
        ("taped", np.int64, LINE),
        ("ring", WISH, RING),
        ("heap", WAITING, HEAP),
        ("reports", WISH, RING),
        ("tape", np.float32, TAPE),
    ],
    align=True,
)


def _offset(field: str, inside: str = "") -> int:
    fields: Any = RIG.fields
    kind, start = fields[field][:2]
    return int(start + (kind.fields[inside][1] if inside else 0))


MODEL_AT, STATE_AT, CONTROLS_AT = _offset("model"), _offset("state"), _offset("controls")
PLAYER_AT, HEARD_AT = _offset("player"), _offset("heard")
OUTPUT_AT, MAIL_AT, METERS_AT = _offset("output"), _offset("mail"), _offset("meters")
VERSION_AT, PUBLISHED_AT, TAPED_AT = _offset("version"), _offset("published"), _offset("taped")
RING_AT, HEAP_AT, REPORTS_AT = _offset("ring"), _offset("heap"), _offset("reports")
TAPE_AT = _offset("tape")
POSTED_AT, DRAINED_AT = _offset("mail", "posted"), _offset("mail", "drained")
REPORTED_AT, READ_AT = _offset("mail", "reported"), _offset("mail", "read")
fulfil_wish, attend_string = fulfil.symbol, attend.symbol


@compiled_to_share
def drain(rig: Any, mail: Any, frame: int) -> bool:
    """Move posted wishes to the heap, up to the budget of a callback.

    Returns whether some are left because the heap is full: then it is worth trying again soon.
    """
    ring = carray(at(rig, RING_AT), (RING,), WISH)
    heap = carray(at(rig, HEAP_AT), (HEAP,), WAITING)
    posted = load_acquire(rig, POSTED_AT)
    drained = mail.drained[0]
    end = min(posted, drained + mail.budget)
    while drained < end and mail.waiting < HEAP:
        wish = ring[drained & (RING - 1)]
        mail.late += 1 if wish.frame < frame else 0
        wait(heap, mail.waiting, wish, drained)
        mail.waiting += 1
        drained += 1
    store_release(rig, DRAINED_AT, drained)
    return bool(drained < posted and mail.waiting >= HEAP)


@compiled_to_share
def apply(rig: Any, mail: Any, c: Any) -> None:
    """Fulfil the wishes that are due at this frame, and report them."""
    heap = carray(at(rig, HEAP_AT), (HEAP,), WAITING)
    for _ in range(APPLIED_AT_ONCE):
        if mail.waiting == 0 or heap[0].wish.frame > c.frame:
            return
        wish = heap[0].wish
        player, controls = at(rig, PLAYER_AT), at(rig, CONTROLS_AT)
        fulfil_wish(player, controls, c.frame, wish.kind, wish.index, wish.value, wish.other)
        if mail.reporting != 0:
            report(rig, mail, c.frame, wish)
        mail.applied += 1
        leave(heap, mail.waiting)
        mail.waiting -= 1


@compiled_to_share
def report(rig: Any, mail: Any, frame: int, wish: Any) -> None:
    """Report a fulfilled wish for captures, with the frame that it was fulfilled at."""
    reported = mail.reported[0]
    if reported - load_acquire(rig, READ_AT) >= RING:
        mail.unreported += 1
        return
    entry = carray(at(rig, REPORTS_AT), (RING,), WISH)[reported & (RING - 1)]
    copy_wish(wish, entry)
    entry.frame = frame
    store_release(rig, REPORTED_AT, reported + 1)


@compiled
def retune(model: Array, state: Array, c: Any) -> None:
    """Give the model's strings the tuning and loss of this frame."""
    for i in range(STRINGS):
        cents, loss = c.value[TUNING[i]], c.value[LOSS[i]]
        if cents != c.tuning[i] or loss != c.loss[i]:
            c.tuning[i], c.loss[i] = cents, loss
            T = c.tension[i] * 2.0 ** (
                cents / 600.0
            )  # the frequency is proportional to its square root
            kernel.retune(model, state, i, T, c.sigma_0[i] * loss, c.sigma_1[i] * loss)


@compiled_to_share
def play(rig: Any, out: Array) -> None:
    """Compute one block. The samples do not depend on the sizes of blocks.

    Parameters
    ----------
    out : ndarray [shape=(frames, channels), float32]
        In full scale.

    Real time: safe; no allocation, no exception, every sample finite.
    """
    model = carray(at(rig, MODEL_AT), (1,), MODEL)
    state = carray(at(rig, STATE_AT), (1,), STATE)
    c = carray(at(rig, CONTROLS_AT), (1,), CONTROLS)[0]
    o = carray(at(rig, OUTPUT_AT), (1,), OUTPUT)[0]
    mail = carray(at(rig, MAIL_AT), (1,), MAIL)[0]
    t = carray(at(rig, METERS_AT), (1,), METERS)[0]
    p = carray(at(rig, PLAYER_AT), (1,), PLAYER)[0]
    done = 0
    while done < out.shape[0]:
        is_full = drain(rig, mail, c.frame)
        first = c.frame
        frames = 0
        silenced, retuned = False, False
        while frames < CHUNK and done + frames < out.shape[0] and not silenced and not retuned:
            apply(rig, mail, c)
            if is_full:
                is_full = drain(rig, mail, c.frame)
            if c.frame == p.ear.next:
                attend_string(at(rig, PLAYER_AT), at(rig, CONTROLS_AT), at(rig, HEARD_AT))
            move(c)
            write_controls(c, o.controls[frames])
            gain = level(c)
            if c.silence_in > 0:
                c.silence_in -= 1
                gain *= c.silence_in / c.fade
                silenced = c.silence_in == 0
            o.gain[frames] = gain
            o.body[frames] = amplitude(c, TO_BODY, c.value[BODY])
            o.blend[frames] = c.value[BLEND]
            o.soft[frames] = amplitude(c, TO_LIMITER, c.value[LIMITER])
            retuned = has_new_strings(c)
            c.frame += 1
            frames += 1
        # Strings are retuned at the very sample. One call of the kernel, since it is inlined.
        start, end = 0, frames - 1 if retuned else frames
        while start < frames:
            if start == end:
                retune(model, state, c)
                end = frames
            kernel.advance(model, state, o.controls[start:end], o.probes[start:end], None)
            start = end
        put_out(rig, out, done, first, frames)
        if silenced:
            kernel.come_to_rest(model[0], state[0])
            fall_silent(o)
        close_window(t, model[0], state[0].motion)
        done += frames


@compiled_to_share
def put_out(rig: Any, out: Array, done: int, first: int, frames: int) -> None:
    """Put the frames just computed into a block, from its frame `done` on, and onto the tape.

    Parameters
    ----------
    first : int
        Number of the first of the frames since the start.
    """
    o = carray(at(rig, OUTPUT_AT), (1,), OUTPUT)[0]
    t = carray(at(rig, METERS_AT), (1,), METERS)[0]
    tape = carray(at(rig, TAPE_AT), (TAPE,), np.float32)
    heard = carray(at(rig, HEARD_AT), (2 * HEARD,), np.float64)
    for n in range(frames):
        remember(heard, first + n, o.probes[n, RELATIVE_VELOCITY])
        sample: Any = np.float32(play_out(o, n))
        tape[(first + n) & (TAPE - 1)] = sample
        hear(t, sample)
        for channel in range(out.shape[1]):
            out[done + n, channel] = sample


@native("int32(voidptr, voidptr, uint64, voidptr, uint64, voidptr)", calls=[fulfil, attend])
def callback(_input: Any, output: Any, frames: Any, _times: Any, flags: Any, rig: Any) -> int:
    """Compute one block for PortAudio (a PaStreamCallback).

    Parameters
    ----------
    output : pointer to float32 [shape=(frames, channels)]
    rig : pointer to a record of dtype RIG

    Real time: safe; no Python, no lock, no allocation, no exception.
    """
    if frames == 0:
        return 0
    started_ns, cpu_ns = monotonic_ns(), thread_cpu_ns()
    mode = flush_denormals()
    t = carray(at(rig, METERS_AT), (1,), METERS)[0]
    mail = carray(at(rig, MAIL_AT), (1,), MAIL)[0]
    state = carray(at(rig, STATE_AT), (1,), STATE)[0]
    c = carray(at(rig, CONTROLS_AT), (1,), CONTROLS)[0]
    o = carray(at(rig, OUTPUT_AT), (1,), OUTPUT)[0]
    t.running = 1
    block: Any = np.int64(frames)
    tell_time(t, c.frame, started_ns, block)
    publish(rig)  # at once, so that messages that arrive now are stamped by this block
    play(rig, carray(output, (block, o.channels), np.float32))
    t.unconverged, t.lost = state.unconverged, state.lost + o.unsound
    t.late_events, t.applied, t.drained = mail.late, mail.applied, mail.drained[0]
    t.next_frame = c.frame
    t.pitch = told_pitch(carray(at(rig, PLAYER_AT), (1,), PLAYER)[0])
    t.waiting, t.unreported = mail.waiting, mail.unreported
    restore_denormals(mode)
    account(t, thread_cpu_ns() - cpu_ns, flags)
    t.running, t.ended_ns = 0, monotonic_ns()
    store_release(rig, TAPED_AT, c.frame)
    publish(rig)
    return 0


@compiled_to_share
def publish(rig: Any) -> None:
    """Publish the meters by a seqlock: readers get all of a block's, or none."""
    version = load_acquire(rig, VERSION_AT)
    store_release(rig, VERSION_AT, version + 1)
    fence_release()
    carray(at(rig, PUBLISHED_AT), (1,), METERS)[0] = carray(at(rig, METERS_AT), (1,), METERS)[0]
    store_release(rig, VERSION_AT, version + 2)


@native("int64(voidptr, voidptr)")
def read_meters(rig: Any, into: Any) -> int:
    """Copy the published meters; return 0 where they were written meanwhile (try again)."""
    version = load_acquire(rig, VERSION_AT)
    carray(into, (1,), METERS)[0] = carray(at(rig, PUBLISHED_AT), (1,), METERS)[0]
    fence_acquire()
    return 1 if version % 2 == 0 and load_acquire(rig, VERSION_AT) == version else 0


@native("float64(voidptr, int64)")
def frame_at(rig: Any, time_ns: int) -> float:
    """The frame that is played at a time of the monotonic clock, by the last callback's time.

    Without further callbacks it stops `STALL_NS` after the last block.
    """
    published = carray(at(rig, PUBLISHED_AT), (1,), METERS)[0]
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


@native("int64(voidptr, int64, int64, int64, float64, float64)")
def post(rig: Any, frame: int, kind: int, index: int, value: float, other: float) -> int:
    """Post a wish, by its fields; return 0 where it was dropped because the ring is full.

    Only one thread at a time may post.
    """
    mail = carray(at(rig, MAIL_AT), (1,), MAIL)[0]
    posted = mail.posted[0]
    if posted - load_acquire(rig, DRAINED_AT) >= RING:
        mail.dropped[0] += 1
        return 0
    entry = carray(at(rig, RING_AT), (RING,), WISH)[posted & (RING - 1)]
    entry.frame, entry.kind, entry.index = frame, kind, index
    entry.value, entry.other = value, other
    store_release(rig, POSTED_AT, posted + 1)
    return 1


@native("int64(voidptr, voidptr, int64)")
def read_reports(rig: Any, into: Any, room: int) -> int:
    """Move reports of wishes to an array of WISH [shape=(room,)]; return their number."""
    mail = carray(at(rig, MAIL_AT), (1,), MAIL)[0]
    reports = carray(at(rig, REPORTS_AT), (RING,), WISH)
    wishes = carray(into, (room,), WISH)
    read = mail.read[0]
    count = int(min(load_acquire(rig, REPORTED_AT) - read, room))
    for i in range(count):
        wishes[i] = reports[(read + i) & (RING - 1)]
    store_release(rig, READ_AT, read + count)
    return count


@native("int64(voidptr)")
def taped(rig: Any) -> int:
    """Number of frames played and on the tape."""
    return int(load_acquire(rig, TAPED_AT))
