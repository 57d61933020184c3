"""A player of the shipped instrument that plays, and whose controls are read every 5 ms."""

from typing import Any

import numpy as np

from yehu_server.core.engine.instrument import Instrument
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key

RATE = 44100
HOP = 220  # frames


class Playing:
    """A player; keyword arguments are values of parameters under ``/playing``."""

    def __init__(self, seed: int = 0, **values: float) -> None:
        playing = PlayingOptions(seed=seed)
        self.instrument = Instrument(playing.spec(RATE, calibration_for(float(RATE))))
        self.commands = playing.player(self.instrument)
        for name, value in values.items():
            self.commands.write(f"/playing/{name}", value)

    @property
    def controls(self) -> Any:
        """The record of the controls."""
        return self.instrument._rig["controls"][0]

    @property
    def player(self) -> Any:
        """The player's record."""
        return self.instrument._rig["player"][0]

    def on(self, note: float) -> None:
        self.commands.note_on(Key(0, note))

    def off(self, note: float) -> None:
        self.commands.note_off(Key(0, note))

    def play(self, seconds: float, *names: str) -> list[np.ndarray]:
        """Play on; return fields of the controls, every HOP frames."""
        found: list[list[Any]] = [[] for _ in names]
        out = np.zeros(HOP, np.float32)
        for _ in range(round(seconds * RATE / HOP)):
            self.instrument.process(out)
            for name, values in zip(names, found, strict=True):
                values.append(self.controls[name].copy())
        return [np.array(values) for values in found]

    def sound(self, seconds: float, block: int = 512) -> np.ndarray:
        """Play on; return the sound."""
        out = np.zeros(round(seconds * RATE), np.float32)
        for start in range(0, len(out), block):
            self.instrument.process(out[start : start + block])
        return out
