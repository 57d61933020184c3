"""The true peak of a recording: of the wave between the samples. Source: [BS1770], annex 2."""

from __future__ import annotations

from typing import Any

import numpy as np

Array = Any

# The standard's interpolating filter: three values between each two samples.
_QUARTER = (
    0.0017089843750, 0.0109863281250, -0.0196533203125, 0.0332031250000, -0.0594482421875,
    0.1373291015625, 0.9721679687500, -0.1022949218750, 0.0476074218750, -0.0266113281250,
    0.0148925781250, -0.0083007812500,
)  # fmt: skip
_HALF = (
    -0.0291748046875, 0.0292968750000, -0.0517578125000, 0.0891113281250, -0.1665039062500,
    0.4650878906250, 0.7797851562500, -0.2003173828125, 0.1015625000000, -0.0582275390625,
    0.0330810546875, -0.0189208984375,
)  # fmt: skip
PHASES = (_QUARTER, _HALF, _HALF[::-1], _QUARTER[::-1])
TAPS = len(_QUARTER)
MOST = max(sum(map(abs, phase)) for phase in PHASES)  # gain of the worst wave


class TruePeak:
    """Finds the largest true peak of a recording that comes in blocks.

    It is that of the samples and of three values between each two. Of a block that cannot come up
    to the largest so far, they are not computed.
    """

    def __init__(self) -> None:
        self.peak = 0.0
        self._before: Array = None

    def add(self, block: Array) -> None:
        """Take up the next block [shape=(frames,) or (frames, channels)]."""
        x = np.asarray(block, np.float64).reshape(len(block), -1)
        if self._before is None:
            self._before = np.zeros((TAPS - 1, x.shape[1]))
        x = np.concatenate((self._before, x))
        self._before = x[len(x) - TAPS + 1 :]
        for channel in x.T:
            self._hear(channel)

    def finish(self) -> float:
        """Return the peak, once all is taken up."""
        if self._before is not None:
            self.add(np.zeros((TAPS, self._before.shape[1])))
        return self.peak

    def _hear(self, x: Array) -> None:
        highest = float(np.abs(x).max(initial=0.0))
        self.peak = max(self.peak, highest)
        if len(x) >= TAPS and highest * MOST > self.peak:
            for phase in PHASES:
                between = np.convolve(x, phase, "valid")
                self.peak = max(self.peak, float(np.abs(between).max()))
