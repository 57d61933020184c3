"""From player-level targets to one row of physical controls a sample. Compiled.

What must go on while Python is busy happens here, on absolute frames: ramps, bow force
following bow speed, the bow keeping its relative position as the string gets shorter,
the hand leaving the strings when a finger is up.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.params.table import ENGINE, SLOT
from yehu_server.physics.layout import F_HAMMER, F_N, FINGER_CONTROLS, STRINGS, V_B, X_B
from yehu_server.physics.quantities import Quantities

Array = Any

SPEED, SIDE = SLOT["/bow/speed"], SLOT["/bow/side"]
FORCE, SHARE, ASSIST = SLOT["/bow/force"], SLOT["/bow/pressure"], SLOT["/bow/assist"]
POSITION = SLOT["/bow/position"]
FINGER, PRESS = SLOT["/finger/1/position"], SLOT["/finger/1/press"]
FULL_SCALE_PRESSURE = 1.0  # Pa at full scale with no gain. By ear.
GAIN, LEVEL = SLOT["/output/gain"], SLOT["/output/level"]
BALANCE, BLEND = SLOT["/output/balance"], SLOT["/body/blend"]
SLOTS = len(ENGINE)
SILENCE = SLOTS  # an event at this index fades the sound out and puts the model to rest

# While a finger is up it waits near the loop, where the strings hardly move: at its
# rest height over the middle of a string it would be hit by it. By ear.
PARK_X = 0.012  # m
PARK_AFTER_S = 0.03
# A fast bow needs a larger share of Schelleng's limit, or notes jump to the octave. Measured
# over F4 to F6: shares from 0.35 hold at 0.12 m/s, from 0.5 at 0.2, from 0.75 at 0.3.
FAST_SHARE, FAST = 0.6, 0.35  # m/s
FOLLOW_S = 0.01  # how fast the bow follows the sounding length

GESTURE = np.dtype(
    [
        ("frame", np.int64),  # of the next sample
        ("value", np.float64, SLOTS),
        ("target", np.float64, SLOTS),
        ("slope", np.float64, SLOTS),
        ("remaining", np.int64, SLOTS),
        ("sounding_from", np.float64),  # m; where the sounding length begins
        ("finger_up", np.int64),  # frames since the finger was lifted
        ("follow", np.float64),
        ("park_after", np.int64),
        ("bridge_x", np.float64),
        # 2 Z / (mu_S - mu_C) of each string: Schelleng's upper limit is this v / beta.
        ("schelleng", np.float64, STRINGS),
        ("silence_in", np.int64),  # frames until the model is put to rest; 0: not asked
    ],
    align=True,
)


def prepare_gesture(quantities: Quantities, rate: float) -> Any:
    """Every parameter at its default. Returns: ndarray [shape=(1,), dtype=GESTURE]."""
    gesture = np.zeros(1, GESTURE)
    defaults = [param.default for param in ENGINE]
    gesture["value"][0] = gesture["target"][0] = defaults
    gesture["follow"] = 1.0 - math.exp(-1.0 / (FOLLOW_S * rate))
    gesture["park_after"] = round(PARK_AFTER_S * rate)
    gesture["finger_up"] = gesture["park_after"]
    gesture["bridge_x"] = quantities.bridge_x
    grip = quantities.bow.mu_S - quantities.bow.mu_C
    for i, string in enumerate(quantities.strings):
        impedance = math.sqrt(string.T * string.rho_A)
        gesture["schelleng"][0, i] = 2.0 * impedance / max(grip, 1e-3)
    return gesture


def settle(gesture: Any) -> None:
    """Let a record of dtype GESTURE be where it is bound, with nothing on its way; in place."""
    gesture["value"] = gesture["target"]
    gesture["remaining"] = 0
    gesture["silence_in"] = 0
    is_down = gesture["value"][PRESS] > 0.0
    gesture["finger_up"] = 0 if is_down else gesture["park_after"]
    gesture["sounding_from"] = gesture["value"][FINGER] if is_down else 0.0


@compiled
def take(g: Any, index: int, target: float, ramp: int, silence_frames: int) -> None:
    """Apply one event: set a parameter going towards its target. Real time: safe."""
    if index == SILENCE:
        if g.silence_in == 0:
            g.silence_in = silence_frames
        return
    if index < 0 or index >= SLOTS:
        return
    g.target[index] = target
    if ramp <= 0:
        g.value[index] = target
        g.remaining[index] = 0
    else:
        g.slope[index] = (target - g.value[index]) / ramp
        g.remaining[index] = ramp


@compiled
def move(g: Any) -> None:
    """Let every parameter take one step of its ramp, ending exactly on its target."""
    for index in range(SLOTS):
        if g.remaining[index] > 0:
            g.remaining[index] -= 1
            if g.remaining[index] == 0:
                g.value[index] = g.target[index]
            else:
                g.value[index] += g.slope[index]


@compiled
def level(g: Any) -> float:
    """Amplitude at full scale of one pascal at this frame."""
    gain_db = g.value[GAIN] + g.value[BALANCE]
    return float(g.value[LEVEL] * 10.0 ** (gain_db / 20.0) / FULL_SCALE_PRESSURE)


@compiled
def write_controls(g: Any, control: Array) -> None:
    """Turn the parameters of this frame into the kernel's controls.

    Bow force is assist * share * F_max + (1 - assist) * force, with Schelleng's
    F_max = 2 Z v_b / (beta (mu_S - mu_C)) [Schelleng] and a share of it that is the
    pressure and a little more for a fast bow; the side fades it in and out.
    """
    press = g.value[PRESS]
    g.finger_up = 0 if press > 0.0 else g.finger_up + 1
    stop = g.value[FINGER] if press > 0.0 else 0.0
    g.sounding_from += g.follow * (stop - g.sounding_from)

    speed, beta, side = g.value[SPEED], g.value[POSITION], g.value[SIDE]
    string = 0 if side >= 0.0 else 1
    limit = g.schelleng[string] * abs(speed) / beta
    assist = g.value[ASSIST]
    share = g.value[SHARE] + FAST_SHARE * min(1.0, (speed / FAST) ** 2)
    force = assist * share * limit + (1.0 - assist) * g.value[FORCE]
    control[F_N] = side * force
    control[V_B] = speed
    control[X_B] = g.bridge_x - beta * (g.bridge_x - g.sounding_from)
    control[F_HAMMER] = 0.0
    parked = g.finger_up >= g.park_after
    control[FINGER_CONTROLS] = PARK_X if parked else g.value[FINGER]
    control[FINGER_CONTROLS + 1] = press
