"""Where one player sits: the direct sound at both ears, and the first reflections. Compiled."""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.stage import absorption, room_geometry
from yehu_server.core.stage.directivity import SIDES, clear_sides, prepare_sides, reset_sides
from yehu_server.core.stage.late_field import CLOSE_S
from yehu_server.core.stage.room_geometry import EARS, WALLS

HISTORY_FRAMES = 1 << 16  # frames of sound that are kept for reflections
CROSSFADE_S = 0.03  # from the previous reflections to the new ones
LEFT, RIGHT = 0, 1

SEAT = np.dtype(
    [
        ("rate", np.float64),  # Hz
        ("sides", SIDES),
        # Amplitudes of the direct sound, and of what enters the room; their change in a frame.
        ("direct", np.float64, EARS),
        ("direct_step", np.float64, EARS),
        ("send", np.float64, EARS),
        # The reflections: the new ones, and the previous ones, which fade out.
        ("distance", np.float64),
        ("pan", np.float64),
        ("size", np.float64),
        ("decay", np.float64),
        ("damping", np.float64),
        ("now", np.int64),
        ("crossfade", np.float64),  # from the previous ones (0) to the new ones (1)
        ("crossfade_step", np.float64),
        ("delay", np.int64, (2, EARS, WALLS)),  # frames
        ("gain", np.float64, (2, EARS, WALLS)),
        ("seconds", np.float64, (EARS, WALLS)),
        # Frames for which nothing that was kept is reflected; below 0, frames until then, in which
        # the room closes.
        ("mute", np.int64),
        ("b_0", np.float64, 1),  # what a wall takes
        ("b_1", np.float64, 1),
        ("a_1", np.float64, 1),
        ("x_1", np.float64),
        ("y_1", np.float64),
        ("early", np.float64, EARS),  # what is reflected
        ("silent", np.int64),  # frames since there was sound
        ("history", np.float64, HISTORY_FRAMES),
    ],
    align=True,
)


def prepare_seat(seat: Any, rate: float, body: int = 0) -> None:
    """Prepare a SEAT record in place, at a rate (Hz), for one of many bodies (``directivity``)."""
    seat["rate"] = rate
    seat["crossfade_step"] = 1.0 / (CROSSFADE_S * rate)
    prepare_sides(seat["sides"], rate, body)
    seat["direct"], seat["send"], seat["size"] = np.nan, 1.0, 0.0
    seat["crossfade"] = 1.0
    clear_seat(seat)


def clear_seat(seat: Any) -> None:
    """Take all sound out of a record of dtype SEAT, in place."""
    clear_sides(seat["sides"])
    for name in ("x_1", "y_1", "early", "history"):
        seat[name] = 0.0
    seat["mute"], seat["silent"] = 0, 0


@compiled_exactly
def pan_to(ear: int, pan: float) -> float:
    """Amplitude at an ear: 1 in the middle, and of equal power in all."""
    return math.sqrt(1.0 + (2.0 * ear - 1.0) * pan)


@compiled_exactly
def set_direct(s: Any, distance: float, pan: float, full_at: float, frames: int) -> None:
    """Move the direct sound to a distance (m) and direction within some frames, from now.

    At the distance `full_at` (m) it is as loud as the instrument.
    """
    for ear in range(EARS):
        requested = pan_to(ear, pan) * full_at / distance
        s.send[ear] = pan_to(ear, pan)
        if math.isnan(s.direct[ear]):
            s.direct[ear] = requested
        s.direct_step[ear] = (requested - s.direct[ear]) / frames


@compiled_exactly
def set_reflections(
    s: Any, size: float, decay: float, damping: float, distance: float, pan: float
) -> None:
    """Move the reflections to where they are in a room of a size (m) and decay (s).

    The previous reflections fade out while the new ones fade in. Real time: safe.
    """
    if s.crossfade < 1.0:
        return
    if (
        size == s.size
        and decay == s.decay
        and damping == s.damping
        and distance == s.distance
        and pan == s.pan
    ):
        return
    s.crossfade = 1.0 if s.size == 0.0 else 0.0
    s.size, s.decay, s.damping, s.distance, s.pan = size, decay, damping, distance, pan
    s.now = 1 - s.now
    room_geometry.find_images(size, distance, pan, decay, s.seconds, s.gain[s.now])
    for ear in range(EARS):
        for wall in range(WALLS):
            frames = int(math.floor(s.seconds[ear, wall] * s.rate + 0.5))  # noqa: RUF046 - a float, compiled
            s.delay[s.now, ear, wall] = min(frames, HISTORY_FRAMES - 1)
    path_s = room_geometry.mean_free_path(size) / room_geometry.SPEED_OF_SOUND
    absorption.set_shelf(s, 0, path_s, decay, damping)
    low = s.b_0[0] + s.b_1[0]  # already in the gains, so the shelf has unity gain there
    low /= 1.0 + s.a_1[0]
    s.b_0[0] /= low
    s.b_1[0] /= low


@compiled_exactly
def update_silence(s: Any, x: float) -> bool:
    """Count silent samples; return whether nothing of this one or of earlier ones is left.

    After HISTORY_FRAMES zeros filters and history are empty. Real time: safe.
    """
    s.silent = s.silent + 1 if x == 0.0 else 0
    return bool(s.silent > HISTORY_FRAMES and s.mute == 0 and s.crossfade >= 1.0)


@compiled_exactly
def reflect(s: Any, frame: int, x: float) -> None:
    """Keep a sample; compute what both ears hear of earlier ones (``early``). Real time: safe."""
    if s.mute < 0:
        s.mute += 1
        if s.mute == 0:
            mute(s)
    y = s.b_0[0] * x + s.b_1[0] * s.x_1 - s.a_1[0] * s.y_1
    s.x_1, s.y_1 = x, y
    s.history[frame & (HISTORY_FRAMES - 1)] = y
    if s.mute > 0:
        s.mute -= 1
        s.early[LEFT], s.early[RIGHT] = 0.0, 0.0
        return
    add_reflections(s, frame, s.now, min(1.0, s.crossfade), 0.0)
    if s.crossfade < 1.0:
        add_reflections(s, frame, 1 - s.now, 1.0 - s.crossfade, 1.0)
        s.crossfade += s.crossfade_step


@compiled_exactly
def add_reflections(s: Any, frame: int, which: int, amplitude: float, add: float) -> None:
    """Compute one of the two sets of reflections; add it to ``early``, or replace that (0)."""
    for ear in range(EARS):
        output = 0.0
        for wall in range(WALLS):
            sample = s.history[(frame - s.delay[which, ear, wall]) & (HISTORY_FRAMES - 1)]
            output += s.gain[which, ear, wall] * sample
        s.early[ear] = add * s.early[ear] + amplitude * output


@compiled_exactly
def mute_after_fade_out(s: Any) -> None:
    """Mute the reflections once they have faded out. Real time: safe."""
    s.mute = -int(CLOSE_S * s.rate) - 2


@compiled_exactly
def mute(s: Any) -> None:
    """Reflect nothing of the history."""
    longest = 0
    for which in range(2):
        for ear in range(EARS):
            for wall in range(WALLS):
                longest = max(longest, s.delay[which, ear, wall])
    s.mute = longest
    s.x_1, s.y_1 = 0.0, 0.0


@compiled_exactly
def reset_state(s: Any) -> None:
    """Reset the seat to its start state after an invalid sample. Real time: safe."""
    s.mute, s.silent = HISTORY_FRAMES, 0
    s.x_1, s.y_1, s.size, s.crossfade = 0.0, 0.0, 0.0, 1.0
    for ear in range(EARS):
        s.early[ear], s.direct[ear] = 0.0, math.nan
    reset_sides(s.sides)
