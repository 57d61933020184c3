"""Numbers of the engine's parameters in the arrays of the controls."""

from __future__ import annotations

import numpy as np

from yehu_server.params.table import ENGINE, FINGERS, SLOT, STRING_NAMES

SPEED, SIDE = SLOT["/bow/speed"], SLOT["/bow/side"]
FORCE, SHARE, ASSIST = SLOT["/bow/force"], SLOT["/bow/pressure"], SLOT["/bow/assist"]
TREMOLO_DEPTH = SLOT["/bow/tremolo_depth"]
POSITION, TREMOLO = SLOT["/bow/position"], SLOT["/bow/tremolo"]
FINGER_POSITION = np.array([SLOT[f"/finger/{number}/position"] for number in FINGERS])
FINGER_PRESS = np.array([SLOT[f"/finger/{number}/press"] for number in FINGERS])
DEPTH, VIBRATO_PRESS = SLOT["/vibrato/depth"], SLOT["/vibrato/press"]
RATE, ONSET = SLOT["/vibrato/rate"], SLOT["/vibrato/onset"]
UPWARD = SLOT["/vibrato/upward"]
PLUCK, PLUCK_POSITION = SLOT["/pluck/force"], SLOT["/pluck/position"]
GAIN, LEVEL = SLOT["/output/gain"], SLOT["/output/level"]
BALANCE, BLEND = SLOT["/output/balance"], SLOT["/body/blend"]
BODY, LIMITER = SLOT["/body/gain"], SLOT["/output/limiter"]
TUNING = np.array([SLOT[f"/string/{name}/tuning"] for name in STRING_NAMES])
LOSS = np.array([SLOT[f"/string/{name}/loss"] for name in STRING_NAMES])
NOISE = SLOT["/bow/noise"]
BRILLIANCE, SWAY = SLOT["/body/brilliance"], SLOT["/body/sway"]
BRILLIANCE_FREQUENCY = SLOT["/body/brilliance_frequency"]
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
