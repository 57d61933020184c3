"""Directivity: from some 1 kHz up a body sounds otherwise to the left than to the right. Compiled.

Below, a body of this size radiates alike in all directions; above, each of its modes sends lobes
of either sign. What is measured is the sound straight ahead. To the left this is added, to the
right taken away: the same sound, through all-pass filters that turn its phase ever further with
the frequency, and two high-pass filters. So both sides differ in colour, and their mean is what was
measured.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import cos, sin, tan

SECTIONS = 4
# By ear: frequencies (Hz) and quality of the all-pass filters; the lowest lobes of a shell of
# 12 cm are at some 900 Hz, where its circumference is a wavelength.
TURNS_HZ = np.array([1150.0, 2100.0, 3700.0, 6400.0])
QUALITY = 1.1
FROM_HZ = 1500.0  # below, most of the sound would be louder to one side, by the note
PASSES = 2
SPREAD = 0.12  # how much the frequencies of two bodies differ, as a fraction

SIDES = np.dtype(
    [
        ("c_1", np.float64, SECTIONS),  # y = c_2 x + c_1 x' + x'' - c_1 y' - c_2 y''
        ("c_2", np.float64, SECTIONS),
        # What is to be added to the next sample, and to the one after it.
        ("soon", np.float64, SECTIONS),
        ("later", np.float64, SECTIONS),
        ("pass_b", np.float64),  # the high-pass filters
        ("pass_a", np.float64),
        ("passed", np.float64, PASSES),
        ("before", np.float64, PASSES),
    ],
    align=True,
)


def prepare_sides(sides: Any, rate: float, body: int = 0) -> None:
    """Prepare a record of SIDES at a rate (Hz), with the frequencies of one of many bodies."""
    spread = SPREAD * np.random.default_rng(body).uniform(-1.0, 1.0, SECTIONS) * (body > 0)
    for k, hertz in enumerate(TURNS_HZ * (1.0 + spread)):
        angle = 2.0 * math.pi * min(hertz / rate, 0.45)
        alpha = sin(angle) / (2.0 * QUALITY)
        sides["c_2"][k] = (1.0 - alpha) / (1.0 + alpha)
        sides["c_1"][k] = -2.0 * cos(angle) / (1.0 + alpha)
    warped = tan(math.pi * FROM_HZ / rate)
    sides["pass_b"] = 1.0 / (1.0 + warped)
    sides["pass_a"] = (1.0 - warped) / (1.0 + warped)
    clear_sides(sides)


def clear_sides(sides: Any) -> None:
    """Clear the filters of a record of dtype SIDES, in place."""
    for name in ("soon", "later", "passed", "before"):
        sides[name] = 0.0


@compiled_exactly
def side_signal(s: Any, x: float) -> float:
    """What the left hears more than straight ahead, and the right less. Real time: safe."""
    for k in range(PASSES):
        passed = s.pass_b * (x - s.before[k]) + s.pass_a * s.passed[k]
        s.before[k], s.passed[k] = x, passed
        x = passed
    for k in range(SECTIONS):
        y = s.c_2[k] * x + s.soon[k]
        s.soon[k] = s.c_1[k] * (x - y) + s.later[k]
        s.later[k] = x - s.c_2[k] * y
        x = y
    return float(x)


@compiled_exactly
def reset_sides(s: Any) -> None:
    """Clear the filters while sound runs. Real time: safe."""
    for k in range(PASSES):
        s.passed[k], s.before[k] = 0.0, 0.0
    for k in range(SECTIONS):
        s.soon[k], s.later[k] = 0.0, 0.0
