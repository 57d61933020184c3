"""The controls of bow, fingers and pluck at each sample, from the player's targets. Compiled.

What depends on the frame is done here and not in Python: parameters move along ramps, the bow
force follows the bow's speed, the bow keeps its relative position as the sounding length changes,
vibrato and tremolo oscillate, and a lifted finger moves away.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.engine.one_pole import one_pole, pole_of_cutoff, pole_of_time
from yehu_server.jit import compiled
from yehu_server.params.table import ENGINE, FINGERS, SLOT, STRING_NAMES
from yehu_server.physics.layout import (
    CONTROLS_PER_FINGER,
    F_HAMMER,
    F_N,
    F_PLUCK,
    FINGER_CONTROLS,
    MAX_FINGERS,
    STRINGS,
    V_B,
    X_B,
    X_PLUCK,
)
from yehu_server.physics.quantities import Quantities

Array = Any

SPEED, SIDE = SLOT["/bow/speed"], SLOT["/bow/side"]
FORCE, SHARE, ASSIST = SLOT["/bow/force"], SLOT["/bow/pressure"], SLOT["/bow/assist"]
POSITION, TREMOLO = SLOT["/bow/position"], SLOT["/bow/tremolo"]
FINGER_POSITION = np.array([SLOT[f"/finger/{number}/position"] for number in FINGERS])
FINGER_PRESS = np.array([SLOT[f"/finger/{number}/press"] for number in FINGERS])
DEPTH, ROCK = SLOT["/vibrato/depth"], SLOT["/vibrato/press"]
RATE, ONSET = SLOT["/vibrato/rate"], SLOT["/vibrato/onset"]
PLUCK, PLUCK_POSITION = SLOT["/pluck/force"], SLOT["/pluck/position"]
FULL_SCALE_PRESSURE = 1.0  # Pa at full scale with no gain. By ear.
GAIN, LEVEL = SLOT["/output/gain"], SLOT["/output/level"]
BALANCE, BLEND = SLOT["/output/balance"], SLOT["/body/blend"]
BODY, LIMITER = SLOT["/body/gain"], SLOT["/output/limiter"]
TUNING = np.array([SLOT[f"/string/{name}/tuning"] for name in STRING_NAMES])
LOSS = np.array([SLOT[f"/string/{name}/loss"] for name in STRING_NAMES])
NOISE = SLOT["/bow/noise"]
SLOTS = len(ENGINE)
LOWEST = np.array([param.lo for param in ENGINE])
HIGHEST = np.array([param.hi for param in ENGINE])
SILENCE = SLOTS  # index of the event that fades the sound out and puts the model to rest

# A lifted finger waits near the loop, where the strings hardly move: over the middle of a string
# that swings wide it would be hit. By ear.
PARK_X = 0.012  # m
PARK_AFTER_S = 0.04
# A fast bow needs a larger share of Schelleng's limit, or notes jump to the octave. Measured from
# F4 to F6: the least share that holds is 0.35 at 0.12 m/s, 0.5 at 0.2 m/s, 0.75 at 0.3 m/s.
FAST_SHARE, FAST = 0.6, 0.35  # m/s
LET_GO_S = 0.3e-3  # time in which a plucked string slips off the fingertip
FOLLOW_S = 0.01  # time constant with which the bow follows the sounding length
ONSET_FROM = 0.4  # of /vibrato/onset, below which there is no vibrato
# In tremolo the bow's speed is a sine times this, clipped to -1..1: mostly full speed.
TURN = 3.0
LAST_STROKES = 12.0  # strokes a second that bring the bow back to its direction when tremolo ends

GRAIN_HZ = 2000.0  # cutoff of the noise in the hair's grip. By ear.

FORWARD = 0.25  # phase of the tremolo (turns) at which the bow has its own direction

TO_OUTPUT, TO_BODY, TO_LIMITER = range(3)  # gains that are set in decibels
DECIBELS = 3

CONTROLS = np.dtype(
    [
        ("frame", np.int64),  # of the next sample
        ("value", np.float64, SLOTS),
        ("target", np.float64, SLOTS),
        ("slope", np.float64, SLOTS),
        ("remaining", np.int64, SLOTS),
        ("moving", np.int64),  # number of parameters on a ramp
        ("decibels", np.float64, DECIBELS),  # the gains, and their amplitude factors
        ("factor", np.float64, DECIBELS),
        # of each string as calibrated (N, 1/s, m^2/s); its tuning (cents) and loss now
        ("tension", np.float64, STRINGS),
        ("sigma_0", np.float64, STRINGS),
        ("sigma_1", np.float64, STRINGS),
        ("tuning", np.float64, STRINGS),
        ("loss", np.float64, STRINGS),
        ("grain", np.float64),  # noise of the grip: its value, one-pole coefficient, amplitude
        ("grain_follow", np.float64),
        ("grain_size", np.float64),
        ("sounding_from", np.float64),  # m; end of the sounding length, from the loop
        ("finger_up", np.int64, MAX_FINGERS),  # frames since each finger was lifted
        ("second", np.float64),  # in frames: the sample rate
        ("vibrato", np.float64),  # phases of vibrato and tremolo (turns)
        ("tremolo", np.float64),
        ("follow", np.float64),
        ("park_after", np.int64),
        ("bridge_x", np.float64),
        # 2 Z / (mu_S - mu_C) of each string; times v_b / beta it is Schelleng's upper limit.
        ("schelleng", np.float64, STRINGS),
        ("let_go", np.int64),  # frames
        ("silence_in", np.int64),  # frames until the model is put to rest; 0: not to be
    ],
    align=True,
)


def prepare_controls(quantities: Quantities, rate: float) -> Any:
    """Prepare the record, with every parameter at its default.

    Parameters
    ----------
    rate : float, Hz

    Returns
    -------
    ndarray [shape=(1,), dtype=CONTROLS]
    """
    controls = np.zeros(1, CONTROLS)
    defaults = [param.default for param in ENGINE]
    controls["value"][0] = controls["target"][0] = defaults
    controls["factor"] = 1.0  # of 0 dB
    controls["follow"] = 1.0 - pole_of_time(FOLLOW_S, rate)
    controls["park_after"] = round(PARK_AFTER_S * rate)
    controls["finger_up"] = controls["park_after"]
    controls["second"] = rate
    controls["let_go"] = max(1, round(LET_GO_S * rate))
    controls["tremolo"] = FORWARD
    controls["bridge_x"] = quantities.bridge_x
    grip = quantities.bow.mu_S - quantities.bow.mu_C
    for i, string in enumerate(quantities.strings):
        impedance = math.sqrt(string.T * string.rho_A)
        controls["schelleng"][0, i] = 2.0 * impedance / max(grip, 1e-3)
        controls["tension"][0, i] = string.T
        controls["sigma_0"][0, i], controls["sigma_1"][0, i] = string.sigma_0, string.sigma_1
    controls["tuning"] = controls["value"][:, TUNING]
    controls["loss"] = controls["value"][:, LOSS]
    follow = 1.0 - pole_of_cutoff(GRAIN_HZ, rate)
    controls["grain_follow"] = follow
    # Uniform noise in -1..1 gets a standard deviation of 1/3 after the filter: it rarely exceeds 1.
    controls["grain_size"] = math.sqrt((2.0 - follow) / (3.0 * follow))
    return controls


def settle(controls: Any) -> None:
    """Move all parameters of a record of dtype CONTROLS to their targets, in place."""
    controls["target"][PLUCK] = 0.0
    controls["value"] = controls["target"]
    controls["remaining"] = 0
    controls["moving"] = 0
    controls["silence_in"] = 0
    is_down = controls["value"][FINGER_PRESS] > 0.0
    controls["finger_up"] = np.where(is_down, 0, controls["park_after"])
    controls["sounding_from"] = controls["value"][FINGER_POSITION][is_down].max(initial=0.0)
    controls["tremolo"] = FORWARD


@compiled
def take(c: Any, index: int, target: float, ramp: int, silence_frames: int) -> None:
    """Apply an event: begin a parameter's ramp to a target, clamped to its range.

    A target that is not a number is ignored. Real time: safe.

    Parameters
    ----------
    index : int
        Slot of the parameter, or SILENCE.
    ramp, silence_frames : int
        Length of the ramp, and of the fade before silence (frames).
    """
    if index == SILENCE:
        if c.silence_in == 0:
            c.silence_in = silence_frames
        return
    if index < 0 or index >= SLOTS or math.isnan(target):
        return
    target = min(max(target, LOWEST[index]), HIGHEST[index])
    c.target[index] = target
    c.moving -= 1 if c.remaining[index] > 0 else 0
    if ramp <= 0:
        c.value[index] = target
        c.remaining[index] = 0
    else:
        c.slope[index] = (target - c.value[index]) / ramp
        c.remaining[index] = ramp
        c.moving += 1


@compiled
def move(c: Any) -> None:
    """Advance all ramps by one sample; each ends exactly on its target. Real time: safe."""
    if c.moving == 0:
        return
    for index in range(SLOTS):
        if c.remaining[index] > 0:
            c.remaining[index] -= 1
            if c.remaining[index] == 0:
                c.value[index] = c.target[index]
                c.moving -= 1
            else:
                c.value[index] += c.slope[index]


@compiled
def amplitude(c: Any, of: int, decibels: float) -> float:
    """Convert decibels to an amplitude factor, computed only when they change."""
    if decibels != c.decibels[of]:
        c.decibels[of], c.factor[of] = decibels, 10.0 ** (decibels / 20.0)
    return float(c.factor[of])


@compiled
def level(c: Any) -> float:
    """Gain from pascals to full scale at this sample."""
    factor = amplitude(c, TO_OUTPUT, c.value[GAIN] + c.value[BALANCE])
    return float(c.value[LEVEL] * factor / FULL_SCALE_PRESSURE)


@compiled
def has_new_strings(c: Any) -> bool:
    """Whether the tuning or loss of a string differs from what the model has."""
    for i in range(STRINGS):
        if c.value[TUNING[i]] != c.tuning[i] or c.value[LOSS[i]] != c.loss[i]:
            return True
    return False


@compiled
def chance(frame: int) -> float:
    """A pseudorandom number in -1..1, the same for the same frame.

    Source: [SplitMix], its output function.
    """
    x = np.uint64(frame) * np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x = x ^ (x >> np.uint64(31))
    return float(x >> np.uint64(11)) * 2.0**-52 - 1.0


@compiled
def grip(c: Any) -> float:
    """Factor of the bow force at this sample, about 1: noise of the hair."""
    noise = c.value[NOISE]
    if noise == 0.0:
        return 1.0
    c.grain = one_pole(c.grain, c.grain_size * chance(c.frame), c.grain_follow)
    return float(max(0.0, 1.0 + noise * c.grain))


@compiled
def vibrate(c: Any) -> float:
    """Advance the vibrato by one sample; its value, -1 to 1, faded in by /vibrato/onset."""
    if c.value[DEPTH] == 0.0 and c.value[ROCK] == 0.0:
        c.vibrato = 0.0
        return 0.0
    c.vibrato += c.value[RATE] / c.second
    c.vibrato -= math.floor(c.vibrato)
    come = max(0.0, (c.value[ONSET] - ONSET_FROM) / (1.0 - ONSET_FROM))
    return float(come * come * (3.0 - 2.0 * come) * math.sin(2.0 * math.pi * c.vibrato))


@compiled
def turn_bow(c: Any) -> float:
    """Advance the tremolo by one sample; factor of the bow's speed, -1 to 1."""
    strokes = c.value[TREMOLO]
    if strokes == 0.0:
        if c.tremolo == FORWARD:
            return 1.0
        strokes = LAST_STROKES
    before = c.tremolo
    c.tremolo += 0.5 * strokes / c.second
    if c.value[TREMOLO] == 0.0 and before < FORWARD <= c.tremolo:
        c.tremolo = FORWARD
    c.tremolo -= math.floor(c.tremolo)
    return float(max(-1.0, min(1.0, TURN * math.sin(2.0 * math.pi * c.tremolo))))


@compiled
def stop_strings(c: Any, control: Array) -> None:
    """Write the fingers' controls, with vibrato; follow the sounding length they leave."""
    rocking = vibrate(c)
    stretch, harder = 1.0, 1.0
    if rocking != 0.0:
        stretch = 2.0 ** (-rocking * c.value[DEPTH] / 1200.0)
        harder = 1.0 + rocking * c.value[ROCK]
    stop = 0.0
    for j in range(MAX_FINGERS):
        column = FINGER_CONTROLS + CONTROLS_PER_FINGER * j
        x_f, press = c.value[FINGER_POSITION[j]], c.value[FINGER_PRESS[j]]
        if press > 0.0:
            c.finger_up[j] = 0
            stop = max(stop, x_f)
            if rocking != 0.0:
                x_f = c.bridge_x - (c.bridge_x - x_f) * stretch
                press *= harder
        else:
            c.finger_up[j] += 1
            if c.finger_up[j] >= c.park_after:
                x_f = PARK_X
        control[column], control[column + 1] = x_f, press
    c.sounding_from = one_pole(c.sounding_from, stop, c.follow)


@compiled
def pluck(c: Any) -> float:
    """Force (N) of the pluck at this sample; it is released once its ramp has ended."""
    force = c.value[PLUCK]
    if force != 0.0 and c.remaining[PLUCK] == 0:
        take(c, PLUCK, 0.0, c.let_go, 0)
    return float(force)


@compiled
def write_controls(c: Any, control: Array) -> None:
    """Write the kernel's controls for this sample. Real time: safe.

    The bow force is assist * share * F_max + (1 - assist) * force, times the side. Here
    F_max = 2 Z v_b / (beta (mu_S - mu_C)) is Schelleng's upper limit [Schelleng], and the share
    is /bow/pressure and a little more for a fast bow.

    Parameters
    ----------
    control : ndarray [shape=(columns,)]
        See ``physics.layout``.
    """
    stop_strings(c, control)
    speed, beta, side = c.value[SPEED] * turn_bow(c), c.value[POSITION], c.value[SIDE]
    string = 0 if side >= 0.0 else 1
    limit = c.schelleng[string] * abs(speed) / beta
    assist = c.value[ASSIST]
    share = c.value[SHARE] + FAST_SHARE * min(1.0, (speed / FAST) ** 2)
    force = assist * share * limit + (1.0 - assist) * c.value[FORCE]
    sounding = c.bridge_x - c.sounding_from
    control[F_N] = side * force * grip(c)
    control[V_B] = speed
    control[X_B] = c.bridge_x - beta * sounding
    control[F_HAMMER] = 0.0
    control[F_PLUCK] = pluck(c)
    control[X_PLUCK] = c.bridge_x - c.value[PLUCK_POSITION] * sounding
