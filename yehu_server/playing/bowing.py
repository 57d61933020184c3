"""Bow speed, force and position for each note, so that it speaks in its own register.

Notes near the body's modes (A4 at 439 Hz above all) and the open F string jump to other
registers under a fast or a heavy bow. The values were chosen by bowing each note at 44.1 kHz,
separate and slurred from its neighbours, at several speeds, positions and fractions of Schelleng's
limit, for the soonest and most stable onset; scripts/playability.py measures the result. On the F
string the bow is farther from the bridge: there the body disturbs less, and Schelleng's wedge is
wider.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

# Values of /playing/pressure: the two for which `lean` is given, and where notes begin to scratch.
LIGHT, FIRM, SCRATCHY = 0.3, 0.55, 1.0
# Fractions of Schelleng's limit at which notes begin to scratch, on the F and on the C string;
# measured at 0.12 and 0.2 m/s on eight notes: 1 to 2, and 3 to 6.
EDGES, FIRST_ON_C = (1.3, 4.0), 71.5


@dataclass(frozen=True)
class Manner:
    """How a note is bowed.

    Attributes
    ----------
    top_speed : float
        Highest bow speed (m/s) at which it speaks.
    lean : tuple of float
        Values of ``/bow/pressure`` for the player's pressures LIGHT and FIRM.
    farther : float
        Factor on the distance of the bow from the bridge.
    press : float
        Least finger force (N).
    """

    top_speed: float = 0.6
    lean: tuple[float, float] = (LIGHT, FIRM)
    farther: float = 1.0
    press: float = 0.0

    def pressure(self, wish: float, pitch: float) -> float:
        """Map a value of ``/playing/pressure`` to one of ``/bow/pressure``, for a pitch."""
        light, firm = self.lean
        edge = EDGES[1 if pitch >= FIRST_ON_C else 0]
        if wish <= LIGHT:
            return light * wish / LIGHT
        if wish <= FIRM:
            return light + (firm - light) * (wish - LIGHT) / (FIRM - LIGHT)
        return firm + (edge - firm) * (wish - FIRM) / (SCRATCHY - FIRM)


ORDINARY = Manner()
MANNERS = {
    65: Manner(0.2, (0.4, 0.5), farther=1.7),
    66: Manner(0.2, (0.25, 0.35), farther=1.7, press=3.0),
    67: Manner(0.2, (0.3, 0.4), farther=1.7),
    68: Manner(0.2, (0.3, 0.4), farther=1.3),
    69: Manner(0.1, (0.5, 0.6), farther=1.3),
    70: Manner(0.2),
    71: Manner(0.17, (0.3, 0.4)),
    76: Manner(0.22),
    78: Manner(0.25, (0.33, FIRM)),
    79: Manner(0.25, (0.33, FIRM)),
    80: Manner(0.25, (0.33, FIRM)),
    83: Manner(0.2, farther=1.15, press=3.0),
    85: Manner(0.26),
    89: Manner(0.25),
}


def manner(pitch: float) -> Manner:
    """How a pitch (fractional MIDI note) is bowed; interpolated between notes."""
    below = math.floor(pitch)
    low, high = (MANNERS.get(note, ORDINARY) for note in (below, below + 1))
    part = pitch - below
    if low is high or part == 0.0:
        return low

    def blend(one: float, other: float) -> float:
        return one + part * (other - one)

    return Manner(
        blend(low.top_speed, high.top_speed),
        (blend(low.lean[0], high.lean[0]), blend(low.lean[1], high.lean[1])),
        blend(low.farther, high.farther),
        blend(low.press, high.press),
    )
