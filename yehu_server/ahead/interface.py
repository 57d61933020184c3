"""The functions of an instrument that needs no Python. Compiled.

A C program, or a page, gives the memory of an instrument (`size` bytes, aligned to 64), prepares
it, posts wishes, and computes blocks; nothing is allocated. `post` may run beside `process`, on
one other thread; so may `frame`, `value`, `pitch`, `look` and `lost`, which only read.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from yehu_server.controls.record import CONTROLS
from yehu_server.engine import native as engine
from yehu_server.engine import rig as memory
from yehu_server.engine.atomics import at
from yehu_server.engine.look import look
from yehu_server.engine.output import OUTPUT
from yehu_server.jit import Native, native
from yehu_server.memory import carray
from yehu_server.physics.layout import STATE
from yehu_server.player.notes import told_pitch
from yehu_server.player.record import PLAYER
from yehu_server.player.rows import ROWS, SLOT_OF
from yehu_server.stage.record import STAGE

Array = Any

BYTES = memory.memory_bytes(1)
WORDS = BYTES // 8
play_block = engine.callback.symbol


@native("int64()")
def size() -> int:
    """Bytes that an instrument takes."""
    return BYTES


@native("void(voidptr, voidptr, int64)", calls=[engine.callback])
def process(rig: Any, out: Any, frames: int) -> None:
    """Compute the next frames, of float samples in full scale, channels interleaved.

    Real time: safe; no allocation, no lock, every sample finite.
    """
    play_block(rig, out, np.uint64(frames), rig, np.uint64(0), rig)


@native("int64(voidptr)")
def frame(rig: Any) -> int:
    """Number of the next frame."""
    return int(carray(at(rig, memory.CONTROLS_AT), (1,), CONTROLS)[0].frame)


@native("float64(voidptr, int64)")
def value(rig: Any, parameter: int) -> float:
    """The value that a parameter has, or moves to; NaN for none."""
    if not 0 <= parameter < ROWS:
        return np.nan
    if SLOT_OF[parameter] >= 0:
        controls = carray(at(rig, memory.CONTROLS_AT), (1,), CONTROLS)[0]
        return float(controls.target[SLOT_OF[parameter]])
    return float(carray(at(rig, memory.PLAYER_AT), (1,), PLAYER)[0].value[parameter])


@native("float64(voidptr)")
def pitch(rig: Any) -> float:
    """The pitch that sounds (fractional MIDI note), or NaN in silence."""
    return told_pitch(carray(at(rig, memory.PLAYER_AT), (1,), PLAYER)[0])


@native("int64(voidptr)")
def lost(rig: Any) -> int:
    """How often the state was lost, and put back to rest; it should stay 0."""
    state = carray(at(rig, memory.STATE_AT), (1,), STATE)[0]
    output = carray(at(rig, memory.OUTPUT_AT), (1,), OUTPUT)[0]
    mix = carray(at(rig, memory.RIG_BYTES), (1,), STAGE)[0]
    return int(state.lost + output.unsound + mix.unsound)


def preparing(rates: Sequence[float], images: Sequence[Array]) -> Native:
    """Make the function `prepare`, which puts one of some images into memory.

    Parameters
    ----------
    images : sequence of ndarray [dtype=int64]
        For each of `rates` (Hz); see `images.image`.
    """
    known = np.array(rates)
    ends = np.cumsum([len(image) for image in images])
    words = np.concatenate(images)

    def prepare(rig: Any, rate: float, channels: int) -> int:
        """Make an instrument at a rate (Hz), at rest; return 0 where there is none for it."""
        words_of = carray(rig, (WORDS,), np.int64)
        start = 0
        for i in range(len(known)):
            if known[i] == rate:
                for word in range(WORDS):
                    words_of[word] = 0
                while start < ends[i]:
                    first, count = words[start], words[start + 1]
                    for word in range(count):
                        words_of[first + word] = words[start + 2 + word]
                    start += 2 + count
                carray(at(rig, memory.RIG_BYTES), (1,), STAGE)[0].channels = channels
                return 1
            start = ends[i]
        return 0

    return native("int64(voidptr, float64, int64)")(prepare)


def telling(sources: str) -> Native:
    """Make the function `sources`, which tells a hash of 16 hex digits as a number."""
    number = np.uint64(int(sources, 16)).astype(np.int64)

    def sources_number() -> int:
        """Tell what it was made from: YEHU_SOURCES, as a number."""
        return int(number)

    made = native("int64()")(sources_number)
    made.name = "yehu_sources"
    return made


def functions(rates: Sequence[float], images: Sequence[Array], sources: str) -> list[Native]:
    """List all functions of the interface, for the images and the hash of sources given."""
    prepare, told = preparing(rates, images), telling(sources)
    return [told, size, prepare, engine.post, process, frame, value, pitch, look, lost]
