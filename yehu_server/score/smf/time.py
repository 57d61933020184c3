"""The time of a MIDI file: its division, ticks to seconds."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence

from yehu_server.score.smf.faults import Faults

DEFAULT_TEMPO = 500_000  # microseconds a quarter note, 120 bpm
USUAL_TICKS = 480  # a quarter note, where a file has 0
USUAL_FRAME_TICKS = 40  # with 25 frames a second, milliseconds
TRUE_FRAMES = {29: (30_000, 1001)}  # "29" frames a second are the 29.97 of drop-frame video
FILM_FRAMES = (24, 25, 29, 30)
SMPTE = 0x8000


def checked_division(division: int, at: int, faults: Faults) -> int:
    """Return the division of a header, at a byte; where it is impossible, the one assumed."""
    if division == 0:
        faults.add(f"a division of 0: {USUAL_TICKS} ticks a quarter note assumed", at)
        return USUAL_TICKS
    if division < SMPTE:
        return division
    frames = 256 - (division >> 8)
    if frames not in FILM_FRAMES:
        faults.add(f"{frames} frames a second, as no film has, believed", at)
    if division & 0xFF == 0:
        faults.add(f"a division of 0: {USUAL_FRAME_TICKS} ticks a frame assumed", at)
        return division | USUAL_FRAME_TICKS
    return division


class Clock:
    """Converts ticks to seconds, in integers so that long files do not drift.

    Parameters
    ----------
    division : int
        As in a header, not 0: ticks a quarter note, or frames a second and ticks a frame.
    tempos : sequence of (int, int)
        Ticks, in order, and the microseconds of a quarter note from there on.
    """

    def __init__(self, division: int, tempos: Sequence[tuple[int, int]]) -> None:
        if division >= SMPTE:  # no tempo
            frames, seconds = TRUE_FRAMES.get(256 - (division >> 8), (256 - (division >> 8), 1))
            self._units_per_second = frames * (division & 0xFF)
            changes = [(0, seconds)]
        else:
            self._units_per_second = division * 1_000_000
            changes = [(0, DEFAULT_TEMPO), *tempos]
        self._per_beat = math.nan if division >= SMPTE else division
        self._ticks: list[int] = []
        self._spans: list[tuple[int, int]] = []  # units so far, units a tick from here on
        for tick, rate in changes:
            so_far = self._units(tick) if self._ticks else 0
            self._ticks.append(tick)
            self._spans.append((so_far, rate))

    def _units(self, tick: int) -> int:
        at = bisect_right(self._ticks, tick) - 1
        so_far, rate = self._spans[at]
        return so_far + (tick - self._ticks[at]) * rate

    def seconds(self, tick: int) -> float:
        """The time (s) of a tick."""
        return self._units(tick) / self._units_per_second

    def beat(self, tick: int) -> float:
        """The time of a tick in quarter notes; NaN where frames are counted."""
        return tick / self._per_beat
