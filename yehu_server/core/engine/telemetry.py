"""Meters of the audio side: time of frames, load, levels, counts. Compiled.

The audio side keeps a METERS record of its own and publishes a copy after each block, by a
seqlock: the version is odd while it is written, and a reader that finds the version changed reads
again. The audio side never waits.

A delay-locked loop gives each block's first frame a time without the jitter of the callback's
start; messages are stamped by it, so that they keep their rhythm. A device with a period longer
than a block calls back several times in a row. The loop follows the first callback of such a
request; how far the others run ahead of their time is the delay that messages need.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.controls.ramps import one_pole
from yehu_server.core.engine.delay_locked_loop import LOOP, follow, predicted_ns, start
from yehu_server.core.physics.layout import STRINGS

Array = Any

SHAPE_POINTS = 64
# From one value to the next of what is only shown: levels, shapes of strings, snapshots for pages.
TELEMETRY_S = 1.0 / 60.0
LOAD_BINS = 128  # of a sixty-fourth of the deadline each
BINS_PER_DEADLINE = 64
ASTRAY_NS = 50_000_000  # an error this large starts the loop anew at once,
ASTRAY_S = 0.1  # and one above LATE_BLOCKS after this time
LATE_BLOCKS = 2  # in blocks of the device
# A callback within this share of a block after the last one, and early by as much, belongs to the
# same request.
IN_A_ROW = 0.125
LONGEST_PERIOD_S = 0.5
AHEAD_WINDOW_S = 0.1
LOAD_MEMORY_S = 1.0
UNDERRUN = 4  # paOutputUnderflow

METERS = np.dtype(
    [
        ("rate", np.float64),  # Hz
        ("running", np.int64),  # 1 while inside the callback
        ("frame", np.int64),  # the block's first
        ("loop", LOOP),  # its time, and the error of the request
        ("block", np.int64),  # frames of the last callback
        ("ended_ns", np.int64),  # time at which the last callback returned
        # Requests of the device: a callback, or several in a row.
        ("requested_from", np.int64),  # first frame of the last request
        ("astray", np.int64),  # frames of successive requests with a large error
        ("ahead_window", np.int64),  # its number
        ("ahead_from", np.int64),  # first frame of this window
        ("ahead_now", np.float64),  # as `ahead`, of this window
        ("longest_now", np.int64),
        ("ahead", np.float64),  # most frames computed before their time in the last window
        ("longest", np.int64),  # frames of the longest request in the last window
        # The callback.
        ("callbacks", np.int64),
        ("late_callbacks", np.int64),  # that began LATE_BLOCKS or more after their time
        ("missed", np.int64),  # that took more CPU time than the block lasts
        ("underruns", np.int64),  # reported by the device
        ("load", np.float64),  # CPU time over the deadline, mean of a second
        ("worst_load", np.float64),
        ("loads", np.int64, LOAD_BINS),
        # Level, over windows of a sixtieth of a second.
        ("window", np.int64),  # its number
        ("window_frames", np.int64),
        ("window_peak", np.float64),
        ("window_power", np.float64),
        ("peak", np.float64),  # of the last full window
        ("rms", np.float64),
        ("shapes", np.float32, (STRINGS, SHAPE_POINTS)),  # m; displacement, end to end
        ("unconverged", np.int64),
        ("lost", np.int64),
        ("slept", np.int64),  # number of frames that were not computed, as nothing sounded
        # The mailbox.
        ("late_events", np.int64),
        ("applied", np.int64),
        ("drained", np.int64),  # number of commands taken from the ring, and
        ("pitch", np.float64),  # that sounds (fractional MIDI note); NaN in silence
        ("next_frame", np.int64),  # the frame up to which those that are due were applied
        ("waiting", np.int64),
        ("unreported", np.int64),
    ],
    align=True,
)


@compiled
def add_to_level(t: Any, sample: float) -> None:
    """Add a sample to the level of this window. Real time: safe."""
    t.window_peak = max(t.window_peak, abs(sample))
    t.window_power += sample * sample
    t.window_frames += 1


@compiled
def close_window(t: Any, m: Any, s: Any) -> None:
    """Take level and string shapes at the end of a window. Real time: safe."""
    if t.window_frames < TELEMETRY_S * t.rate:
        return
    t.peak, t.rms = t.window_peak, math.sqrt(t.window_power / t.window_frames)
    t.window_peak, t.window_power, t.window_frames = 0.0, 0.0, 0
    t.window += 1
    for i in range(STRINGS):
        for point in range(SHAPE_POINTS):
            t.shapes[i, point] = displacement(s, i, point * m.N[i] / (SHAPE_POINTS - 1))


@compiled
def displacement(s: Any, i: int, place: float) -> float:
    """Displacement (m) of string `i` at a place, in nodes from its end at the loop."""
    node = int(place)
    u = s.u[s.level, i]
    return float(u[1 + node] + (place - node) * (u[2 + node] - u[1 + node]))


@compiled
def update_clock(t: Any, frame: int, started_ns: int, frames: int) -> None:
    """Update the time of frames at the start (ns) of a callback. Real time: safe."""
    due = predicted_ns(t.loop, t.block)
    error = started_ns - due
    close_ns = IN_A_ROW * t.block * 1e9 / t.rate
    if t.callbacks > 0 and started_ns - t.ended_ns < close_ns and error < -close_ns:
        # Of the same request, unless the error is so large that the loop's time must be wrong.
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
    # As if requests took no time, so that the measure does not depend on computing time.
    late = t.loop.error_ns / t.loop.ns_per_frame
    t.ahead_now = max(t.ahead_now, frame + frames - t.requested_from - late)


@compiled
def begin_request(t: Any, frame: int, due: int, error: int) -> bool:
    """Update the loop at a new request; return whether its error is too large to go on."""
    requested = min(frame - t.requested_from, int(LONGEST_PERIOD_S * t.rate))
    t.requested_from = frame
    t.longest_now = max(t.longest_now, requested)
    if frame - t.ahead_from >= AHEAD_WINDOW_S * t.rate:
        t.ahead, t.longest = t.ahead_now, t.longest_now
        t.ahead_now, t.longest_now = 0.0, 0
        t.ahead_from = frame
        t.ahead_window += 1
    late = LATE_BLOCKS * requested * 1e9 / t.rate
    if t.callbacks > 0 and error - t.loop.error_ns > late:
        t.late_callbacks += 1
    follow(t.loop, due, error, requested, t.rate)
    t.astray = t.astray + requested if abs(error) > late else 0
    # A device may be late for a moment, but never early.
    return bool(abs(error) > ASTRAY_NS or -error > late or t.astray > ASTRAY_S * t.rate)


@compiled
def account(t: Any, cpu_ns: int, flags: int) -> None:
    """Count the CPU time of a callback, and under-runs by PortAudio's flags. Real time: safe."""
    seconds = t.block / t.rate
    load = 1e-9 * cpu_ns / seconds
    t.load = one_pole(t.load, load, min(1.0, seconds / LOAD_MEMORY_S))
    t.worst_load = max(t.worst_load, load)
    t.missed += 1 if load > 1.0 else 0
    t.loads[min(int(load * BINS_PER_DEADLINE), LOAD_BINS - 1)] += 1
    t.underruns += 1 if flags & UNDERRUN else 0
