"""How each note wants to be bowed, so that it speaks in its own register.

Notes near the body's modes (A4 at 439 Hz above all) and the open F string jump to other
registers under a fast or a firm bow. Chosen after bowing each note, at 44.1 kHz, with shares of
Schelleng's limit from 0.25 to 1.15 and several speeds and places of the bow, for where it holds
Helmholtz motion; scripts/playability.py shows what comes of it.
"""

from __future__ import annotations

from dataclasses import dataclass

LIGHT, FIRM = 0.3, 0.55  # /playing/pressure, over which the leans below are given


@dataclass(frozen=True)
class Manner:
    """How a note is bowed.

    `top_speed` is the fastest bow (m/s) that it bears; `lean` what becomes of the pressures
    LIGHT and FIRM, as values of ``/bow/pressure``. `farther` from the bridge by this factor
    goes the bow, and the finger presses at least with `press` (N).
    """

    top_speed: float = 0.6
    lean: tuple[float, float] = (LIGHT, FIRM)
    farther: float = 1.0
    press: float = 0.0

    def pressure(self, wish: float) -> float:
        """The value of ``/bow/pressure`` for one of ``/playing/pressure``."""
        light, firm = self.lean
        return wish + (light - LIGHT) + (wish - LIGHT) * ((firm - light) / (FIRM - LIGHT) - 1.0)


ORDINARY = Manner()
MANNERS = {
    65: Manner(0.2, (0.16, 0.3), farther=1.4),
    66: Manner(0.22, (0.3, 0.37), farther=1.4, press=3.0),
    68: Manner(0.22),
    69: Manner(0.13, (0.38, 0.42)),
    71: Manner(0.24),
    76: Manner(0.22),
    78: Manner(0.25, (0.33, FIRM)),
    79: Manner(0.25, (0.33, FIRM)),
    80: Manner(0.25, (0.33, FIRM)),
    83: Manner(farther=1.15),
    85: Manner(0.26),
    89: Manner(0.25),
}


def manner(pitch: float) -> Manner:
    """How a pitch (fractional MIDI note) is bowed."""
    return MANNERS.get(round(pitch), ORDINARY)
