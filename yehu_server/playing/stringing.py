"""What a two-stringed fiddle is tuned to, by its strings, and how the player plays it.

The player knows one hand: strings a fifth apart, F4 and C5, and two octaves from F4. On a fiddle
whose strings sound a fifth apart elsewhere, such as an erhu with D4 and A4, the same hand plays so
many semitones `higher`: its tables are measured at a reference pitch that is higher by as much,
and of every pitch that it is asked for as much is taken off.
"""

from __future__ import annotations

import math
from dataclasses import replace

from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.player.calibration import wave_speed
from yehu_server.core.player.fingering import HIGHEST_NOTE, LOWEST_NOTE
from yehu_server.playing.pitch_and_level import note_name

APART = 1.0  # semitones by which the strings may be off a fifth
FARTHEST = 36  # semitones


def higher_of(quantities: Quantities) -> int:
    """Semitones by which a fiddle is tuned higher than a yehu; 0 where it has no such fifth."""
    usual = Quantities()
    first, second = (
        12.0 * math.log2(_hertz(quantities, string) / _hertz(usual, string)) for string in (0, 1)
    )
    if abs(first - second) > APART or abs(first) > FARTHEST:
        return 0
    return round(0.5 * (first + second))


def players_a4(quantities: Quantities, a4: float) -> float:
    """The reference pitch (Hz) of the player's tables, where that of the music is `a4`."""
    return a4 * math.exp2(higher_of(quantities) / 12.0)


def as_for_a_yehu(quantities: Quantities) -> Quantities:
    """The quantities with tensions that would sound a yehu's notes at the player's A4."""
    lower = math.exp2(-higher_of(quantities) / 6.0)  # tension goes as the frequency squared
    first, second = (replace(string, T=string.T * lower) for string in quantities.strings)
    return replace(quantities, string_1=first, string_2=second)


def range_text(higher: int) -> str:
    """The lowest and the highest note of a fiddle."""
    return f"{note_name(LOWEST_NOTE + higher)} to {note_name(HIGHEST_NOTE + higher)}"


def _hertz(quantities: Quantities, string: int) -> float:
    """Of an ideal open string."""
    return wave_speed(quantities, string) / (2.0 * quantities.bridge_x)
