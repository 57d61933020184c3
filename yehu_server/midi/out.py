"""Wishes that an event comes to: each for one player of the part. Compiled."""

from __future__ import annotations

from typing import Any

from yehu_server.jit import compiled_exactly
from yehu_server.midi.record import MOST_WISHES


@compiled_exactly
def emit(
    m: Any, person: int, frame: int, kind: int, index: int, value: float, other: float
) -> None:
    """Wish something of one player at a frame (``player.wishes``)."""
    if m.wishes >= MOST_WISHES:
        m.lost += 1
        return
    n = m.wishes
    m.out_person[n], m.out_frame[n], m.out_kind[n] = person, frame, kind
    m.out_index[n], m.out_value[n], m.out_other[n] = index, value, other
    m.wishes += 1
