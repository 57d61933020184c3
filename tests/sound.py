"""What an instrument plays, and its level."""

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec


def alone(rate: float, *, seed: int = 0, **how: object) -> Ensemble:
    """An ensemble of one instrument, without a room."""
    return Ensemble([InstrumentSpec(rate, seed=seed)], **{"channels": 1, "has_room": False} | how)


def bow(instrument: Instrument, press: float = 0.0, frame: int = 0) -> None:
    """Bow the F string, open or stopped at 10 cm."""
    if press:
        instrument.write("/finger/1/position", 0.1, frame=frame, ramp_ms=0.0)
        instrument.write("/finger/1/press", press, frame=frame)
    instrument.write("/bow/side", 1.0, frame=frame)
    instrument.write("/bow/speed", 0.2, frame=frame, ramp_ms=40.0)


def run(instrument: Instrument | Ensemble, frames: int, block: int = 0) -> np.ndarray:
    """The next frames of an instrument, in blocks of one size, or in one."""
    out = np.zeros(frames, np.float32)
    for start in range(0, frames, block or frames):
        instrument.process(out[start : start + (block or frames)])
    return out


def run_for(instrument: Instrument | Ensemble, seconds: float, block: int = 0) -> np.ndarray:
    return run(instrument, round(seconds * instrument.rate), block)


def rms(sound: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(sound, dtype=np.float64))))
