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
# A higher note has its fundamental in the band, which then is loudness more than colour.
FULL_UP_TO = 76.0  # E5, fractional MIDI note
HALVED_IN = 8.0  # semitones


@compiled_exactly
def brilliance_db(effort: float, place: float, pitch: float) -> float:
    """Gain of the high band (dB).

    Parameters
    ----------
    effort : float, m/s
        Speed of the bow times its share of Schelleng's limit; above 0.
    place : float
        Distance of the bow from the bridge, as a share of the sounding length.
    pitch : float
        Fractional MIDI note.
    """
    gain_db = USUAL_DB + HARDER_DB * math.log2(effort / USUAL_EFFORT)
    gain_db -= NEARER_DB * math.log2(place / USUAL_PLACE)
    gain_db = min(max(gain_db, LEAST_DB), MOST_DB)
    return float(gain_db * 0.5 ** (max(pitch - FULL_UP_TO, 0.0) / HALVED_IN))


@compiled_exactly
def set_brilliance(p: Any, c: Any, effort: float, pitch: float) -> None:
    """Set ``/body/brilliance`` for a pitch and an effort of the bow (m/s)."""
    if effort > 0.0:
        gain_db = brilliance_db(effort, p.value[POSITION], pitch)
        move(p, c, BODY_BRILLIANCE, p.value[BRILLIANCE] * gain_db, USUAL_MS)
