"""Scripts for hosts, what the library makes of them, and what can be measured in a sound."""

import ctypes

import numpy as np

from yehu_server.core.midi.events import SET
from yehu_server.params.table import TABLE
from yehu_server.plugin.carried import carried
from yehu_server.plugin.parameters import parameters

PHRASE = [
    (0, 0xB0, 11, 110),
    (4800, 0x90, 69, 96),
    (28800, 0x90, 74, 60),
    (30000, 0x80, 69, 0),
    (48000, 0xB0, 1, 100),
    (52000, 0xE0, 0, 80),
    (60000, 0xB0, 64, 127),
    (64000, 0x80, 74, 0),
    (72000, 0xB0, 64, 0),
]
FRAMES = 90000


def script(messages, scale=1.0):
    """Lines of a script that play messages, each a frame and three bytes."""
    return [f"{round(frame * scale)} midi {a} {b} {c}" for frame, a, b, c in messages]


def prepared(path, rate=48000.0):
    """The library for C programs, and memory with an instrument that it has prepared [uint8]."""
    library = ctypes.CDLL(str(path))
    size, rig = ctypes.c_int64, ctypes.c_void_p
    library.yehu_size.restype = size
    library.yehu_prepare.argtypes = [rig, ctypes.c_double, size]
    library.yehu_midi.argtypes = [rig, size, ctypes.c_char_p, size]
    library.yehu_process.argtypes = [rig, rig, size]
    memory = np.zeros(library.yehu_size() + 64, np.uint8)
    memory = memory[-memory.ctypes.data % 64 :]
    assert library.yehu_prepare(memory.ctypes.data, rate, 2)
    return library, memory


def played(library, memory, messages, frames):
    """What a prepared instrument plays of messages [shape=(frames, 2)]."""
    at = memory.ctypes.data
    for frame, *message in messages:
        assert library.yehu_midi(at, frame, bytes(message), 3) == 1
    samples = np.zeros((frames, 2), np.float32)
    library.yehu_process(at, samples.ctypes.data, frames)
    return samples


def by_library(path, messages, frames, rate=48000.0):
    """What the library for C programs plays of messages, by the plug-in's first values.

    Returns samples [shape=(frames, 2)].
    """
    library, memory = prepared(path, rate)
    word, number = ctypes.c_int64, ctypes.c_double
    library.yehu_post.argtypes = [ctypes.c_void_p, word, word, word, number, number]
    for each in parameters(carried()):
        if each.index >= 0 and each.default != TABLE[each.index].default:
            at = memory.ctypes.data
            library.yehu_post(at, 0, SET, each.index, each.default, 0.0)
    return played(library, memory, messages, frames)


def frequency(samples, rate):
    """The frequency (Hz) whose first four multiples are strong together."""
    mono = samples.mean(axis=1) * np.hanning(len(samples))
    spectrum = np.abs(np.fft.rfft(mono, 8 * len(mono))) ** 2
    spacing = rate / (8 * len(mono))
    lowest, highest = (round(hz / spacing) for hz in (300.0, 1500.0))
    candidates = np.arange(lowest, highest)
    sums = sum(np.log(spectrum[candidates * harmonic] + 1e-9) for harmonic in (1, 2, 3, 4))
    return float(candidates[np.argmax(sums)] * spacing)


def level_db(samples):
    """Root mean square, in dB."""
    return float(10.0 * np.log10(np.mean(samples.astype(float) ** 2)))
