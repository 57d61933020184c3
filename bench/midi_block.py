"""What a block takes for which 1,000 MIDI messages come: each block's own CPU time.

    .venv/bin/python bench/midi_block.py [--blocks 200] [--save bench/results/NAME.json]

Blocks of 128 frames at 48 kHz, with a note that sounds and the default mapping. What a block
cannot do of its messages waits for the next; how many blocks that lasts is counted. The CPU time is
that of this thread, which leaves out most of what else the machine does.
"""

from __future__ import annotations

import argparse
import random
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import report

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.midi.events import MESSAGE, START
from yehu_server.core.midi.packing import packed
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.tables import Controls

RATE, BLOCK, MESSAGES = 48000.0, 128, 1000
BETWEEN = 20  # blocks
HELD = (0x90, 74, 90)  # the note that sounds
Message = Sequence[int]
KINDS: dict[str, Callable[[random.Random], Message]] = {
    "notes": lambda chance: (chance.choice([0x80, 0x90]), chance.randint(65, 89), 90),
    "controllers": lambda chance: (0xB0, chance.choice([1, 7, 11, 74, 77]), chance.randrange(128)),
    "bends": lambda chance: (0xE0, chance.randrange(128), chance.randrange(128)),
    "programs": lambda chance: (0xC0, chance.randrange(10)),
    "MPE zones": lambda chance: (
        *chance.choice([(0xB0, 101, 0), (0xB0, 100, 6), (0xB0, 6, 15), (0xB0, 6, 0)]),
    ),
    "system resets": lambda _chance: (0xFF,),
    "of 16 channels": lambda chance: (
        chance.choice([0x80, 0x90, 0xA0, 0xB0, 0xE0]) | chance.randrange(16),
        chance.choice([1, 6, 7, 11, 38, 64, 74, 98, 99, 100, 101, 121, 123]),
        chance.randrange(128),
    ),
}


class Player:
    """Plays one note, and what comes with it."""

    def __init__(self) -> None:
        playing = replace(PlayingOptions(), programs=True)
        self._ensemble = Ensemble([playing.spec(RATE, calibration_for(RATE))], is_live=True)
        self._first = self._ensemble.first
        self._first.begin_part(playing.tables(Controls()))
        self._first.post(START)
        self._out = np.zeros((BLOCK, 2), np.float32)

    def post(self, message: Message) -> None:
        """Send a message for the next block."""
        if not self._first.post(MESSAGE, index=packed(message)):
            raise RuntimeError("the ring is full")

    def block(self) -> float:
        """Play a block; return its CPU time (s)."""
        start = time.thread_time_ns()
        self._ensemble.process(self._out)
        return 1e-9 * (time.thread_time_ns() - start)

    @property
    def waits(self) -> bool:
        """Whether events or wishes wait: in the ring, or in a heap."""
        meters = self._first.meters()
        return bool(meters["drained"] < self._first.posted or meters["waiting"] > 0)


def costs(player: Player, kind: str, blocks: int) -> dict[str, float]:
    """Play some blocks with 1,000 messages of a kind each, and others between them."""
    chance = random.Random(1)  # noqa: S311 - for music, not secrets
    without, with_messages, lasted = [], [], 0
    for number in range(blocks):
        player.post((0xB0, 123, 0))
        player.post(HELD)
        times = [player.block() for _ in range(BETWEEN)]
        without += times[BETWEEN // 2 :]
        for _ in range(MESSAGES):
            player.post(KINDS[kind](chance))
        times = [player.block()]
        while player.waits:
            times.append(player.block())
        if number > 0:  # the first has to fetch code and tables
            with_messages.append(max(times))
            lasted = max(lasted, len(times))
    return {
        "us, median without": 1e6 * float(np.median(without)),
        "worst without": 1e6 * max(without),
        "median": 1e6 * float(np.median(with_messages)),
        "worst": 1e6 * max(with_messages),
        "ratio of medians": float(np.median(with_messages) / np.median(without)),
        "blocks until all is done": lasted,
    }


def measure(arguments: argparse.Namespace) -> dict[str, dict[str, float]]:
    print(f"a block has {1e6 * BLOCK / RATE:.0f} us; its CPU time:")
    player = Player()
    return {kind: costs(player, kind, arguments.blocks) for kind in KINDS}


if __name__ == "__main__":
    report.run(__doc__, measure, blocks=(200, "with messages, of each kind"))
