"""Computes an ensemble on several cores: its instruments apart, block by block, then their mix.

The samples are those of the callback, which computes the instruments in turn, whatever the number
of cores.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

import numpy as np

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.intake import interpret_events
from yehu_server.core.engine.mixing import mix_block
from yehu_server.core.engine.output import SOUNDED
from yehu_server.core.engine.sounding import sound_block
from yehu_server.core.stage.image_sources import EARS

Array = Any


class Cores:
    """Computes blocks of an ensemble.

    Parameters
    ----------
    share : callable
        As `map`, for all cores: calls a function with each item.
    has_stems : bool
        Whether `stems` is wanted.

    Attributes
    ----------
    stems : ndarray [shape=(frames, parts + 1, EARS), float64]
        What each instrument, and at last the room, gave to the last block.
    """

    def __init__(
        self, ensemble: Ensemble, share: Callable[..., Any], *, has_stems: bool = False
    ) -> None:
        self._ensemble, self._share, self._has_stems = ensemble, share, has_stems
        self.stems = np.zeros((0, len(ensemble.instruments) + 1, EARS))

    def process(self, out: Array) -> None:
        """Compute the next frames; see `Ensemble.process`."""
        frames, parts = len(out), len(self._ensemble.instruments)
        if self._has_stems:
            self.stems = np.zeros((frames, parts + 1, EARS))
        done, begin = 0, self._ensemble.frame
        while done < frames:
            end = interpret_events.call(self._ensemble.address, begin + frames) - begin
            self._compute(out[done:end], self.stems[done:end])
            done = end

    def _compute(self, out: Array, stems: Array) -> None:
        """Compute frames whose events are taken in."""
        frames, instruments = len(out), self._ensemble.instruments
        first = self._ensemble.frame
        sounded = np.zeros((len(instruments), -(-frames // CHUNK)), SOUNDED)

        def sound(part: int) -> None:
            sound_block.call(instruments[part].address, frames, sounded[part].ctypes.data)

        for _ in self._share(sound, range(len(instruments))):
            pass
        places = (self._ensemble.address, sounded.ctypes.data, first, frames)
        into = (out.ctypes.data, stems.ctypes.data, int(self._has_stems))
        mix_block.call(*places, *into)


@contextmanager
def shared(cores: int) -> Iterator[Callable[..., Any]]:
    """Yield a `map` that uses a number of cores for compiled code."""
    if cores == 1:
        yield map
        return
    with ThreadPoolExecutor(cores, "part") as threads:
        yield threads.map
