"""The record of the controls: each parameter's value and ramp, and what moves with them."""

import math
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np

from yehu_server.core.controls.ramps import GAIN_COUNT, pole_of_time
from yehu_server.core.controls.slots import (
    FINGER_POSITION,
    FINGER_PRESS,
    LOSS,
    SLOT_COUNT,
    SLOTS,
    TUNING,
    UPPER_BOUNDS,
)
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.layout import MAX_FINGERS, STRINGS
from yehu_server.core.physics.lobes import DIRECTIONS
from yehu_server.params.table import ENGINE

PARK_AFTER_S = 0.04  # a finger waits so long where it was lifted
LET_GO_S = 0.3e-3  # time in which a plucked string slips off the fingertip
FOLLOW_S = 0.01  # time constant with which the bow follows the sounding length
FADE_S = 0.005
CHUNK = 64  # most frames whose controls are computed before the kernel computes them
FORWARD = 0.25  # phase of the tremolo (turns) at which the bow has its own direction

# Drifts of the hands: factors less 1 on the bow's speed, its force and its distance from the
# bridge; cents by which the fingers are too high; a factor less 1 on their force.
SPEED_DRIFT, FORCE_DRIFT, POSITION_DRIFT, CENTS_DRIFT, PRESS_DRIFT = range(5)
DRIFT_COUNT = 5

CONTROLS = np.dtype(
    [
        ("frame", np.int64),  # of the next sample
        ("value", np.float64, SLOT_COUNT),
        ("target", np.float64, SLOT_COUNT),
        ("slope", np.float64, SLOT_COUNT),
        ("remaining", np.int64, SLOT_COUNT),
        # Slots on a ramp, in any order; whether each slot is among them.
        ("moving", np.int64, SLOT_COUNT),
        ("moving_count", np.int64),
        ("is_moving", np.int64, SLOT_COUNT),
        ("decibels", np.float64, GAIN_COUNT),  # the gains, and their amplitude factors
        ("factor", np.float64, GAIN_COUNT),
        # of each string as calibrated (N, 1/s, m^2/s); its tuning (cents) and loss now
        ("tension", np.float64, STRINGS),
        ("sigma_0", np.float64, STRINGS),
        ("sigma_1", np.float64, STRINGS),
        ("tuning", np.float64, STRINGS),
        ("loss", np.float64, STRINGS),
        # Side and speed of the bow when it last did not go from one string to the other.
        ("side_before", np.float64),
        ("speed_before", np.float64),
        ("bow_displacement", np.float64),  # along the hair, of the point on the string (m)
        # The hands' drift, its change in a sample, whether there is any, and what follows of it:
        # factors on the sounding length and on the bow's distance from the bridge.
        ("drift", np.float64, DRIFT_COUNT),
        ("drift_slope", np.float64, DRIFT_COUNT),
        ("drifting", np.int64),
        ("swell", np.float64),  # a factor less 1 on the level, and its change in a sample
        ("swell_slope", np.float64),
        # How far the body is turned into the directions of ``physics.lobes``; the same of it.
        ("turned", np.float64, DIRECTIONS),
        ("turned_slope", np.float64, DIRECTIONS),
        ("sounding_drift", np.float64),
        ("position_drift", np.float64),
        ("sounding_from", np.float64),  # m; end of the sounding length, from the loop
        ("finger_up", np.int64, MAX_FINGERS),  # frames since each finger was lifted
        ("rate", np.float64),  # of samples (Hz)
        ("fade", np.int64),  # length of a fade to silence (frames)
        ("vibrato_rate_factor", np.float64),  # of this cycle of the vibrato
        ("vibrato_depth_factor", np.float64),
        ("vibrato", np.float64),  # phases of vibrato and tremolo (turns)
        ("tremolo", np.float64),
        ("follow", np.float64),
        ("park_after", np.int64),
        ("bridge_x", np.float64),
        ("upper_bounds", np.float64, SLOT_COUNT),  # of parameters on this instrument
        # 2 Z / (mu_S - mu_C) of each string; times v_b / beta it is Schelleng's upper limit.
        ("schelleng", np.float64, STRINGS),
        ("let_go", np.int64),  # frames
        ("silence_in", np.int64),  # frames until the model is put to rest; 0: not to be
    ],
    align=True,
)
Controls = Annotated[Any, CONTROLS]


def prepare_controls(quantities: Quantities, rate: float, values: Mapping[str, float]) -> Any:
    """A record of CONTROLS [shape=(1,)] at a rate (Hz) with all parameters' values, by address."""
    controls = np.zeros(1, CONTROLS)
    controls["value"][0] = controls["target"][0] = [values[param.address] for param in ENGINE]
    controls["factor"] = 1.0  # of 0 dB
    controls["follow"] = 1.0 - pole_of_time(FOLLOW_S, rate)
    controls["park_after"] = round(PARK_AFTER_S * rate)
    controls["finger_up"] = controls["park_after"]
    controls["rate"] = rate
    controls["fade"] = max(1, round(FADE_S * rate))
    controls["let_go"] = max(1, round(LET_GO_S * rate))
    clear_motion(controls)
    controls["bridge_x"] = quantities.bridge_x
    controls["upper_bounds"] = UPPER_BOUNDS
    # The bound is for a yehu; on longer strings fingers reach proportionally farther.
    controls["upper_bounds"][:, FINGER_POSITION] *= quantities.bridge_x / Quantities().bridge_x
    friction_drop = quantities.bow.mu_S - quantities.bow.mu_C
    for i, string in enumerate(quantities.strings):
        impedance = math.sqrt(string.T * string.rho_A)
        controls["schelleng"][0, i] = 2.0 * impedance / max(friction_drop, 1e-3)
        controls["tension"][0, i] = string.T
        controls["sigma_0"][0, i], controls["sigma_1"][0, i] = string.sigma_0, string.sigma_1
    controls["tuning"] = controls["value"][:, TUNING]
    controls["loss"] = controls["value"][:, LOSS]
    return controls


def jump_to_targets(controls: Any) -> None:
    """Jump to the targets of all parameters of a record of dtype CONTROLS, in place."""
    controls["target"][SLOTS.pluck_force] = 0.0
    controls["value"] = controls["target"]
    controls["remaining"] = 0
    controls["moving_count"], controls["is_moving"] = 0, 0
    controls["silence_in"] = 0
    is_down = controls["value"][FINGER_PRESS] > 0.0
    controls["finger_up"] = np.where(is_down, 0, controls["park_after"])
    controls["sounding_from"] = controls["value"][FINGER_POSITION][is_down].max(initial=0.0)
    clear_motion(controls)


def clear_motion(controls: Any) -> None:
    """Stop drift, vibrato and tremolo in a record of dtype CONTROLS, in place."""
    controls["tremolo"] = FORWARD
    controls["vibrato"], controls["bow_displacement"] = 0.0, 0.0
    controls["vibrato_rate_factor"] = controls["vibrato_depth_factor"] = 1.0
    controls["drift"], controls["drift_slope"], controls["drifting"] = 0.0, 0.0, 0
    controls["swell"] = controls["swell_slope"] = 0.0
    controls["turned"] = controls["turned_slope"] = 0.0
    controls["sounding_drift"] = controls["position_drift"] = 1.0
