"""From the model's probes to samples: DC blocker, gain, limiter, and a fade for lost states."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.engine.one_pole import pole_of_cutoff, pole_of_time
from yehu_server.jit import compiled
from yehu_server.physics.layout import (
    BRIDGE_FORCE,
    ITERATIONS,
    MAX_FINGERS,
    PRESSURE,
    control_columns,
    probe_columns,
)

Array = Any

CHUNK = 64  # frames run through the kernel at a time
FADE_S = 0.005
BLOCKED_HZ = 10.0  # what is slower than this is no sound
# Pa that count for a newton at the bridge, so that a blend is about as loud at both ends.
BRIDGE_PRESSURE = 0.1
LARGEST = 2.0  # of what the limiter lets out: rounding takes no sample further than full scale

OUTPUT = np.dtype(
    [
        ("channels", np.int64),  # of the device; all get the same signal
        ("fade", np.int64),  # frames of a fade to silence
        ("last", np.float64),  # the last sample
        ("unsound", np.int64),  # samples that were not numbers, written as silence
        ("ghost", np.float64),  # what is left of the one before a lost state
        ("decay", np.float64),
        ("pressure", np.float64),  # input and output of the DC blocker (Pa)
        ("swing", np.float64),
        ("blocker", np.float64),
        ("controls", np.float64, (CHUNK, control_columns(MAX_FINGERS))),
        ("probes", np.float64, (CHUNK, probe_columns(MAX_FINGERS))),
        ("gain", np.float64, CHUNK),
        ("body", np.float64, CHUNK),
        ("blend", np.float64, CHUNK),
        ("soft", np.float64, CHUNK),
    ],
    align=True,
)


def prepare_output(output: Any, rate: float, channels: int) -> None:
    """Set the coefficients of a record of dtype OUTPUT [shape=(1,)], in place."""
    output["channels"] = channels
    output["unsound"] = 0
    output["fade"] = max(1, round(FADE_S * rate))
    output["decay"] = pole_of_time(FADE_S, rate)
    output["blocker"] = pole_of_cutoff(BLOCKED_HZ, rate)
    rest_output(output)


def rest_output(output: Any) -> None:
    """Forget the last samples, in place."""
    for name in ("last", "ghost", "pressure", "swing"):
        output[name] = 0.0


@compiled
def limit(x: float, soft: float) -> float:
    """Bend what is above `soft`, 0 to 1, so that nothing exceeds full scale.

    Odd, memoryless, and smooth below 1.
    """
    size = abs(x)
    if size <= soft:
        return x
    room = 1.0 - soft
    bent = 1.0 if room <= 0.0 else soft + room * math.tanh((size - soft) / room)
    return bent if x > 0.0 else -bent


@compiled
def fall_silent(o: Any) -> None:
    """Forget what the filters hold, as the model is put to rest. Real time: safe."""
    o.pressure, o.swing, o.ghost = 0.0, 0.0, 0.0


@compiled
def play_out(o: Any, n: int) -> float:
    """Make one sample of output of row `n` of the probes; a lost state is faded, not cut.

    Whatever comes in, what goes out is finite.
    """
    probe = o.probes[n]
    if probe[ITERATIONS] < 0:
        o.ghost = o.last
        o.pressure, o.swing = 0.0, 0.0
    o.ghost *= o.decay
    # A finger's press pulls at the bridge for as long as it lasts: not a sound.
    radiated = o.body[n] * probe[PRESSURE]
    source = radiated + o.blend[n] * (BRIDGE_PRESSURE * probe[BRIDGE_FORCE] - radiated)
    o.swing = source - o.pressure + o.blocker * o.swing
    o.pressure = source
    loud = o.swing * o.gain[n] + o.ghost
    sample = limit(loud, o.soft[n])
    if not (abs(loud) < math.inf and abs(sample) <= LARGEST):  # so that NaN is caught too
        sample = 0.0
        o.unsound += 1
        fall_silent(o)
    o.last = sample
    return float(sample)
