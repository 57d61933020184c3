"""Brightness of a sound: the centroid of its spectrum. Compiled."""

from __future__ import annotations

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly

Array = Any

WINDOW_S = 0.04


@compiled_exactly
def window_frames(rate: float, frames: int) -> int:
    """Samples of the spectrum: a power of two, at least WINDOW_S where there are so many."""
    size = 2
    while size < WINDOW_S * rate and 2 * size <= frames:
        size *= 2
    return size


@compiled_exactly
def transform(real: Array, imaginary: Array, size: int) -> None:
    """Fourier transform in place, of a power of two of samples. Source: [CooleyTukey]."""
    place = 0
    for i in range(1, size):
        bit = size >> 1
        while place & bit:
            place ^= bit
            bit >>= 1
        place |= bit
        if i < place:
            real[i], real[place] = real[place], real[i]
            imaginary[i], imaginary[place] = imaginary[place], imaginary[i]
    length = 2
    while length <= size:
        half = length >> 1
        turn = -2.0 * math.pi / length
        step_real, step_imaginary = math.cos(turn), math.sin(turn)
        for begin in range(0, size, length):
            w_real, w_imaginary = 1.0, 0.0
            for a in range(begin, begin + half):
                b = a + half
                x = real[b] * w_real - imaginary[b] * w_imaginary
                y = real[b] * w_imaginary + imaginary[b] * w_real
                real[b], imaginary[b] = real[a] - x, imaginary[a] - y
                real[a], imaginary[a] = real[a] + x, imaginary[a] + y
                w_real, w_imaginary = (
                    w_real * step_real - w_imaginary * step_imaginary,
                    w_real * step_imaginary + w_imaginary * step_real,
                )
        length *= 2


@compiled_exactly
def centroid_hz(signal: Array, end: int, rate: float, work: Array) -> float:
    """The mean frequency, by power, of the sound before `end`; NaN for silence.

    `work` [shape=(2, at least the window)] is written.
    """
    size = window_frames(rate, end)
    real, imaginary = work[0], work[1]
    mean = 0.0
    for i in range(end - size, end):
        mean += signal[i]
    mean /= size
    for i in range(size):
        hann = 0.5 - 0.5 * math.cos(2.0 * math.pi * i / size)
        real[i], imaginary[i] = (signal[end - size + i] - mean) * hann, 0.0
    transform(real, imaginary, size)
    total, moment = 0.0, 0.0
    for i in range(1, size // 2 + 1):
        power = real[i] * real[i] + imaginary[i] * imaginary[i]
        total += power
        moment += power * i
    return moment / total * rate / size if total > 0.0 else math.nan
