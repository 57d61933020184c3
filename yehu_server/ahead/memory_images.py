"""Images of instruments ready to play, at each usual rate: runs of words that are not zero."""

from collections.abc import Iterable
from itertools import chain, pairwise
from typing import Any

import numpy as np

from yehu_server.compile.memory import WORD
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.rig import HEAP_AT, MIDI_AT, RIG_BYTES, memory_bytes
from yehu_server.core.midi.events import START
from yehu_server.core.stage.record import STAGE
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.tables import Controls

Array = Any

# A run is worth its two words of heading only beyond a gap as long as that.
SHORTEST_GAP = 3


def image(rate: float) -> Array:
    """Make the image of a calibrated instrument at a rate (Hz), ready to play as `serve` begins.

    It has the default mapping, in equal temperament; program changes are ignored. Returns runs
    [dtype=int64]: first word, number of words, the words; again; to the end.
    """
    memory, playing = bytearray(memory_bytes(1)), PlayingOptions()
    spec = playing.spec(rate, calibration_for(rate))
    first = Ensemble([spec], memory=memory, is_live=True).first
    first.begin_part(playing.tables(Controls()))
    first.tables["program_row"] = 0.0  # not read, as there are no programs
    first.post(START)
    np.frombuffer(memory, STAGE, offset=RIG_BYTES)["taping"] = 0
    words = np.frombuffer(memory, np.int64)
    # No run goes beyond the record of the part, which `reset` leaves as it is.
    ends = [0, MIDI_AT // WORD, HEAP_AT // WORD, len(words)]
    parts = (runs(words[begin:end], begin) for begin, end in pairwise(ends))
    return np.concatenate([np.zeros(0, np.int64), *chain.from_iterable(parts)])


def runs(words: Array, begin: int = 0) -> Iterable[Array]:
    """The runs of words of a record [dtype=int64] that are not zero, each with its heading.

    `begin`: number of the first of these words in the record.
    """
    places = np.flatnonzero(words)
    for run in np.split(places, np.flatnonzero(np.diff(places) > SHORTEST_GAP) + 1):
        if len(run):
            first, count = int(run[0]), int(run[-1] - run[0] + 1)
            yield np.array([begin + first, count, *words[first : first + count]], np.int64)
