"""The player listens while a note sounds: finger and bow follow what the string does. Compiled."""

from __future__ import annotations

from typing import Any

from yehu_server.controls.hands import vibrato_at
from yehu_server.controls.slots import DEPTH, RATE, SIDE
from yehu_server.jit import compiled_exactly
from yehu_server.player.bowing_by_ear import help_bow
from yehu_server.player.drift import heard_semitones
from yehu_server.player.ear import BEHIND, hear
from yehu_server.player.notes import told_pitch
from yehu_server.player.rows import LISTENING
from yehu_server.player.tuning_by_ear import tune


@compiled_exactly
def listen(p: Any, c: Any, heard: Any) -> None:
    """Listen to the bowed string, and act on what is heard.

    Of a bow that is drawn by hand the player only hears.

    Parameters
    ----------
    heard : ndarray
        What `ear.remember` keeps.
    """
    by_hand = p.by_hand != 0
    is_bowed = c.value[SIDE] != 0.0 if by_hand else p.sounding >= 0 and p.side != 0.0
    if p.value[LISTENING] == 0.0 or not is_bowed or c.frame < p.settled_at:
        p.ear.certainty = 0.0
        return
    pitch = told_pitch(p)
    aim = pitch + vibrato_semitones(p, c) + heard_semitones(p)
    hear(p.ear, heard, c.frame, p.rate / (p.a4 * 2.0 ** ((aim - 69.0) / 12.0)))
    if not by_hand:  # who draws the bow corrects it
        tune(p, c, pitch)
        help_bow(p, c, pitch)


@compiled_exactly
def vibrato_semitones(p: Any, c: Any) -> float:
    """The vibrato in the middle of what is heard now."""
    if c.value[DEPTH] == 0.0:
        return 0.0
    ago = (BEHIND + p.ear.span) / p.rate
    phase = c.vibrato - c.vibrato_pace * c.value[RATE] * ago
    return float(vibrato_at(c, phase) * c.vibrato_width * c.value[DEPTH] / 100.0)
