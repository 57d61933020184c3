"""How loud a sound is heard: A-weighting, and the integrated loudness of a recording."""

import math
from typing import Any

import numpy as np

Array = Any

AT_1_KHZ = 1.2589254117941673  # 2 dB
STEP_S, STEPS = 0.1, 4  # of blocks of 0.4 s, which overlap
SILENT_LUFS, BELOW_MEAN_LU = -70.0, 10.0  # gates


def a_weighting(frequencies_hz: Array) -> Array:
    """Return the amplitude factor of A-weighting, 1 at 1 kHz. Source: [IEC61672]."""
    f2 = np.square(np.asarray(frequencies_hz, np.float64))
    curve = (12194.0**2 * f2 * f2) / (
        (f2 + 20.6**2) * np.sqrt((f2 + 107.7**2) * (f2 + 737.9**2)) * (f2 + 12194.0**2)
    )
    return curve * AT_1_KHZ


class IntegratedLoudness:
    """Integrated loudness (LUFS) of a recording that comes in blocks. Source: [BS1770].

    Its filters weight the spectrum of each tenth of a second, which needs no filter's memory.
    """

    def __init__(self, rate: float) -> None:
        self._frames = round(STEP_S * rate)
        gains = np.abs(_k_weighting(np.fft.rfftfreq(self._frames), rate)) ** 2
        gains[1 : (self._frames + 1) // 2] *= 2.0  # of negative frequencies
        self._gains = gains[:, None] / self._frames**2
        self._rest: Array = None
        self._powers: list[float] = []  # of each tenth of a second

    def add(self, block: Array) -> None:
        """Take up the next block [shape=(frames,) or (frames, channels)]."""
        x = np.asarray(block, np.float64).reshape(len(block), -1)
        x = x if self._rest is None else np.concatenate((self._rest, x))
        whole = len(x) // self._frames
        steps, self._rest = np.split(x, [whole * self._frames])
        for step in steps.reshape(whole, self._frames, x.shape[1]):
            spectrum = np.fft.rfft(step, axis=0)
            power = np.square(spectrum.real) + np.square(spectrum.imag)
            self._powers.append(float((power * self._gains).sum()))

    def lufs(self, factor: float = 1.0) -> float | None:
        """The loudness of what was taken up, times a factor; None for silence, or 0.4 s at most."""
        blocks = np.convolve(
            self._powers or [0.0], np.full(STEPS, factor * factor / STEPS), "valid"
        )
        heard = blocks[(blocks > _power(SILENT_LUFS)) & (len(self._powers) >= STEPS)]
        if not len(heard):
            return None
        loud = heard[heard > heard.mean() * 10.0 ** (-BELOW_MEAN_LU / 10.0)]
        return -0.691 + 10.0 * math.log10(loud.mean())


def _power(lufs: float) -> float:
    return float(10.0 ** ((lufs + 0.691) / 10.0))


def _k_weighting(frequencies: Array, rate: float) -> Array:
    """The standard's two filters at shares of the rate; its table at 48 kHz as analog prototypes.

    The constants are those of which the table is the bilinear transform.
    """
    z = np.exp(-2j * np.pi * frequencies)
    s = (1.0 - z) / np.where(z == -1.0, 1e-12, 1.0 + z)
    shelf, high_pass = (
        s / math.tan(math.pi * hertz / rate) for hertz in (1681.974450955533, 38.13547087602444)
    )
    gain, q = 1.584864701130855, 0.7071752369554196
    root = gain**0.4996667741545416
    lifted = (gain * shelf**2 + root * shelf / q + 1.0) / (shelf**2 + shelf / q + 1.0)
    return lifted * high_pass**2 / (high_pass**2 + high_pass / 0.5003270373238773 + 1.0)
