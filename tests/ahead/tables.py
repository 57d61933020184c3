"""Tables by chance, right and wrong.

Run as a program it plays random messages through those that are taken: without the JIT, in plain
Python.
"""

import json
import math
import random
import sys
from pathlib import Path

import numpy as np
from interpreted import Leader
from live.page import streams

from yehu_server.ahead.table_checks import CHECKS
from yehu_server.core.midi import events
from yehu_server.core.midi.packing import packed
from yehu_server.core.midi.tables import (
    KEY_COUNT,
    MAX_BINDS,
    MAX_POINTS,
    PROGRAM_COUNT,
    TABLE_SLOTS,
    TABLES,
)
from yehu_server.core.player.parameter_indices import PARAMETER_COUNT
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, RangePolicy, read_tuning

TUNINGS = (EQUAL, read_tuning(Path("chaozhou-seven-equal")))
WILD = (math.nan, math.inf, -math.inf, 1e308, -1e308, 1e-310, -1.0, 0.5, 1e9)
ENDS = (PARAMETER_COUNT, KEY_COUNT, MAX_BINDS, MAX_POINTS, 1 << 16)  # of arrays, and of channels
USED = [name for name in TABLES.names or () if name not in ("x", "y")]
MESSAGES = 12


def some_tables(seed: int, count: int) -> list[np.ndarray]:
    """Right tables of any mappings, tunings and policies, some with programs."""
    chance, controls, programs = random.Random(seed), Controls(), Presets().programs()
    return [
        make_tables(
            streams.some_mapping(chance, "some"),
            controls,
            tuning=chance.choice(TUNINGS),
            a4=chance.uniform(390.0, 480.0),
            policy=chance.choice([*RangePolicy]),
            received=chance.choice([None, None, None, {0, 9}]),
            programs=chance.choice([programs, None]),
        )
        for _ in range(count)
    ]


def spoilt(chance: random.Random, tables: np.ndarray) -> np.ndarray:
    """Tables with some other numbers, mostly where they are used."""
    made = tables.copy()
    for _ in range(chance.choice([0, 1, 1, 2, 3])):
        field = made[chance.choice(USED)].reshape(-1)
        place = chance.randrange(min(len(field), chance.choice([8, len(field)])))
        other = chance.choice(field.tolist())
        field[place] = chance.choice([*WILD, *ENDS, other, other, chance.randrange(20)])
    return made


def are_right(tables: np.ndarray) -> bool:
    """Whether `yehu_use_tables` takes tables."""
    return all(check.call(tables.ctypes.data) for check in CHECKS)


def message(chance: random.Random) -> int:
    """A channel message."""
    status = chance.choice([0x80, 0x90, 0x90, 0xA0, 0xB0, 0xB0, 0xC0, 0xD0, 0xE0])
    first = chance.choice([*streams.LISTENED, chance.randrange(128)])
    data = [status | chance.choice([0, 0, 1, 9, 15]), first, chance.randrange(128)]
    return packed(data[: 2 if status in (0xC0, 0xD0) else 3], chance.choice([0, 0, 1]))


def play(count: int) -> dict[str, int]:
    """Play messages through one after another of random tables; count what came of it."""
    chance, leader, counts = random.Random(2), Leader(), {"taken": 0, "refused": 0, "commands": 0}
    right = some_tables(3, 30)
    leader.begin_part(right[0])
    for _ in range(count):
        tables = spoilt(chance, chance.choice(right))
        if not are_right(tables):
            counts["refused"] += 1
            continue
        counts["taken"] += 1
        slot = (int(leader.midi["tables"]) + 1) % TABLE_SLOTS
        leader.tables[slot] = tables[0]
        posted = [(events.TABLES_TO, slot, 0.0), (events.START, 0, float(chance.randrange(2)))]
        posted += [(events.MESSAGE, message(chance), 0.0) for _ in range(MESSAGES)]
        posted += [(events.CONTROL, n, chance.uniform(-1e9, 1e9)) for n in range(2)]
        posted += [(events.MESSAGE, packed([0xC0, chance.randrange(PROGRAM_COUNT)]), 0.0)]
        for frame, event in enumerate(posted):
            found = leader.interpret(frame, *event, 0.0)
            assert np.isfinite([command[2:] for command in found]).all(), (tables, event, found)
            counts["commands"] += len(found)
        assert np.isfinite(leader.midi["value"]).all()
    return counts


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    Path(sys.argv[2]).write_text(json.dumps(play(int(sys.argv[1]))))
