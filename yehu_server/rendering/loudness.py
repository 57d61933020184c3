"""Loudness of a whole recording, in LUFS. Source: [BS1770].

The sound is weighted as ears do, its power taken over 400 ms every 100 ms, and averaged over what
is not much quieter than the rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

Array = Any

HOP_S, HOPS = 0.1, 4  # a measured block has 400 ms
OFFSET_DB = -0.691
ABSOLUTE_GATE, RELATIVE_GATE = -70.0, -10.0  # LUFS; LU below the mean
RESPONSE_S = 0.15  # after which the high-pass is 300 dB down


def weighting(rate: float) -> Array:
    """The impulse response [shape=(frames,)] of K weighting: a shelf for the head, a high-pass."""
    k = math.tan(math.pi * 1681.974450955533 / rate)
    high, band, q = 10.0 ** (3.999843853973347 / 20.0), 0.4996667741545416, 0.7071752369554196
    mid = high**band * k / q
    shelf = (high + mid + k * k, 2.0 * (k * k - high), high - mid + k * k)
    response = np.zeros(round(RESPONSE_S * rate))
    response[0] = 1.0
    response = _second_order(response, shelf, k, q)
    k, q = math.tan(math.pi * 38.13547087602444 / rate), 0.5003270373238773
    low = 1.0 + k / q + k * k
    return _second_order(response, (low, -2.0 * low, low), k, q)


def _second_order(x: Array, b: tuple[float, float, float], k: float, q: float) -> Array:
    """Filter by b over the polynomial of poles (k, q)."""
    a0 = 1.0 + k / q + k * k
    a1, a2 = 2.0 * (k * k - 1.0) / a0, (1.0 - k / q + k * k) / a0
    y = np.zeros(len(x))
    x1 = x2 = y1 = y2 = 0.0
    for n, x0 in enumerate(x.tolist()):
        y0 = (b[0] * x0 + b[1] * x1 + b[2] * x2) / a0 - a1 * y1 - a2 * y2
        x2, x1, y2, y1 = x1, x0, y1, y0
        y[n] = y0
    return y


def loudness_lufs(blocks: Iterable[Array], rate: float) -> float:
    """Return the integrated loudness of a recording; -inf where all of it is below the gate.

    It comes in blocks [shape=(frames,) or (frames, channels); full scale 1], of one or two
    channels.
    """
    response = weighting(rate)
    hop = round(HOP_S * rate)
    powers: list[float] = []  # of each 100 ms, all channels together
    rest: Array = None
    tail: Array = None
    for block in blocks:
        if len(block) == 0:
            continue
        x = np.asarray(block, np.float64).reshape(len(block), -1)
        if tail is None:
            tail, rest = np.zeros((len(response) - 1, x.shape[1])), np.zeros((0, x.shape[1]))
        y = _convolved(x, response)
        y[: len(tail)] += tail
        tail, rest = y[len(x) :], np.concatenate((rest, y[: len(x)]))
        whole = len(rest) // hop * hop
        squares = np.square(rest[:whole]).sum(axis=1).reshape(-1, hop)
        powers += squares.mean(axis=1).tolist()
        rest = rest[whole:]
    return _gated(np.array(powers))


def _convolved(x: Array, response: Array) -> Array:
    length = len(x) + len(response) - 1
    size = 1 << (length - 1).bit_length()
    spectrum = np.fft.rfft(x, size, axis=0) * np.fft.rfft(response, size)[:, None]
    return np.fft.irfft(spectrum, size, axis=0)[:length]


def _gated(powers: Array) -> float:
    if len(powers) < HOPS:
        return -math.inf
    blocks = np.convolve(powers, np.full(HOPS, 1.0 / HOPS), "valid")
    blocks = blocks[blocks > 10.0 ** ((ABSOLUTE_GATE - OFFSET_DB) / 10.0)]
    if len(blocks) == 0:
        return -math.inf
    loud = blocks[blocks > blocks.mean() * 10.0 ** (RELATIVE_GATE / 10.0)]
    return OFFSET_DB + 10.0 * math.log10(loud.mean())
