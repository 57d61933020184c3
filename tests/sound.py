"""What an instrument plays, and its level."""

from __future__ import annotations

import numpy as np

from yehu_server.engine.instrument import Instrument


def run(instrument: Instrument, frames: int, block: int = 0) -> np.ndarray:
    """The next frames of an instrument, in blocks of one size, or in one."""
    out = np.zeros(frames, np.float32)
    for start in range(0, frames, block or frames):
        instrument.process(out[start : start + (block or frames)])
    return out


def run_for(instrument: Instrument, seconds: float, block: int = 0) -> np.ndarray:
    return run(instrument, round(seconds * instrument.rate), block)


def rms(sound: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(sound, dtype=np.float64))))
