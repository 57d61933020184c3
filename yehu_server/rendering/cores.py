"""Computes an ensemble on several cores: its instruments apart, block by block, then their mix.

The samples are those of the callback, which computes the instruments in turn, whatever the number
of cores.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.event_dispatch import interpret_events
from yehu_server.core.engine.mixing import mix_block
from yehu_server.core.engine.output import SOUNDED
from yehu_server.core.engine.sounding import sound_block
from yehu_server.core.stage.room_geometry import EARS

Array = Any
T = TypeVar("T")


@dataclass(frozen=True)
class Sounded:
    """A block that is computed."""

    first: int  # number of its first frame
    # Frames, and ndarray [shape=(instruments, chunks), dtype=SOUNDED], of each piece.
    pieces: list[tuple[int, Array]] = field(default_factory=list)
    mixed: Array | None = None  # its samples, where the callback made them on one core


class Cores:
    """Computes blocks of an ensemble.

    `share` is as `map`, for all cores. With `is_in_turn` the callback computes it all, on one core,
    and makes no stems. With `has_stems`, `stems` [shape=(frames, parts + 1, EARS), float64] is what
    each instrument, and at last the room, gave to the last block that was mixed.
    """

    def __init__(
        self,
        ensemble: Ensemble,
        share: Callable[..., Any],
        *,
        has_stems: bool = False,
        is_in_turn: bool = False,
    ) -> None:
        self._ensemble, self._share = ensemble, share
        self._has_stems, self._is_in_turn = has_stems, is_in_turn
        self.stems = np.zeros((0, len(ensemble.instruments) + 1, EARS))

    def sound(self, frames: int) -> Sounded:
        """Compute the next frames; the block before may be mixed meanwhile."""
        if self._is_in_turn:
            out = self._zeros(frames)
            self._ensemble.process(out)
            return Sounded(self._ensemble.frame - frames, mixed=out)
        block, done = Sounded(self._ensemble.frame), 0
        while done < frames:
            end = interpret_events.call(self._ensemble.address, block.first + frames) - block.first
            block.pieces.append((end - done, self._sound(end - done)))
            done = end
        return block

    def _sound(self, frames: int) -> Array:
        instruments = self._ensemble.instruments
        sounded = np.empty((len(instruments), -(-frames // CHUNK)), SOUNDED)

        def sound(part: int) -> None:
            sound_block.call(instruments[part].address, frames, sounded[part].ctypes.data)

        for _ in self._share(sound, range(len(instruments))):
            pass
        return sounded

    def mix(self, block: Sounded) -> Array:
        """Mix a block; return its samples [shape=(frames, channels), float32]."""
        if block.mixed is not None:
            return block.mixed
        frames = sum(count for count, _ in block.pieces)
        out = self._zeros(frames)
        if self._has_stems:
            self.stems = np.zeros((frames, len(self._ensemble.instruments) + 1, EARS))
        done = 0
        for count, sounded in block.pieces:
            places = (self._ensemble.address, sounded.ctypes.data, block.first + done, count)
            into = (out[done:].ctypes.data, self.stems[done:].ctypes.data, int(self._has_stems))
            mix_block.call(*places, *into)
            done += count
        return out

    def _zeros(self, frames: int) -> Array:
        return np.zeros((frames, self._ensemble.channels), np.float32)


@contextmanager
def shared(cores: int) -> Iterator[Callable[..., Any]]:
    """Yield a `map` that uses a number of cores for compiled code."""
    if cores == 1:
        yield map
        return
    with ThreadPoolExecutor(cores, "part") as threads:
        yield threads.map


def computed_ahead(items: Iterator[T]) -> Iterator[T]:
    """Yield items, each of which is computed in a thread while the one before is used."""
    end: Any = object()
    with ThreadPoolExecutor(1, "ahead") as thread:
        item = thread.submit(next, items, end).result()
        while item is not end:
            coming = thread.submit(next, items, end)
            yield item
            item = coming.result()
