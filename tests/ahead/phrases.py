"""Phrases of commands, and how they sound in this process."""

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.player.commands import BEGIN, END, HOLD
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions

RATE = 48000.0
FRAMES = 72000
BLOCK = 128
SECOND = 48000
OPEN_STRING = [(0, BEGIN, 0, 65.0, 65.0)]
STOPPED = [(0, BEGIN, 0, 69.0, 69.0)]
SLUR = [(0, BEGIN, 0, 74.0, 74.0), (SECOND // 2, BEGIN, 0, 77.0, 77.0)]
PLUCK = [
    (0, HOLD, INDEX["/playing/pizzicato"], 1.0, 0.0),
    *((at, BEGIN, 0, note, note) for at, note in ((0, 72.0), (SECOND // 2, 79.0))),
]
TREMOLO = [
    (0, HOLD, INDEX["/playing/tremolo"], 12.0, 0.0),
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


def played(commands, frames=FRAMES, block=BLOCK, channels=2) -> tuple[np.ndarray, Ensemble]:
    """Play commands in this process, in the usual room.

    Returns
    -------
    samples : ndarray [shape=(frames, channels), float32]
    ensemble : Ensemble
        Of the one instrument, at the end.
    """
    calibration = calibration_for(RATE)
    ensemble = Ensemble([PlayingOptions().spec(RATE, calibration)], channels=channels)
    for frame, kind, index, value, other in commands:
        assert ensemble.first.post(kind, frame=frame, index=index, value=value, other=other)
    out = np.zeros((frames, channels), np.float32)
    for start in range(0, frames, block):
        ensemble.process(out[start : start + block])
    return out, ensemble
