"""What the audio side tells of itself, published without locks. Compiled.

The audio side keeps one METERS record for itself and copies it out after each block, under a
version number that is odd while it writes (a seqlock): a reader who sees the version change
reads again. Nobody waits for a reader.

A delay-locked loop gives each block's first frame a time without the jitter of the callback's
start: what comes in is stamped against that, so that it keeps its rhythm. A device whose own
period is longer than a block calls back several times in a row: the loop follows the first of
them, and how far the others run ahead of that time is what a message has to wait for.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.engine.delay_locked_loop import LOOP, follow, predicted_ns, start
from yehu_server.engine.one_pole import one_pole
from yehu_server.jit import compiled
from yehu_server.physics.layout import STRINGS

Array = Any

SHAPE_POINTS = 64
WINDOW_S = 1.0 / 60.0
LOAD_BINS = 128  # of a sixty-fourth of the deadline each
BINS_PER_DEADLINE = 64
ASTRAY_NS = 50_000_000  # so far off, the loop starts anew at once;
ASTRAY_S = 0.1  # after so long, where it is off by more than LATE_BLOCKS
LATE_BLOCKS = 2  # of the device's own
IN_A_ROW = 0.125  # of a block: callbacks closer than this, and as much too early, are one request
LONGEST_PERIOD_S = 0.5
AHEAD_WINDOW_S = 0.1
LOAD_MEMORY_S = 1.0
UNDERRUN = 4  # paOutputUnderflow

METERS = np.dtype(
    [
        ("rate", np.float64),  # Hz
        ("running", np.int64),  # 1 while inside the callback
        ("frame", np.int64),  # the block's first
        ("loop", LOOP),  # when it was due, and how late the request began
        ("block", np.int64),  # frames of the last callback
        ("ended_ns", np.int64),  # when the last callback returned
        # Requests of the device: a callback, or several in a row.
        ("asked_from", np.int64),  # first frame of the last request
        ("astray", np.int64),  # frames of requests in a row that were far from due
        ("ahead_window", np.int64),  # a running number
        ("ahead_from", np.int64),  # first frame of this window
        ("ahead_now", np.float64),  # in this window
        ("longest_now", np.int64),
        ("ahead", np.float64),  # frames played before their time, at most; of the last window
        ("longest", np.int64),  # frames of the longest request; of the last window
        # How the callback fares.
        ("callbacks", np.int64),
        ("late_callbacks", np.int64),  # begun LATE_BLOCKS or more after they were due
        ("missed", np.int64),  # took more CPU time than the block lasts
        ("underruns", np.int64),  # as the device reports them
        ("load", np.float64),  # CPU time over the deadline, mean of a second
        ("worst_load", np.float64),
        ("loads", np.int64, LOAD_BINS),
        # What is heard, over windows of a sixtieth of a second.
        ("window", np.int64),  # a running number
        ("window_frames", np.int64),
        ("window_peak", np.float64),
        ("window_power", np.float64),
        ("peak", np.float64),  # of the last whole window
        ("rms", np.float64),
        ("shapes", np.float32, (STRINGS, SHAPE_POINTS)),  # m; displacement, end to end
        ("unconverged", np.int64),
        ("lost", np.int64),
        # The mailbox.
        ("late_events", np.int64),
        ("applied", np.int64),
        ("waiting", np.int64),
        ("unreported", np.int64),
    ],
    align=True,
)


@compiled
def hear(t: Any, sample: float) -> None:
    """Add one sample to the level of this window."""
    t.window_peak = max(t.window_peak, abs(sample))
    t.window_power += sample * sample
    t.window_frames += 1


@compiled
def close_window(t: Any, m: Any, s: Any) -> None:
    """Publish level and string shapes where a window is full."""
    if t.window_frames < WINDOW_S * t.rate:
        return
    t.peak, t.rms = t.window_peak, math.sqrt(t.window_power / t.window_frames)
    t.window_peak, t.window_power, t.window_frames = 0.0, 0.0, 0
    t.window += 1
    for i in range(STRINGS):
        for point in range(SHAPE_POINTS):
            node = 1 + (point * m.N[i] + (SHAPE_POINTS - 1) // 2) // (SHAPE_POINTS - 1)
            t.shapes[i, point] = s.u[s.level, i, node]


@compiled
def tell_time(t: Any, frame: int, started_ns: int, frames: int) -> None:
    """Follow the starts of the device's requests with the delay-locked loop."""
    due = predicted_ns(t.loop, t.block)
    error = started_ns - due
    close_ns = IN_A_ROW * t.block * 1e9 / t.rate
    if t.callbacks > 0 and started_ns - t.ended_ns < close_ns and error < -close_ns:
        # Of the same request; unless we only catch up, and time is not where we thought.
        is_lost = -error > max(ASTRAY_NS, LATE_BLOCKS * t.longest * 1e9 / t.rate)
        t.loop.due_ns = due
    else:
        is_lost = begin_request(t, frame, due, error)
    if t.callbacks == 0 or is_lost:
        start(t.loop, started_ns, t.rate)
        t.astray = 0
    t.frame = frame
    t.block = frames
    t.callbacks += 1
    # As if a request took no time, so that it does not hang on how long we compute.
    late = t.loop.error_ns / t.loop.ns_per_frame
    t.ahead_now = max(t.ahead_now, frame + frames - t.asked_from - late)


@compiled
def begin_request(t: Any, frame: int, due: int, error: int) -> bool:
    """Take one step of the loop; return whether it is far off and has to start anew."""
    asked = min(frame - t.asked_from, int(LONGEST_PERIOD_S * t.rate))
    t.asked_from = frame
    t.longest_now = max(t.longest_now, asked)
    if frame - t.ahead_from >= AHEAD_WINDOW_S * t.rate:
        t.ahead, t.longest = t.ahead_now, t.longest_now
        t.ahead_now, t.longest_now = 0.0, 0
        t.ahead_from = frame
        t.ahead_window += 1
    late = LATE_BLOCKS * asked * 1e9 / t.rate
    if t.callbacks > 0 and error - t.loop.error_ns > late:
        t.late_callbacks += 1
    follow(t.loop, due, error, asked, t.rate)
    t.astray = t.astray + asked if abs(error) > late else 0
    # A device is late for a moment, but never early.
    return bool(abs(error) > ASTRAY_NS or -error > late or t.astray > ASTRAY_S * t.rate)


@compiled
def account(t: Any, cpu_ns: int, flags: int) -> None:
    """Book the CPU time of a callback against its deadline."""
    seconds = t.block / t.rate
    load = 1e-9 * cpu_ns / seconds
    t.load = one_pole(t.load, load, min(1.0, seconds / LOAD_MEMORY_S))
    t.worst_load = max(t.worst_load, load)
    t.missed += 1 if load > 1.0 else 0
    t.loads[min(int(load * BINS_PER_DEADLINE), LOAD_BINS - 1)] += 1
    t.underruns += 1 if flags & UNDERRUN else 0
