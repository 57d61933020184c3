"""Phrases of wishes, and how they sound in this process."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from yehu_server.engine.instrument import RIG_BYTES, Instrument
from yehu_server.player.rows import ROW
from yehu_server.player.wishes import BEGIN, END, HOLD
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.style import Style

RATE = 48000.0
FRAMES = 96000
BLOCK = 128
SECOND = 48000
OPEN_STRING = [(0, BEGIN, 0, 65.0, 65.0)]
STOPPED = [(0, BEGIN, 0, 69.0, 69.0)]
SLUR = [(0, BEGIN, 0, 74.0, 74.0), (SECOND // 2, BEGIN, 0, 77.0, 77.0)]
PLUCK = [
    (0, HOLD, ROW["/playing/pizzicato"], 1.0, 0.0),
    *((at, BEGIN, 0, note, note) for at, note in ((0, 72.0), (SECOND // 2, 79.0))),
]
TREMOLO = [
    (0, HOLD, ROW["/playing/tremolo"], 12.0, 0.0),
    (0, BEGIN, 0, 76.0, 76.0),
    (SECOND, END, 0, 76.0, 0.0),
]
PHRASES = {
    "open": OPEN_STRING,
    "stopped": STOPPED,
    "slur": SLUR,
    "pluck": PLUCK,
    "tremolo": TREMOLO,
}


def played(wishes, frames=FRAMES, block=BLOCK) -> tuple[np.ndarray, Instrument]:
    """Play wishes in this process; return the samples, and the instrument at the end."""
    style, memory = Style(), bytearray(RIG_BYTES)
    instrument = style.instrument(RATE, calibration_for(RATE), memory=memory)
    for frame, kind, index, value, other in wishes:
        assert instrument.post(kind, frame=frame, index=index, value=value, other=other)
    out = np.zeros(frames, np.float32)
    for start in range(0, frames, block):
        instrument.process(out[start : start + block])
    return out, instrument


if __name__ == "__main__":  # as another processor: writes the samples of each phrase
    folder = Path(sys.argv[1])
    for name, wishes in PHRASES.items():
        played(wishes)[0].tofile(folder / f"{name}.f32")
