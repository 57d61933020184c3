"""An instrument that only checks its events, and a calibration for it."""

from __future__ import annotations

import math

from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE, find
from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibration import PITCHES, SPEEDS, Calibration
from yehu_server.playing.live import LivePlayer

# Near a measured calibration, which takes seconds to make.
CALIBRATION = Calibration(
    440.0,
    (51.0, 64.0),
    tuple(tuple((20.0,) * len(SPEEDS) for _ in pitches) for pitches in PITCHES),
    tuple(tuple((-30.0,) * len(SPEEDS) for _ in (None, *pitches)) for pitches in PITCHES),
)


class Instrument:
    """Stands in for ``engine.instrument.Instrument``; `now_s` is its time."""

    rate = 48000.0

    def __init__(self) -> None:
        self.quantities = Quantities()
        self.now_s = 0.0
        self.values: dict[str, float] = {}

    def frames(self, ms: float) -> int:
        return round(ms * 1e-3 * self.rate)

    def frame_at(self, _time_ns: int) -> float:
        return self.now_s * self.rate

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        param = find(address)
        assert param.place is Place.ENGINE, address
        assert math.isfinite(value), address
        assert ramp_ms is None or 0.0 <= ramp_ms < math.inf, address
        assert frame is None or isinstance(frame, int)
        self.values[address] = param.accept(value)
        return self.values[address]

    def silence(self, *, frame: int | None = None) -> None:
        assert frame is None or isinstance(frame, int)


def check_values(player: LivePlayer) -> None:
    """Every parameter is within its range."""
    values = player.values()
    for param in TABLE:
        assert param.lo <= values[param.address] <= param.hi, param.address
