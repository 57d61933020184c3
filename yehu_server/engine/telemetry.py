"""What the audio side tells of itself, published without locks. Compiled.

The audio side keeps one METERS record for itself and copies it out after each block, under a
version number that is odd while it writes (a seqlock): a reader who sees the version change
reads again. Nobody waits for a reader.

A delay-locked loop gives each block's first frame a time without the jitter of the callback's
start: what comes in is stamped against that, so that it keeps its rhythm.
Source: [Adriaensen], the loop's equations.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.layout import STRINGS

Array = Any

SHAPE_POINTS = 64
WINDOW_S = 1.0 / 60.0
LOAD_BINS = 128  # of a sixty-fourth of the deadline each
BINS_PER_DEADLINE = 64
LOOP_HZ = 0.3  # bandwidth of the delay-locked loop
ASTRAY_NS = 50_000_000  # so far off, the loop starts anew at once;
ASTRAY_S = 0.1  # after so long, where it is off by more than LATE_BLOCKS
LATE_BLOCKS = 2
LOAD_MEMORY_S = 1.0
UNDERRUN = 4  # paOutputUnderflow

METERS = np.dtype(
    [
        ("rate", np.float64),  # Hz
        ("running", np.int64),  # 1 while inside the callback
        # Time: the block's first frame, when it was due, ns from frame to frame.
        ("frame", np.int64),
        ("due_ns", np.int64),
        ("ns_per_frame", np.float64),
        ("block", np.int64),  # frames of the last callback
        ("error_ns", np.int64),  # how late the last callback began
        ("astray", np.int64),  # callbacks in a row that were far from due
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
    """Follow the callback's starts with the delay-locked loop."""
    due = t.due_ns + int(t.block * t.ns_per_frame)
    error = started_ns - due
    late = LATE_BLOCKS * t.block * 1e9 / t.rate
    if t.callbacks > 0 and error - t.error_ns > late:
        t.late_callbacks += 1
    t.astray = t.astray + 1 if abs(error) > late else 0
    is_lost = abs(error) > ASTRAY_NS or t.astray * t.block > ASTRAY_S * t.rate
    if t.callbacks == 0 or is_lost:
        t.due_ns, t.error_ns, t.astray = started_ns, 0, 0
        t.ns_per_frame = 1e9 / t.rate
    else:
        turn = 2.0 * math.pi * LOOP_HZ * t.block / t.rate
        t.due_ns, t.error_ns = due + int(math.sqrt(2.0) * turn * error), error
        t.ns_per_frame += turn * turn * error / max(t.block, 1)
    t.frame = frame
    t.block = frames
    t.callbacks += 1


@compiled
def account(t: Any, cpu_ns: int, flags: int) -> None:
    """Book the CPU time of a callback against its deadline."""
    seconds = t.block / t.rate
    load = 1e-9 * cpu_ns / seconds
    t.load += (load - t.load) * min(1.0, seconds / LOAD_MEMORY_S)
    t.worst_load = max(t.worst_load, load)
    t.missed += 1 if load > 1.0 else 0
    t.loads[min(int(load * BINS_PER_DEADLINE), LOAD_BINS - 1)] += 1
    t.underruns += 1 if flags & UNDERRUN else 0
