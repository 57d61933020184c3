"""The record of the stage: the room, the buses of the mix, its level, and the tape."""

from typing import Any

import numpy as np

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.stage.late_field import LATE_FIELD, empty_room, prepare_room
from yehu_server.core.stage.room_geometry import EARS

TAPE = 1 << 19  # the last frames, for recorders: 10 s at 48 kHz
BUSES = 6
# Columns, for both ears: the direct sound, what enters the room, what is reflected at once.
DIRECT, SEND, EARLY = 0, 2, 4

STAGE = np.dtype(
    [
        ("has_room", np.int64),  # 0: dry
        ("channels", np.int64),  # of the device: left and right in turn, or one with both
        ("taping", np.int64),  # 0: there is no tape, which need not have memory then
        (
            "invalid_samples",
            np.int64,
        ),  # number of frames that were not numbers, replaced by silence
        ("bus", np.float64, (CHUNK, BUSES)),
        ("own", np.float64, (CHUNK, EARS)),  # what one of the sources gives
        ("silenced_at", np.int64),  # row of `bus` at which an instrument is put to rest first
        # Level of the mix, over windows of a sixtieth of a second, as in the meters.
        ("window_frames", np.int64),
        ("window_peak", np.float64),
        ("window_power", np.float64),
        ("peak", np.float64),
        ("rms", np.float64),
        ("room", LATE_FIELD),
        ("tape", np.float32, (TAPE, EARS)),
    ],
    align=True,
)
_fields: Any = STAGE.fields
TAPE_AT = int(_fields["tape"][1])  # it is the last field


def prepare_stage(stage: Any, rate: float, channels: int, *, has_room: bool) -> None:
    """Prepare a record of dtype STAGE [shape=()] for a rate (Hz), in place; it is zeroed before."""
    stage["channels"], stage["has_room"], stage["taping"] = channels, has_room, 1
    prepare_room(stage["room"], rate)


def clear_stage(stage: Any) -> None:
    """Take all sound out of a record of dtype STAGE, in place."""
    empty_room(stage["room"])
