"""Where one player sits: the direct sound at both ears, and the first reflections. Compiled."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.stage import absorption, image_sources
from yehu_server.core.stage.directivity import SIDES, clear_sides, prepare_sides, rest_sides
from yehu_server.core.stage.image_sources import EARS, REFERENCE, WALLS
from yehu_server.core.stage.late_field import CLOSE_S

SPAN = 1 << 16  # frames of sound that are kept for reflections
MOVE_S = 0.03  # in which reflections move to where they belong now
LEFT, RIGHT = 0, 1

SEAT = np.dtype(
    [
        ("rate", np.float64),  # Hz
        ("sides", SIDES),
        # Amplitudes of the direct sound, and of what enters the room; their change in a frame.
        ("direct", np.float64, EARS),
        ("direct_step", np.float64, EARS),
        ("send", np.float64, EARS),
        # The reflections: those heard now, and those that were, which fade.
        ("distance", np.float64),
        ("pan", np.float64),
        ("size", np.float64),
        ("decay", np.float64),
        ("damping", np.float64),
        ("now", np.int64),
        ("moved", np.float64),  # from those that were (0) to those of now (1)
        ("move_step", np.float64),
        ("delay", np.int64, (2, EARS, WALLS)),  # frames
        ("gain", np.float64, (2, EARS, WALLS)),
        ("seconds", np.float64, (EARS, WALLS)),
        # Frames for which nothing that was kept is reflected; below 0, frames until then, in which
        # the room closes.
        ("mute", np.int64),
        ("b_0", np.float64, 1),  # what a wall takes
        ("b_1", np.float64, 1),
        ("a_1", np.float64, 1),
        ("before", np.float64),
        ("filtered", np.float64),
        ("early", np.float64, EARS),  # what is reflected
        ("silent", np.int64),  # frames since there was sound
        ("kept", np.float64, SPAN),
    ],
    align=True,
)


def prepare_seat(seat: Any, rate: float, body: int = 0) -> None:
    """Prepare a record of dtype SEAT [shape=()] for a rate (Hz), in place.

    Parameters
    ----------
    body : int
        Which of many bodies sounds there: see ``directivity``.
    """
    seat["rate"] = rate
    seat["move_step"] = 1.0 / (MOVE_S * rate)
    prepare_sides(seat["sides"], rate, body)
    seat["direct"], seat["send"], seat["size"] = np.nan, 1.0, 0.0
    seat["moved"] = 1.0
    rest_seat(seat)


def rest_seat(seat: Any) -> None:
    """Take all sound out of a record of dtype SEAT, in place."""
    rest_sides(seat["sides"])
    for name in ("before", "filtered", "early", "kept"):
        seat[name] = 0.0
    seat["mute"], seat["silent"] = 0, 0


@compiled_exactly
def pan_to(ear: int, pan: float) -> float:
    """Amplitude at an ear: 1 in the middle, and of equal power in all."""
    return math.sqrt(1.0 + (2.0 * ear - 1.0) * pan)


@compiled_exactly
def set_direct(s: Any, distance: float, pan: float, frames: int) -> None:
    """Move the direct sound to a distance (m) and direction within some frames, from now."""
    for ear in range(EARS):
        requested = pan_to(ear, pan) * REFERENCE / distance
        s.send[ear] = pan_to(ear, pan)
        if math.isnan(s.direct[ear]):
            s.direct[ear] = requested
        s.direct_step[ear] = (requested - s.direct[ear]) / frames


@compiled_exactly
def set_reflections(
    s: Any, size: float, decay: float, damping: float, distance: float, pan: float
) -> None:
    """Move the reflections to where they are in a room of a size (m) and decay (s).

    Those that were fade while those of now come. Real time: safe.
    """
    if s.moved < 1.0:
        return
    if (
        size == s.size
        and decay == s.decay
        and damping == s.damping
        and distance == s.distance
        and pan == s.pan
    ):
        return
    s.moved = 1.0 if s.size == 0.0 else 0.0
    s.size, s.decay, s.damping, s.distance, s.pan = size, decay, damping, distance, pan
    s.now = 1 - s.now
    image_sources.find_images(size, distance, pan, decay, s.seconds, s.gain[s.now])
    for ear in range(EARS):
        for wall in range(WALLS):
            frames = int(math.floor(s.seconds[ear, wall] * s.rate + 0.5))  # noqa: RUF046 - a float, compiled
            s.delay[s.now, ear, wall] = min(frames, SPAN - 1)
    way = image_sources.mean_free_path(size) / image_sources.SOUND
    absorption.set_shelf(s, 0, way, decay, damping)
    low = s.b_0[0] + s.b_1[0]  # of which the gains know: the shelf keeps its shape only
    low /= 1.0 + s.a_1[0]
    s.b_0[0] /= low
    s.b_1[0] /= low


@compiled_exactly
def is_silent(s: Any, x: float) -> bool:
    """Take note of a sample; whether neither it nor any other is heard, now or later.

    Of SPAN zeros nothing is left, in filters or among what is kept. Real time: safe.
    """
    s.silent = s.silent + 1 if x == 0.0 else 0
    return bool(s.silent > SPAN and s.mute == 0 and s.moved >= 1.0)


@compiled_exactly
def reflect(s: Any, frame: int, x: float) -> None:
    """Keep a sample, and compute what both ears hear of earlier ones (``early``).

    Real time: safe.
    """
    if s.mute < 0:
        s.mute += 1
        if s.mute == 0:
            mute(s)
    y = s.b_0[0] * x + s.b_1[0] * s.before - s.a_1[0] * s.filtered
    s.before, s.filtered = x, y
    s.kept[frame & (SPAN - 1)] = y
    if s.mute > 0:
        s.mute -= 1
        s.early[LEFT], s.early[RIGHT] = 0.0, 0.0
        return
    add_reflections(s, frame, s.now, min(1.0, s.moved), 0.0)
    if s.moved < 1.0:
        add_reflections(s, frame, 1 - s.now, 1.0 - s.moved, 1.0)
        s.moved += s.move_step


@compiled_exactly
def add_reflections(s: Any, frame: int, which: int, amplitude: float, add: float) -> None:
    """Hear one of the two sets of reflections, and add it to what was heard, or not (0)."""
    for ear in range(EARS):
        heard = 0.0
        for wall in range(WALLS):
            sample = s.kept[(frame - s.delay[which, ear, wall]) & (SPAN - 1)]
            heard += s.gain[which, ear, wall] * sample
        s.early[ear] = add * s.early[ear] + amplitude * heard


@compiled_exactly
def mute_when_closed(s: Any) -> None:
    """Let nothing that was kept be reflected once the room has closed. Real time: safe."""
    s.mute = -int(CLOSE_S * s.rate) - 2


@compiled_exactly
def mute(s: Any) -> None:
    """Reflect nothing of what was kept."""
    longest = 0
    for which in range(2):
        for ear in range(EARS):
            for wall in range(WALLS):
                longest = max(longest, s.delay[which, ear, wall])
    s.mute = longest
    s.before, s.filtered = 0.0, 0.0


@compiled_exactly
def reset_state(s: Any) -> None:
    """Reset the seat to its start state after an invalid sample. Real time: safe."""
    s.mute, s.silent = SPAN, 0
    s.before, s.filtered, s.size, s.moved = 0.0, 0.0, 0.0, 1.0
    for ear in range(EARS):
        s.early[ear], s.direct[ear] = 0.0, math.nan
    clear_sides(s.sides)
