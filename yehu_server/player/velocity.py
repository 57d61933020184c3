"""What velocity does to a note: its loudness, by bow and by gain, and its attack. Compiled.

At NEUTRAL all is as the other parameters say. A harder note is bowed faster and gets its force
sooner than its speed; a softer one begins gently. With the force that mappings let velocity set,
the level rises by some 18 dB from 1 to 127 (scripts/playability.py velocity).
"""

from __future__ import annotations

from typing import Any

from yehu_server.jit import compiled_exactly
from yehu_server.params.table import find
from yehu_server.player.rows import VELOCITY

NEUTRAL = find("/playing/velocity").default
# At velocities of 0 and 1, by ear: gain (dB); factors on bow speed, time of attack and, above
# NEUTRAL, pressure during the attack.
SOFTER_DB, LOUDER_DB = -10.5, 3.7
SLOWER, FASTER = 0.6, 1.2
GENTLE, BITING = 1.75, 0.6
BITE, BITE_MS = 1.3, 60.0


@compiled_exactly
def between(p: Any, softest: float, neutral: float, hardest: float) -> float:
    """A value at the velocity of the note, from those at 0, NEUTRAL and 1."""
    velocity = p.value[VELOCITY]
    if velocity < NEUTRAL:
        return float(neutral + (softest - neutral) * (NEUTRAL - velocity) / NEUTRAL)
    return float(neutral + (hardest - neutral) * (velocity - NEUTRAL) / (1.0 - NEUTRAL))


@compiled_exactly
def struck_db(p: Any) -> float:
    """Gain (dB) of the note."""
    return between(p, SOFTER_DB, 0.0, LOUDER_DB)


@compiled_exactly
def struck_speed(p: Any) -> float:
    """Factor on the bow's speed."""
    return between(p, SLOWER, 1.0, FASTER)


@compiled_exactly
def struck_attack(p: Any) -> float:
    """Factor on the time of the attack."""
    return between(p, GENTLE, 1.0, BITING)


@compiled_exactly
def struck_bite(p: Any) -> float:
    """Factor on the bow's pressure as a stroke begins."""
    return between(p, 1.0, 1.0, BITE)
