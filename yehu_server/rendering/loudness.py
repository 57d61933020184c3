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
    frames = round(RESPONSE_S * rate)
    z = np.exp(2j * np.pi * np.fft.rfftfreq(2 * frames))

    def second_order(b: tuple[float, float, float], k: float, q: float) -> Array:
        a = (1.0 + k / q + k * k, 2.0 * (k * k - 1.0), 1.0 - k / q + k * k)
        return np.polyval(b, z) / np.polyval(a, z)

    k = math.tan(math.pi * 1681.974450955533 / rate)
    high, band, q = 10.0 ** (3.999843853973347 / 20.0), 0.4996667741545416, 0.7071752369554196
    mid = high**band * k / q
    shelf = second_order((high + mid + k * k, 2.0 * (k * k - high), high - mid + k * k), k, q)
    k, q = math.tan(math.pi * 38.13547087602444 / rate), 0.5003270373238773
    low = 1.0 + k / q + k * k
    high_pass = second_order((low, -2.0 * low, low), k, q)
    return np.fft.irfft(shelf * high_pass, 2 * frames)[:frames]


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
