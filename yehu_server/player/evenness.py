"""Evens out the loudness of notes, which the body radiates differently, for velocity. Compiled."""

from __future__ import annotations

from typing import Any

from yehu_server.controls.slots import SIDE
from yehu_server.jit import compiled_exactly
from yehu_server.player.fingering import FIRST_OPEN, OPEN, SECOND_OPEN
from yehu_server.player.intonation import balance_db
from yehu_server.player.ownership import move
from yehu_server.player.rows import EVENNESS, OUTPUT_BALANCE
from yehu_server.player.velocity import struck_db

# A gain that rises slowly does not amplify the end of a loud note before; with the bow off the
# string there is none.
RISING_MS, FALLING_MS = 90.0, 15.0


@compiled_exactly
def even_out(p: Any, c: Any, pitch: float, speed: float) -> None:
    """Set ``/output/balance`` for a pitch (fractional MIDI note) and bow speed (m/s)."""
    string = max(p.string, 0)  # before the first note the inner string is open
    heard = pitch
    if p.position == OPEN:
        heard = SECOND_OPEN if string == 1 else FIRST_OPEN
    balance = balance_db(p, string, heard, speed) * p.value[EVENNESS]
    balance += 0.0 if p.by_hand != 0 else struck_db(p)
    is_off = c.value[SIDE] == 0.0 and p.by_hand == 0
    ramp_ms = RISING_MS if balance > p.balance and not is_off else FALLING_MS
    p.balance = balance
    move(p, c, OUTPUT_BALANCE, balance, ramp_ms)
