"""What the player does to plain notes by itself: late vibrato, and slides on leaps. Compiled.

Both only as far as `/playing/phrasing` says, and where nothing else is wished. docs/playing.md
tells the rules.
"""

from __future__ import annotations

from typing import Any

from yehu_server.controls.slots import SIDE
from yehu_server.jit import compiled_exactly
from yehu_server.player.rows import NOTE_LENGTH, PHRASING, ROCKING_DELAY, VIBRATO

# At full phrasing; by ear.
VIBRATO_CENTS, LATE_MS = 36.0, 1100.0
SLIDE_MS, SHORTEST_SLIDE_MS = 130.0, 45.0
STEP_MS = -1.0  # in place of the time of a slide
# A leap asks for a slide where it is so wide (semitones), from a note and to a note so long.
LEAST_LEAP, WIDEST_LEAP, LONG_S = 4.5, 9.5, 0.3


@compiled_exactly
def vibrato_cents(p: Any) -> float:
    """Depth of the vibrato: as wished, else the player's own."""
    if p.value[VIBRATO] > 0.0:
        return float(p.value[VIBRATO])
    return float(p.value[PHRASING] * VIBRATO_CENTS)


@compiled_exactly
def vibrato_delay_ms(p: Any) -> float:
    """Time in which the vibrato of a new note comes: as wished; the player's own comes late."""
    if p.value[VIBRATO] > 0.0 or p.value[PHRASING] == 0.0:
        return float(p.value[ROCKING_DELAY])
    return float(max(p.value[ROCKING_DELAY], LATE_MS))


@compiled_exactly
def slide_of_leap_ms(p: Any, c: Any, leap: float) -> float:
    """Time of a slide over a leap (semitones); STEP_MS where the finger steps."""
    if p.value[PHRASING] == 0.0 or c.value[SIDE] == 0.0:
        return STEP_MS
    is_wide = LEAST_LEAP < abs(leap) < WIDEST_LEAP
    is_long = c.frame - p.note_began > LONG_S * p.rate
    length = p.value[NOTE_LENGTH]
    if not is_wide or not is_long or 0.0 < length < LONG_S:
        return STEP_MS
    return float(SHORTEST_SLIDE_MS + (SLIDE_MS - SHORTEST_SLIDE_MS) * p.value[PHRASING])
