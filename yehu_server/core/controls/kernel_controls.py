"""The kernel's controls of bow, fingers and pluck at each sample. Compiled."""

import math
from typing import Any

from yehu_server.compile.jit import compiled, compiled_exactly
from yehu_server.core.controls.ramps import one_pole, start_ramp
from yehu_server.core.controls.record import (
    CENTS_DRIFT,
    DRIFT_COUNT,
    FORCE_DRIFT,
    FORWARD,
    POSITION_DRIFT,
    PRESS_DRIFT,
    SPEED_DRIFT,
)
from yehu_server.core.controls.slots import FINGER_POSITION, FINGER_PRESS, SLOTS
from yehu_server.core.physics.elementary import exp2, log, sin
from yehu_server.core.physics.layout import (
    CONTROLS_PER_FINGER,
    F_HAMMER,
    F_N,
    F_PLUCK,
    FINGER_CONTROLS,
    MAX_FINGERS,
    TEXTURE,
    V_B,
    X_B,
    X_PLUCK,
    Y_B,
)
from yehu_server.core.physics.lobes import DIRECTIONS

Array = Any

# A lifted finger waits near the loop, where the strings hardly move: over the middle of a string
# that swings wide it would be hit. By ear.
PARK_X_M = 0.012
# A fast bow needs a larger share of Schelleng's limit, or notes jump to the octave. Measured from
# F4 to F6: the least share that holds is 0.35 at 0.12 m/s, 0.5 at 0.2 m/s, 0.75 at 0.3 m/s.
EXTRA_SHARE, EXTRA_SHARE_SPEED = 0.6, 0.35  # m/s
SOFT_EFFORT = 0.045  # m/s
# A bow meets the other string with this fraction of its speed; tried at 0 to 1.
CROSSING_SPEED_FRACTION = 0.5
MIN_ONSET = 0.4  # of /vibrato/onset, below which there is no vibrato
# In tremolo the bow's speed is a sine times this, clipped to -1..1: mostly full speed. The deeper
# a tremolo is, the nearer its speed is to a sine squared.
TREMOLO_CLIP = 3.0
LAST_STROKES = 12.0  # strokes a second that bring the bow back to its direction when tremolo ends
# The bow stops following the sounding length this near to where it ends.
ARRIVED_WITHIN_M = 1e-6
# A contact that moves costs more than one that stands, so positions drift only once in so many
# samples, by steps of some thousandths of a cent.
POSITION_UPDATE_FRAMES = 16
PER_CENT = log(2.0) / 1200.0


@compiled
def advance_drifts(c: Any) -> None:
    """Advance what drifts by one sample; the player sets the slopes (``player.drift``)."""
    if c.drifting == 0:
        return
    for i in range(DRIFT_COUNT):
        c.drift[i] += c.drift_slope[i]
    c.swell += c.swell_slope
    for k in range(DIRECTIONS):
        c.turned[k] += c.turned_slope[k]
    if c.frame % POSITION_UPDATE_FRAMES == 0:
        raised = c.drift[CENTS_DRIFT] * PER_CENT
        c.sounding_drift = 1.0 - raised + 0.5 * raised * raised
        c.position_drift = 1.0 + c.drift[POSITION_DRIFT]


@compiled
def vibrato_at(c: Any, phase: float) -> float:
    """The vibrato at a phase (turns): by 1 about /vibrato/upward, faded in by its onset."""
    if c.value[SLOTS.vibrato_onset] <= MIN_ONSET:
        return 0.0
    fade_in = (c.value[SLOTS.vibrato_onset] - MIN_ONSET) / (1.0 - MIN_ONSET)
    value = sin(2.0 * math.pi * phase) + c.value[SLOTS.vibrato_upward]
    return float(fade_in * fade_in * (3.0 - 2.0 * fade_in) * value)


@compiled_exactly
def advance_vibrato(c: Any) -> None:
    """Advance the phase of the vibrato by one sample."""
    if c.value[SLOTS.vibrato_depth] == 0.0 and c.value[SLOTS.vibrato_press] == 0.0:
        c.vibrato = 0.0
        return
    c.vibrato += c.vibrato_rate_factor * c.value[SLOTS.vibrato_rate] / c.rate
    c.vibrato -= math.floor(c.vibrato)


@compiled_exactly
def advance_tremolo(c: Any) -> None:
    """Advance the phase of the tremolo by one sample; without one, to the end of its stroke."""
    strokes = c.value[SLOTS.bow_tremolo]
    if strokes == 0.0:
        if c.tremolo == FORWARD:
            return
        strokes = LAST_STROKES
    before = c.tremolo
    c.tremolo += 0.5 * strokes / c.rate
    if c.value[SLOTS.bow_tremolo] == 0.0 and before < FORWARD <= c.tremolo:
        c.tremolo = FORWARD
    c.tremolo -= math.floor(c.tremolo)


@compiled_exactly
def advance_phases(c: Any, frames: int) -> None:
    """Advance the controls by frames in which they stand still: phases go on. See `is_still`."""
    for _ in range(frames):
        advance_vibrato(c)
        advance_tremolo(c)
    c.frame += frames


@compiled
def vibrate(c: Any) -> float:
    """Advance the vibrato by one sample; its value."""
    advance_vibrato(c)
    if c.value[SLOTS.vibrato_depth] == 0.0 and c.value[SLOTS.vibrato_press] == 0.0:
        return 0.0
    return float(c.vibrato_depth_factor * vibrato_at(c, c.vibrato))


@compiled
def next_tremolo_factor(c: Any) -> float:
    """Advance the tremolo by one sample; factor of the bow's speed, -1 to 1."""
    advance_tremolo(c)
    return 1.0 if c.value[SLOTS.bow_tremolo] == 0.0 and c.tremolo == FORWARD else tremolo_factor(c)


@compiled
def tremolo_factor(c: Any) -> float:
    """Factor of the bow's speed at this phase of the tremolo, -1 to 1."""
    swing, depth = sin(2.0 * math.pi * c.tremolo), c.value[SLOTS.bow_tremolo_depth]
    quick = max(-1.0, min(1.0, TREMOLO_CLIP * swing))
    return float((1.0 - depth) * quick + depth * swing * abs(swing))


@compiled
def stop_strings(c: Any, control: Array) -> float:
    """Write the fingers' controls, with vibrato; the bow follows the sounding length they leave.

    Returns where that ends (m from the loop).
    """
    vibrato = vibrate(c)
    stretch, harder = 1.0, 1.0
    if vibrato != 0.0:
        stretch = exp2(-vibrato * c.value[SLOTS.vibrato_depth] / 1200.0)
        harder = 1.0 + vibrato * c.value[SLOTS.vibrato_press]
    stop = 0.0
    for j in range(MAX_FINGERS):
        column = FINGER_CONTROLS + CONTROLS_PER_FINGER * j
        x_f, press = c.value[FINGER_POSITION[j]], c.value[FINGER_PRESS[j]]
        if press > 0.0:
            c.finger_up[j] = 0
            stop = max(stop, x_f)
            if vibrato != 0.0:
                x_f = c.bridge_x - (c.bridge_x - x_f) * stretch
                press *= harder
            if c.drifting != 0:
                x_f = c.bridge_x - (c.bridge_x - x_f) * c.sounding_drift
                press *= 1.0 + c.drift[PRESS_DRIFT]
        else:
            c.finger_up[j] += 1
            if c.finger_up[j] >= c.park_after:
                x_f = PARK_X_M
        control[column], control[column + 1] = x_f, press
    if c.sounding_from != stop:  # a bow that comes to rest costs less than one that never does
        c.sounding_from = one_pole(c.sounding_from, stop, c.follow)
        if abs(c.sounding_from - stop) < ARRIVED_WITHIN_M:
            c.sounding_from = stop
    return stop


@compiled
def pluck(c: Any) -> float:
    """Force (N) of the pluck at this sample; it is released once its ramp has ended."""
    force = c.value[SLOTS.pluck_force]
    if force != 0.0 and c.remaining[SLOTS.pluck_force] == 0:
        start_ramp(c, SLOTS.pluck_force, 0.0, c.let_go)
    return float(force)


@compiled
def bow_force(c: Any, string: int, speed: float) -> float:
    """Bow force (N) on a string at a speed (m/s): assist * share * F_max + (1 - assist) * force.

    Here F_max = 2 Z v_b / (beta (mu_S - mu_C)) is Schelleng's upper limit [Schelleng], and the
    share is /bow/pressure and a little more for a fast bow.
    """
    limit = c.schelleng[string] * abs(speed) / c.value[SLOTS.bow_position]
    assist = c.value[SLOTS.bow_assist]
    share = c.value[SLOTS.bow_pressure] + EXTRA_SHARE * min(1.0, (speed / EXTRA_SHARE_SPEED) ** 2)
    return float(assist * share * limit + (1.0 - assist) * c.value[SLOTS.bow_force])


@compiled
def hair_noise(c: Any, string: int, force: float) -> float:
    """Depth of the hair's texture under a bow force (N): beyond a soft bow's, the less the more.

    A soft bow draws with SOFT_EFFORT (m/s): its speed times its share of Schelleng's limit. Were
    the depth the same under any force, noise would grow by 8 dB more than the tone from soft to
    loud; in recordings of a cello it grows by 2 dB more.
    """
    soft = SOFT_EFFORT * c.schelleng[string] / c.value[SLOTS.bow_position]
    return float(c.value[SLOTS.bow_noise] * soft / max(abs(force), soft))


@compiled
def is_still(c: Any) -> bool:
    """Whether `write_controls` would write the same again, with the bow off the strings.

    Phases of vibrato and tremolo may go on, where no finger and no bow follows them.
    """
    if c.moving_count > 0 or c.silence_in > 0 or c.drifting != 0:
        return False
    if (
        c.value[SLOTS.bow_speed] != 0.0
        or c.value[SLOTS.bow_side] != 0.0
        or c.value[SLOTS.pluck_force] != 0.0
    ):
        return False
    is_vibrating = c.value[SLOTS.vibrato_depth] != 0.0 or c.value[SLOTS.vibrato_press] != 0.0
    is_vibrating = is_vibrating and c.value[SLOTS.vibrato_onset] > MIN_ONSET
    for j in range(MAX_FINGERS):
        if c.value[FINGER_PRESS[j]] > 0.0:
            if is_vibrating:
                return False
        elif c.finger_up[j] < c.park_after:
            return False
    return True


@compiled
def cross_strings(c: Any, speed: float, side: float) -> tuple[float, float, float]:
    """Carry the bow from one string to the other: returns two speeds (m/s) and a weight.

    It comes to rest on the string that it leaves, which friction at a bow at rest soon damps, and
    its weight leaves that slowly enough not to pluck it. It meets the other string at a part of its
    speed and accelerates, while its weight comes in half the time in which it left: with less force
    for that speed a high note slips twice in a period, and is heard an octave up [Guettler]. The
    speeds are the bow's, and that from which its force is computed; the weight is the share of that
    force, above 0 on the inner string.
    """
    if side * c.target[SLOTS.bow_side] < 0.0:
        if side * c.side_before <= 0.0:
            c.side_before, c.speed_before = side, speed
        left = side / c.side_before
        speed = c.speed_before * max(0.0, 2.0 * left - 1.0)
        return speed, c.speed_before, side * left * (2.0 - left)
    if side * c.side_before < 0.0:
        c.value[SLOTS.bow_speed] = CROSSING_SPEED_FRACTION * c.target[SLOTS.bow_speed]
        start_ramp(c, SLOTS.bow_speed, c.target[SLOTS.bow_speed], c.remaining[SLOTS.bow_speed])
        start_ramp(c, SLOTS.bow_side, c.target[SLOTS.bow_side], c.remaining[SLOTS.bow_side] // 2)
    c.side_before, c.speed_before = side, speed
    return speed, speed, side


@compiled
def write_controls(c: Any, control: Array) -> None:
    """Write the kernel's controls (``physics.layout``) for this sample. Real time: safe."""
    advance_drifts(c)
    stop = stop_strings(c, control)
    speed, side = c.value[SLOTS.bow_speed] * next_tremolo_factor(c), c.value[SLOTS.bow_side]
    speed, force_speed, weight = cross_strings(c, speed, side)
    beta, firmness = c.value[SLOTS.bow_position], 1.0
    if c.drifting != 0:
        speed *= 1.0 + c.drift[SPEED_DRIFT]
        force_speed *= 1.0 + c.drift[SPEED_DRIFT]
        beta *= c.position_drift
        firmness += c.drift[FORCE_DRIFT]
    string = 0 if side >= 0.0 else 1
    sounding = c.bridge_x - c.sounding_from
    force = bow_force(c, string, force_speed) * firmness
    control[F_N], control[TEXTURE] = weight * force, hair_noise(c, string, force)
    c.bow_displacement += speed / c.rate
    control[Y_B] = c.bow_displacement
    control[V_B] = speed
    control[X_B] = c.bridge_x - beta * sounding
    control[F_HAMMER] = 0.0
    control[F_PLUCK] = pluck(c)
    control[X_PLUCK] = c.bridge_x - c.value[SLOTS.pluck_position] * (c.bridge_x - stop)
