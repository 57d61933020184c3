"""A-weighting: how loud a sound of each frequency is heard."""

from typing import Any

import numpy as np

Array = Any

AT_1_KHZ = 1.2589254117941673  # 2 dB


def a_weighting(frequencies_hz: Array) -> Array:
    """Return the amplitude factor of A-weighting, 1 at 1 kHz. Source: [IEC61672]."""
    f2 = np.square(np.asarray(frequencies_hz, np.float64))
    curve = (12194.0**2 * f2 * f2) / (
        (f2 + 20.6**2) * np.sqrt((f2 + 107.7**2) * (f2 + 737.9**2)) * (f2 + 12194.0**2)
    )
    return curve * AT_1_KHZ
