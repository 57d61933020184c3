"""The instrument of the server, seen from the pages' process: it reads the shared record only."""

from __future__ import annotations

import mmap
from typing import Any

import numpy as np

from yehu_server.engine import native
from yehu_server.engine.instrument import RIG_BYTES, TAPE_FRAMES
from yehu_server.engine.look import LOOK, look
from yehu_server.engine.telemetry import METERS

Array = Any

MARGIN = TAPE_FRAMES // 8  # frames of the tape that may be overwritten during a copy


class Seen:
    """An instrument in shared memory, while another process plays it.

    Parameters
    ----------
    descriptor : int
        File descriptor of the memory.
    """

    def __init__(self, descriptor: int) -> None:
        self._memory = mmap.mmap(descriptor, RIG_BYTES)
        self._rig = np.frombuffer(self._memory, native.RIG, count=1)
        self._address = self._rig.ctypes.data
        self._look = np.zeros(1, LOOK)
        self._meters = np.zeros(1, METERS)

    @property
    def rate(self) -> float:
        """Sample rate (Hz)."""
        return float(self._rig["model"]["rate"][0])

    def look(self) -> bytes:
        """A look at it (``engine.look``), and then the value of each row of the parameter table."""
        look.call(self._address, self._look.ctypes.data)
        values: bytes = self._rig["player"]["value"].tobytes()
        return self._look.tobytes() + values

    def load(self) -> tuple[float, int]:
        """The share of the time that computing takes, and the number of drop-outs so far."""
        for _ in range(native.TRIES):
            if native.read_meters.call(self._address, self._meters.ctypes.data):
                break
        meters = self._meters[0]
        return float(meters["load"]), int(meters["underruns"] + meters["missed"])

    def taped(self) -> int:
        """Number of frames that were taped; the next frame to be heard."""
        return int(native.taped.call(self._address))

    def sound(self, begin: int, end: int) -> tuple[int, bytes]:
        """Samples of some frames, float32; they begin later where the tape has lost the first."""
        begin = max(begin, end - TAPE_FRAMES + MARGIN)
        samples = self._rig["tape"][0, np.arange(begin, end) % TAPE_FRAMES]
        return begin, samples.tobytes()
