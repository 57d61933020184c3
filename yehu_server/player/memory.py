"""What the ear has learnt, as long as the program runs. Compiled."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.jit import compiled_exactly
from yehu_server.player.calibration import OPEN_NOTES
from yehu_server.player.rows import LISTENING, POSITION, SPEED


@compiled_exactly
def shelf(p: Any, pitch: float) -> tuple[int, int, int]:
    """Where what is learnt of a pitch is kept: numbers of pitch, bow position and bow speed."""
    row = int(np.rint(2.0 * (pitch - OPEN_NOTES[0])))
    place = int(np.rint(4.0 * math.log2(p.value[POSITION] / 0.05)))
    pace = int(np.rint(2.0 * math.log2(p.value[SPEED] / 0.03)))
    return (
        min(max(row, 0), p.learnt.shape[1] - 1),
        min(max(place, 0), p.learnt.shape[2] - 1),
        min(max(pace, 0), p.learnt.shape[3] - 1),
    )


@compiled_exactly
def learnt_cents(p: Any, string: int, pitch: float) -> float:
    """What was learnt of a pitch on a string (cents of sharpening)."""
    row, place, pace = shelf(p, pitch)
    return float(p.learnt[string, row, place, pace]) if p.value[LISTENING] > 0.0 else 0.0
