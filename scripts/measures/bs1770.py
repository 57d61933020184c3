"""Integrated loudness of a sound, from [BS1770], and its true peak."""

import math

import numpy as np
from scipy.signal import lfilter, resample_poly

BLOCK_S, STEP_S = 0.4, 0.1
SILENT_LUFS, BELOW_MEAN_LU = -70.0, 10.0  # gates


def lufs(sound: np.ndarray, rate: float) -> float:
    """Integrated loudness (LUFS) of samples [frames, channels], without weights of surround."""
    weighted = lfilter(*_high_pass(rate), lfilter(*_shelf(rate), sound, axis=0), axis=0)
    block, step = round(BLOCK_S * rate), round(STEP_S * rate)
    starts = range(0, len(sound) - block + 1, step)
    powers = np.array([np.mean(weighted[at : at + block] ** 2, axis=0).sum() for at in starts])
    heard = powers[_lufs(powers) > SILENT_LUFS]
    return float(_lufs(heard[_lufs(heard) > _lufs(heard.mean()) - BELOW_MEAN_LU].mean()))


def true_peak_db(sound: np.ndarray) -> float:
    """The largest value between samples, too (dB of full scale)."""
    return 20.0 * math.log10(float(np.abs(resample_poly(sound, 4, 1, axis=0)).max()))


def _lufs(power: np.ndarray) -> np.ndarray:
    return -0.691 + 10.0 * np.log10(power + 1e-12)


def _shelf(rate: float) -> tuple[list[float], list[float]]:
    """The standard's first filter, for any rate: its table at 48 kHz as an analog prototype."""
    k, q, gain = math.tan(math.pi * 1681.974450955533 / rate), 0.7071752369554196, 1.584864701130855
    root = gain**0.4996667741545416
    a0 = 1.0 + k / q + k * k
    b = [gain + root * k / q + k * k, 2.0 * (k * k - gain), gain - root * k / q + k * k]
    return [each / a0 for each in b], [1.0, 2.0 * (k * k - 1.0) / a0, (1.0 - k / q + k * k) / a0]


def _high_pass(rate: float) -> tuple[list[float], list[float]]:
    k, q = math.tan(math.pi * 38.13547087602444 / rate), 0.5003270373238773
    a0 = 1.0 + k / q + k * k
    return [1.0, -2.0, 1.0], [1.0, 2.0 * (k * k - 1.0) / a0, (1.0 - k / q + k * k) / a0]
