"""Indices of the parameters in the player's arrays: their places in ``params.table.TABLE``."""

import numpy as np

from yehu_server.core.controls.slots import constants
from yehu_server.params.spec import Place
from yehu_server.params.table import FINGERS, SLOT, TABLE

INDEX = {param.address: index for index, param in enumerate(TABLE)}
PARAMETER_COUNT = len(TABLE)
SLOT_OF = np.array([SLOT.get(param.address, -1) for param in TABLE])  # -1: not the engine's
IS_PLAYER_CONTROLLED = np.array([param.player_controlled for param in TABLE])
IS_ENGINES = np.array([param.place is Place.ENGINE for param in TABLE])
LOWER_BOUNDS, UPPER_BOUNDS = (
    np.array([param.lo for param in TABLE]),
    np.array([param.hi for param in TABLE]),
)
SMOOTH_MS = np.array([param.smooth_ms for param in TABLE])

FINGER_COUNT = len(FINGERS)
FINGER_POSITION = np.array([INDEX[f"/finger/{number}/position"] for number in FINGERS])
FINGER_PRESS = np.array([INDEX[f"/finger/{number}/press"] for number in FINGERS])

# Of those whose addresses begin so, by what follows, such as BOW.speed. What is requested of the
# player is under /playing; most of the others, it moves.
BODY, BOW, ENGINE, OUTPUT, PLAYING, PLUCK, VIBRATO = (
    constants(INDEX, f"/{group}/")
    for group in ("body", "bow", "engine", "output", "playing", "pluck", "vibrato")
)
