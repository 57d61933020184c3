"""Mixes all instruments, placed in the room, to left and right, and limits the sum. Compiled."""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_with_aliasing, native
from yehu_server.compile.memory import carray
from yehu_server.core.controls.record import CHUNK
from yehu_server.core.controls.slots import (
    DAMPING_NOW,
    DECAY_NOW,
    DISTANCE_NOW,
    LEVEL_NOW,
    PAN_NOW,
    SIZE_NOW,
    WIDTH_NOW,
)
from yehu_server.core.engine.atomics import at, record_at
from yehu_server.core.engine.limiter import is_valid, limit
from yehu_server.core.engine.output import SOUNDED, SOUNDED_BYTES
from yehu_server.core.engine.processor import flush_denormals, restore_denormals
from yehu_server.core.engine.rig import METERS_AT, RIG_BYTES, SEAT_AT, count_parts
from yehu_server.core.engine.telemetry import METERS, TELEMETRY_S
from yehu_server.core.stage import late_field, seat
from yehu_server.core.stage.directivity import side_signal
from yehu_server.core.stage.late_field import CHECK_FRAMES, is_settled, reverberate, set_room
from yehu_server.core.stage.record import BUSES, DIRECT, EARLY, SEND, STAGE, TAPE, TAPE_AT
from yehu_server.core.stage.room_geometry import EARS, REFERENCE_DISTANCE_M
from yehu_server.core.stage.seat import (
    LEFT,
    RIGHT,
    SEAT,
    mute_after_fade_out,
    reflect,
    set_direct,
    set_reflections,
    update_silence,
)
from yehu_server.params.table import find

Array = Any

# Without a room, whose sound adds to the direct one, the instrument is itself where players sit.
DRY_DISTANCE_M = find("/room/distance").default


@native
def mix(
    rigs: Any,
    sounded: Any,
    apart: int,
    first: int,
    frames: int,
    out: Any,
    stems: Any,
    has_stems: int,
) -> None:
    """Mix what all instruments sounded, at most CHUNK frames.

    Parameters
    ----------
    rigs : pointer to records of dtype RIG, and one of dtype STAGE after them
    sounded : pointer to the record of dtype SOUNDED of the first instrument
    apart : int
        Bytes from there to that of the next.
    first : int
        Number of the first frame.
    out : pointer to float32 [shape=(frames, channels)]
        Written, in full scale: left and right in turn; a single channel has the mean of both.
    stems : pointer to float64 [shape=(frames, parts + 1, EARS)]
        Written if `has_stems`: what each instrument, and at last the room, gives to the mix.

    Real time: safe; no allocation, no exception, every sample finite.
    """
    parts = count_parts(rigs)
    stage = record_at(rigs, parts * RIG_BYTES, STAGE)
    stage.silenced_at = frames
    for n in range(frames):
        for bus in range(BUSES):
            stage.bus[n, bus] = 0.0
    for part in range(parts):
        take_up(rigs, sounded, apart, part, first, frames)
        for n in range(frames):
            left, right = stage.own[n, LEFT], stage.own[n, RIGHT]
            stage.bus[n, DIRECT + LEFT] += left
            stage.bus[n, DIRECT + RIGHT] += right
            if has_stems != 0:
                own = carray(stems, (frames, parts + 1, EARS), np.float64)
                own[n, part, LEFT], own[n, part, RIGHT] = left, right
    inputs = carray(sounded, (1,), SOUNDED)[0]
    add_room(stage, inputs.stage_inputs, first, frames)
    for n in range(frames):
        left, right = finish(rigs, stage, inputs.soft[n], first + n, n, out)
        if has_stems != 0:
            own = carray(stems, (frames, parts + 1, EARS), np.float64)
            own[n, parts, LEFT] = stage.own[n, LEFT]
            own[n, parts, RIGHT] = stage.own[n, RIGHT]
            for part in range(parts + 1):
                own[n, part, LEFT] *= left
                own[n, part, RIGHT] *= right


@compiled_with_aliasing
def take_up(rigs: Any, sounded: Any, apart: int, part: int, first: int, frames: int) -> None:
    """Place what one instrument sounded: its direct sound (``own``), and what goes to the room."""
    parts = count_parts(rigs)
    stage = record_at(rigs, parts * RIG_BYTES, STAGE)
    shared = carray(sounded, (1,), SOUNDED)[0]
    o = record_at(sounded, part * apart, SOUNDED)
    s = record_at(rigs, part * RIG_BYTES + SEAT_AT, SEAT)
    full_at = REFERENCE_DISTANCE_M if stage.has_room != 0 else DRY_DISTANCE_M
    for n in range(frames):
        own, room_inputs = o.stage_inputs[n], shared.stage_inputs[n]
        is_time = (first + n) % CHECK_FRAMES == 0
        if is_time or math.isnan(s.direct[LEFT]):  # or has begun anew, wherever the block begins
            set_direct(s, own[DISTANCE_NOW], own[PAN_NOW], full_at, CHECK_FRAMES)
        if is_time and stage.has_room != 0:
            set_reflections(
                s,
                room_inputs[SIZE_NOW],
                room_inputs[DECAY_NOW],
                room_inputs[DAMPING_NOW],
                own[DISTANCE_NOW],
                own[PAN_NOW],
            )
        x = o.dry[n]
        if update_silence(s, x):
            stage.own[n, LEFT], stage.own[n, RIGHT] = 0.0, 0.0
        else:
            side = 0.0
            if stage.has_room != 0:
                side = own[WIDTH_NOW] * side_signal(s.sides, x)
                reflect(s, first + n, x if room_inputs[LEVEL_NOW] > 0.0 else 0.0)
                stage.bus[n, EARLY + LEFT] += s.early[LEFT]
                stage.bus[n, EARLY + RIGHT] += s.early[RIGHT]
            stage.bus[n, SEND + LEFT] += s.send[LEFT] * x
            stage.bus[n, SEND + RIGHT] += s.send[RIGHT] * x
            stage.own[n, LEFT] = s.direct[LEFT] * (x + side)
            stage.own[n, RIGHT] = s.direct[RIGHT] * (x - side)
        s.direct[LEFT] += s.direct_step[LEFT]
        s.direct[RIGHT] += s.direct_step[RIGHT]
        if n == o.silenced_at:
            mute_after_fade_out(s)
            stage.silenced_at = min(stage.silenced_at, n)


@compiled_with_aliasing
def add_room(stage: Any, inputs: Any, first: int, frames: int) -> None:
    """Compute what the room gives to the mix (``own``)."""
    if stage.has_room == 0:
        for n in range(frames):
            stage.own[n, LEFT], stage.own[n, RIGHT] = 0.0, 0.0
        return
    r, begin = stage.room, 0
    while begin < frames:
        if (first + begin) % CHECK_FRAMES == 0:
            row = inputs[begin]
            set_room(r, row[SIZE_NOW], row[DECAY_NOW], row[DAMPING_NOW])
        end = steady_until(r, inputs, first, begin, frames)
        if begin <= stage.silenced_at < end:
            end = stage.silenced_at + 1
        sound = stage.bus[begin:end, SEND : SEND + EARS]
        reverberate(r, first + begin, inputs[begin:end, LEVEL_NOW], sound, stage.own[begin:end])
        for n in range(begin, end):
            early = inputs[n, LEVEL_NOW] * r.opened[n - begin]
            stage.own[n, LEFT] += early * stage.bus[n, EARLY + LEFT]
            stage.own[n, RIGHT] += early * stage.bus[n, EARLY + RIGHT]
        if end - 1 == stage.silenced_at:
            r.closing = 1
        begin = end


@compiled_with_aliasing
def steady_until(r: Any, inputs: Any, first: int, begin: int, frames: int) -> int:
    """The row before which the room can be computed at once, from a row on: it stays as it is."""
    for n in range(begin + 1, frames):
        row = inputs[n]
        if (first + n) % CHECK_FRAMES == 0 and not is_settled(
            r, row[SIZE_NOW], row[DECAY_NOW], row[DAMPING_NOW]
        ):
            return n
        if inputs[n - 1, LEVEL_NOW] == 0.0 and r.closing == 0:  # the room closes
            return n
    return frames


@compiled_with_aliasing
def finish(rigs: Any, stage: Any, soft: float, frame: int, n: int, out: Any) -> tuple[float, float]:
    """Limit row `n` of the mix, and put it into the block and onto the tape.

    Returns the factors by which the limiter made both sides smaller.
    """
    left = stage.bus[n, DIRECT + LEFT] + stage.own[n, LEFT]
    right = stage.bus[n, DIRECT + RIGHT] + stage.own[n, RIGHT]
    limited_left, limited_right = limit(left, soft), limit(right, soft)
    if not (is_valid(left, limited_left) and is_valid(right, limited_right)):
        limited_left, limited_right = 0.0, 0.0
        stage.invalid_samples += 1
        reset_state(rigs, stage)
    mean: Any = np.float32(0.5 * (limited_left + limited_right))
    both: Any = (np.float32(limited_left), np.float32(limited_right))
    if stage.taping != 0:
        tape = carray(at_tape(rigs), (TAPE, EARS), np.float32)
        tape[frame & (TAPE - 1), LEFT], tape[frame & (TAPE - 1), RIGHT] = both
    channels = stage.channels
    samples = carray(out, ((n + 1) * channels,), np.float32)
    for channel in range(channels):
        sample = mean if channels == 1 else both[channel % EARS]
        samples[n * channels + channel] = sample
    add_to_level(rigs, stage, both[LEFT], both[RIGHT])
    return (
        limited_left / left if left != 0.0 else 1.0,
        limited_right / right if right != 0.0 else 1.0,
    )


@compiled_with_aliasing
def reset_state(rigs: Any, stage: Any) -> None:
    """Begin with an empty stage, after numbers were lost."""
    late_field.reset_state(stage.room)
    for part in range(count_parts(rigs)):
        seat.reset_state(record_at(rigs, part * RIG_BYTES + SEAT_AT, SEAT))


@compiled_with_aliasing
def add_to_level(rigs: Any, stage: Any, left: float, right: float) -> None:
    """Add a frame to the level of the mix in this window."""
    stage.window_peak = max(stage.window_peak, abs(left), abs(right))
    stage.window_power += 0.5 * (left * left + right * right)
    stage.window_frames += 1
    if stage.window_frames >= TELEMETRY_S * record_at(rigs, METERS_AT, METERS).rate:
        stage.peak = stage.window_peak
        stage.rms = math.sqrt(stage.window_power / stage.window_frames)
        stage.window_peak, stage.window_power, stage.window_frames = 0.0, 0.0, 0


@compiled_with_aliasing
def at_tape(rigs: Any) -> Any:
    """Address of the tape."""
    parts = count_parts(rigs)
    return at(rigs, parts * RIG_BYTES + TAPE_AT)


@native
def mix_block(
    rigs: Any, sounded: Any, first: int, frames: int, out: Any, stems: Any, has_stems: int
) -> None:
    """Mix what ``sounding.sound_block`` computed: SOUNDED [shape=(parts, chunks)]; see `mix`.

    It touches nothing that ``sound_block`` does, so the next block may be computed meanwhile.
    """
    mode = flush_denormals()
    parts = count_parts(rigs)
    channels = record_at(rigs, parts * RIG_BYTES, STAGE).channels
    apart = (frames + CHUNK - 1) // CHUNK * SOUNDED_BYTES
    done = 0
    while done < frames:
        count = min(frames - done, CHUNK)
        here = at(out, done * channels * 4)
        stems_here = at(stems, done * (parts + 1) * EARS * 8)
        chunk = at(sounded, done // CHUNK * SOUNDED_BYTES)
        mix(rigs, chunk, apart, first + done, count, here, stems_here, has_stems)
        done += count
    restore_denormals(mode)
