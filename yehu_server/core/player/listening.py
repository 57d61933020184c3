"""The player's work of each 5 ms: drift, gestures, the bow's end, ear, corrections. Compiled."""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.compile.memory import carray
from yehu_server.core.controls.kernel_controls import vibrato_at
from yehu_server.core.controls.record import Controls
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.physics.elementary import exp2
from yehu_server.core.player.articulating import articulate
from yehu_server.core.player.bowing_by_ear import correct_pressure
from yehu_server.core.player.drift import advance_drift, heard_semitones, vary_vibrato
from yehu_server.core.player.ear import DELAY_FRAMES, EAR_SAMPLES, hear
from yehu_server.core.player.left_hand import end_shift
from yehu_server.core.player.notes import is_touched, note_pitch, reverse_bow_at_end
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.player.record import Player
from yehu_server.core.player.stroke_contours import advance_contours
from yehu_server.core.player.sway import advance_sway
from yehu_server.core.player.tuning_by_ear import tune


@compiled_exactly
def listen(p: Any, c: Any, heard: Any) -> None:
    """Listen to the bowed string (of ``ear.remember``), and act on what is heard.

    While the bow is drawn directly, the string is analysed but nothing is corrected.
    """
    is_direct = p.is_direct != 0
    is_bowed = c.value[SLOTS.bow_side] != 0.0 if is_direct else p.sounding >= 0 and p.side != 0.0
    is_bowed = is_bowed and not is_touched(p)  # a harmonic is where its node is
    if p.value[PLAYING.listening] == 0.0 or not is_bowed or c.frame < p.settled_at:
        p.ear.certainty = 0.0
        return
    pitch = p.finger_pitch if is_direct else note_pitch(p)
    aim = pitch + vibrato_semitones(p, c) + heard_semitones(p)
    hear(p.ear, heard, c.frame, p.rate / (p.a4 * exp2((aim - 69.0) / 12.0)))
    if not is_direct:  # who draws the bow corrects it
        tune(p, c, pitch)
        correct_pressure(p, c, pitch)


@compiled_exactly
def vibrato_semitones(p: Any, c: Any) -> float:
    """The vibrato in the middle of what is heard now."""
    if c.value[SLOTS.vibrato_depth] == 0.0:
        return 0.0
    ago = (DELAY_FRAMES + p.ear.span) / p.rate
    phase = c.vibrato - c.vibrato_rate_factor * c.value[SLOTS.vibrato_rate] * ago
    return float(
        vibrato_at(c, phase) * c.vibrato_depth_factor * c.value[SLOTS.vibrato_depth] / 100.0
    )


@native
def update_player(p: Player, c: Controls, sound: Any) -> None:
    """Do the player's work of one hop, at a frame of ``ear.next``. Real time: safe."""
    p.ear.next += p.ear.hop
    advance_contours(p, c)
    advance_drift(p, c)
    advance_sway(p, c)
    vary_vibrato(p, c)
    articulate(p, c)
    end_shift(p, c)
    reverse_bow_at_end(p, c)
    listen(p, c, carray(sound, (2 * EAR_SAMPLES,), np.float64))
