"""Random differences between notes, in bow speed, bow pressure and intonation. Compiled."""

from __future__ import annotations

import math
from typing import Any

from yehu_server.jit import compiled_exactly
from yehu_server.physics.chance import chance
from yehu_server.player.rows import VARIATION

# A sum of so many uniform numbers is all but normal.
ADDED = 12
# Standard deviations at full variation. By ear.
VARIED_FRACTION = 0.1  # of bow speed and pressure
VARIED_CENTS = 6.0
VARIED_LANDING, MOST_LANDING = 0.8, 2.0  # of the time of a landing; and its largest factor


@compiled_exactly
def begin_sequence(p: Any, seed: int) -> None:
    """Begin the sequence of a seed."""
    p.seed, p.drawn = seed, 0
    p.unsteady.slow[:], p.unsteady.tremor[:], p.unsteady.drawn = 0.0, 0.0, 0


@compiled_exactly
def vary_next_note(p: Any) -> None:
    """Draw the deviates of a new note."""
    varied = p.value[VARIATION] * VARIED_FRACTION
    p.hurry = 1.0 + varied * deviate(p)
    p.weight = 1.0 + varied * deviate(p)
    p.detuned = deviate(p)


@compiled_exactly
def deviate(p: Any) -> float:
    """A number of mean 0 and variance 1; each of the uniform ones has a variance of 1/3."""
    total = 0.0
    for _ in range(ADDED):
        total += chance((p.seed << 32) + p.drawn)
        p.drawn += 1
    return total / math.sqrt(ADDED / 3.0)


@compiled_exactly
def varied_semitones(p: Any) -> float:
    """Deviation of the sounding note from its pitch."""
    return float(p.value[VARIATION] * p.detuned * VARIED_CENTS / 100.0)


@compiled_exactly
def varied_landing(p: Any, landing_ms: float) -> float:
    """The time (ms) in which a finger lands, from the usual one."""
    if p.value[VARIATION] == 0.0:
        return landing_ms
    factor = 1.0 + p.value[VARIATION] * VARIED_LANDING * deviate(p)
    return float(landing_ms * min(max(factor, 1.0 / MOST_LANDING), MOST_LANDING))
