"""The output of one instrument, from the model's probes to samples: DC blocker, gain, fades."""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.controls.ramps import pole_of_cutoff, pole_of_time
from yehu_server.core.controls.record import CHUNK, FADE_S
from yehu_server.core.controls.slots import STAGE_INPUTS
from yehu_server.core.engine.sleep import SLEEP, wake_up
from yehu_server.core.physics import lobes
from yehu_server.core.physics.layout import (
    BRIDGE_FORCE,
    ITERATIONS,
    MAX_FINGERS,
    PRESSURE,
    control_columns,
    probe_columns,
)
from yehu_server.core.physics.shelf import SHELF, prepare_shelf, shelved

Array = Any

BLOCKED_HZ = 10.0  # cutoff of the DC blocker
# Pressure (Pa) for a newton at the bridge: a blend is about as loud at both of its ends.
BRIDGE_PRESSURE = 0.1
LARGEST = 1e12  # of full scale: a sample beyond this is an error
NOT_SILENCED = -1

# What the stage gets of an instrument, of at most CHUNK frames.
SOUNDED = np.dtype(
    [
        ("dry", np.float64, CHUNK),  # the samples
        ("stage_inputs", np.float64, (CHUNK, len(STAGE_INPUTS))),
        ("soft", np.float64, CHUNK),  # from where on the limiter bends
        ("silenced_at", np.int64),  # row at which it came to rest, or NOT_SILENCED
    ],
    align=True,
)
SOUNDED_BYTES = SOUNDED.itemsize

OUTPUT = np.dtype(
    [
        ("last", np.float64),  # the last sample
        (
            "invalid_samples",
            np.int64,
        ),  # number of samples that were not numbers, replaced by silence
        ("fading", np.float64),  # decays from the last sample before a lost state
        ("decay", np.float64),
        ("pressure", np.float64),  # input and output of the DC blocker (Pa)
        ("dc_free", np.float64),
        ("blocker", np.float64),
        ("lobes", lobes.LOBES),
        ("shelf", SHELF),
        ("sleep", SLEEP),
        ("controls", np.float64, (CHUNK, control_columns(MAX_FINGERS))),
        ("probes", np.float64, (CHUNK, probe_columns(MAX_FINGERS))),
        ("gain", np.float64, CHUNK),
        ("body", np.float64, CHUNK),
        ("blend", np.float64, CHUNK),
        ("turned", np.float64, (CHUNK, lobes.DIRECTIONS)),  # of `lobes`, how much
        ("brilliance", np.float64, CHUNK),  # gain (dB) of the shelf, and its frequency (Hz)
        ("brilliance_frequency", np.float64, CHUNK),
        ("sounded", SOUNDED),
    ],
    align=True,
)


def prepare_output(output: Any, rate: float) -> None:
    """Set the coefficients of a record of dtype OUTPUT [shape=(1,)] for a rate (Hz), in place."""
    output["invalid_samples"], output["sounded"]["silenced_at"] = 0, NOT_SILENCED
    output["decay"] = pole_of_time(FADE_S, rate)
    output["blocker"] = pole_of_cutoff(BLOCKED_HZ, rate)
    lobes.prepare_lobes(output["lobes"], rate)
    prepare_shelf(output["shelf"], rate)
    rest_output(output)


def rest_output(output: Any) -> None:
    """Clear the filters' states of a record of dtype OUTPUT, in place."""
    for name in ("last", "fading", "pressure", "dc_free"):
        output[name] = 0.0
    output["shelf"]["held"] = 0.0
    for name in ("passed", "before", "line"):
        output["lobes"][name] = 0.0
    wake_up(output["sleep"])


@compiled
def clear_filters(o: Any) -> None:
    """Clear the filters' states, when the model is put to rest. Real time: safe."""
    o.pressure, o.dc_free, o.fading = 0.0, 0.0, 0.0
    o.shelf.held[0], o.shelf.held[1] = 0.0, 0.0
    lobes.clear_lobes(o.lobes)


@compiled
def output_sample(o: Any, n: int) -> float:
    """A finite, unlimited sample of row `n` of the probes; lost states fade. Real time: safe."""
    probe = o.probes[n]
    if probe[ITERATIONS] < 0:
        o.fading = o.last
        o.pressure, o.dc_free = 0.0, 0.0
    o.fading *= o.decay
    # The DC blocker also removes the static pull of a finger at the bridge.
    ahead = o.body[n] * probe[PRESSURE]
    first, second = lobes.radiate_aside(o.lobes, ahead)
    radiated = ahead + (o.turned[n, 0] * first + o.turned[n, 1] * second)
    source = radiated + o.blend[n] * (BRIDGE_PRESSURE * probe[BRIDGE_FORCE] - radiated)
    o.dc_free = source - o.pressure + o.blocker * o.dc_free
    o.pressure = source
    coloured = shelved(o.shelf, o.dc_free, o.brilliance[n], o.brilliance_frequency[n])
    sample = coloured * o.gain[n] + o.fading
    if not abs(sample) <= LARGEST:  # true for NaN too
        sample = 0.0
        o.invalid_samples += 1
        clear_filters(o)
    o.last = sample
    return float(sample)
