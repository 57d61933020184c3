"""Numbers of the engine's parameters in the arrays of the controls."""

from collections.abc import Mapping
from types import ModuleType

import numpy as np

from yehu_server.params.table import ENGINE, FINGERS, SLOT, STRING_NAMES


def constants(numbers: Mapping[str, int], prefix: str = "/") -> ModuleType:
    """Numbers by the rest of their addresses after a prefix, with underscores for slashes.

    Of a module, as its attributes are constants in compiled code.
    """
    found = ModuleType(prefix)
    for address, number in numbers.items():
        if address.startswith(prefix):
            setattr(found, address.removeprefix(prefix).replace("/", "_"), number)
    return found


SLOTS = constants(SLOT)  # such as SLOTS.bow_speed
FINGER_POSITION = np.array([SLOT[f"/finger/{number}/position"] for number in FINGERS])
FINGER_PRESS = np.array([SLOT[f"/finger/{number}/press"] for number in FINGERS])
TUNING = np.array([SLOT[f"/string/{name}/tuning"] for name in STRING_NAMES])
LOSS = np.array([SLOT[f"/string/{name}/loss"] for name in STRING_NAMES])
# What the stage needs of a player with each sample, and the columns that it is in.
STAGE_INPUTS = np.array([
    SLOT[f"/{name}"]
    for name in (
        "room/size", "room/decay", "room/damping", "room/level", "room/distance", "room/pan",
        "body/width",
    )
])  # fmt: skip
SIZE_NOW, DECAY_NOW, DAMPING_NOW, LEVEL_NOW, DISTANCE_NOW, PAN_NOW, WIDTH_NOW = range(7)
SLOT_COUNT = len(ENGINE)
LOWER_BOUNDS = np.array([param.lo for param in ENGINE])
UPPER_BOUNDS = np.array([param.hi for param in ENGINE])
SILENCE = SLOT_COUNT  # in place of a slot: fades the sound out and puts the model to rest
