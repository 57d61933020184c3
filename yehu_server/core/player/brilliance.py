"""How bright the bow makes a note, beyond what the model does. Compiled.

A fiddle sounds brighter when it is bowed harder or nearer to the bridge: force sharpens the corner
of the Helmholtz motion [Schoonderwaldt]. The model's corner stays as round at any force, by its
losses, its hair and its friction (docs/playing.md tells what was tried). What is missing is added
by a law: the gain of the output's high band follows speed and pressure of the bow, and its place.
"""

from __future__ import annotations

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.ownership import USUAL_MS, move
from yehu_server.core.player.rows import BODY_BRILLIANCE, BRILLIANCE, POSITION

# Gain of the high band (dB): with the ordinary bow; for each doubling of its speed times its
# pressure; for each halving of its distance from the bridge.
USUAL_DB, HARDER_DB, NEARER_DB = 5.0, 7.0, 11.0
USUAL_EFFORT = 0.08  # m/s, speed times share of Schelleng's limit
USUAL_PLACE = 0.13
LEAST_DB, MOST_DB = -6.0, 18.0


@compiled_exactly
def set_brilliance(p: Any, c: Any, effort: float) -> None:
    """Set ``/body/brilliance`` for an effort of the bow: its speed (m/s) times its pressure."""
    if effort > 0.0:
        gain_db = USUAL_DB + HARDER_DB * math.log2(effort / USUAL_EFFORT)
        gain_db -= NEARER_DB * math.log2(p.value[POSITION] / USUAL_PLACE)
        gain_db = min(max(gain_db, LEAST_DB), MOST_DB)
        move(p, c, BODY_BRILLIANCE, p.value[BRILLIANCE] * gain_db, USUAL_MS)
