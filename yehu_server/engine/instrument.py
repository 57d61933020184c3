"""The instrument: events in, samples out. The same compiled process live and offline."""

from __future__ import annotations

import heapq
import itertools
import math
from typing import Any

import numpy as np

from yehu_server.engine.gesture import (
    EVENT,
    GAIN,
    LEVEL,
    SILENCE,
    move,
    prepare_gesture,
    take,
    write_controls,
)
from yehu_server.errors import ParameterError
from yehu_server.jit import compiled
from yehu_server.params.table import SLOT, find
from yehu_server.physics import kernel
from yehu_server.physics.bow import friction_bound
from yehu_server.physics.grid import check_rate
from yehu_server.physics.layout import ITERATIONS, PRESSURE, control_columns, probe_columns
from yehu_server.physics.quantities import Quantities

Array = Any

CHUNK = 64  # frames run through the kernel at a time
FADE_S = 0.005
BLOCKED_HZ = 10.0  # what is slower than this is no sound
FULL_SCALE_PRESSURE = 1.0  # Pa at full scale with no gain. By ear.
SOFT_ABOVE = 10.0 ** (-3.0 / 20.0)  # the limiter is transparent below -3 dBFS

OUTPUT = np.dtype(
    [
        ("fade", np.int64),  # frames of a fade to silence
        ("last", np.float64),  # the last sample
        ("ghost", np.float64),  # what is left of the one before a lost state
        ("decay", np.float64),
        ("pressure", np.float64),  # input and output of the DC blocker (Pa)
        ("swing", np.float64),
        ("blocker", np.float64),
        ("controls", np.float64, (CHUNK, control_columns(1))),
        ("probes", np.float64, (CHUNK, probe_columns(1))),
        ("gain", np.float64, CHUNK),
    ],
    align=True,
)


@compiled
def limit(x: float) -> float:
    """Bend what is above -3 dBFS so that nothing exceeds full scale. Odd, smooth, memoryless."""
    size = abs(x)
    if size <= SOFT_ABOVE:
        return x
    room = 1.0 - SOFT_ABOVE
    bent = SOFT_ABOVE + room * math.tanh((size - SOFT_ABOVE) / room)
    return bent if x > 0.0 else -bent


@compiled
def play_out(o: Any, probe: Array, gain: float) -> float:
    """One sample of output from one row of probes; a lost state is faded, not cut."""
    if probe[ITERATIONS] < 0:
        o.ghost = o.last
        o.pressure, o.swing = 0.0, 0.0
    o.ghost *= o.decay
    # A finger's press pulls at the bridge for as long as it lasts: not a sound.
    o.swing = probe[PRESSURE] - o.pressure + o.blocker * o.swing
    o.pressure = probe[PRESSURE]
    o.last = limit(o.swing * gain + o.ghost)
    return float(o.last)


@compiled
def process(
    model: Array, state: Array, gesture: Array, output: Array, events: Array, out: Array
) -> int:
    """Play one block.

    Parameters
    ----------
    model, state : ndarray [shape=(1,)]
        From ``kernel``; `gesture` from `prepare_gesture`, `output` of dtype OUTPUT.
    events : ndarray [shape=(events,), dtype=EVENT]
        In order of frame; those up to the block's last frame are applied, each at its
        frame, late ones at once.
    out : ndarray [shape=(frames,), float32]
        Written, in full scale.

    Returns
    -------
    used : int
        How many events were applied.

    What is heard does not depend on how frames are cut into blocks.
    Real time: safe; no allocation, no exception, every sample finite.
    """
    g, o = gesture[0], output[0]
    used = 0
    done = 0
    while done < len(out):
        frames = 0
        silenced = False
        while frames < CHUNK and done + frames < len(out) and not silenced:
            while used < len(events) and events[used].frame <= g.frame:
                take(g, events[used], o.fade)
                used += 1
            move(g)
            write_controls(g, o.controls[frames])
            gain = g.value[LEVEL] * 10.0 ** (g.value[GAIN] / 20.0) / FULL_SCALE_PRESSURE
            if g.silence_in > 0:
                g.silence_in -= 1
                gain *= g.silence_in / o.fade
                silenced = g.silence_in == 0
            o.gain[frames] = gain
            g.frame += 1
            frames += 1
        kernel.advance(model, state, o.controls[:frames], o.probes[:frames], o.probes[:0])
        for n in range(frames):
            out[done + n] = play_out(o, o.probes[n], o.gain[n])
        if silenced:
            kernel.come_to_rest(model, state[0])
            o.pressure, o.swing, o.ghost = 0.0, 0.0, 0.0
        done += frames
    return used


class Instrument:
    """One yehu, ready to play; to be used from one thread.

    Parameters
    ----------
    rate : float, Hz
        22,050 to 192,000.
    quantities : Quantities
        The physical instrument; the measured one by default.

    Errors: ParameterError where rate or quantities make no stable model.
    """

    def __init__(self, rate: float, quantities: Quantities | None = None) -> None:
        check_rate(rate)
        self.rate = rate
        self.quantities = quantities or Quantities()
        self._model = kernel.prepare(self.quantities, rate)
        self._output = np.zeros(1, OUTPUT)
        self._output["fade"] = max(1, round(FADE_S * rate))
        self._output["decay"] = math.exp(-1.0 / (FADE_S * rate))
        self._output["blocker"] = math.exp(-2.0 * math.pi * BLOCKED_HZ / rate)
        self._order = itertools.count()
        self.reset()

    def reset(self) -> None:
        """Put model and parameters back to the start; forget scheduled events."""
        self._state = kernel.at_rest(self._model)
        self._gesture = prepare_gesture(self.quantities, self.rate)
        for name in ("last", "ghost", "pressure", "swing"):
            self._output[name] = 0.0
        self._queue: list[tuple[int, int, int, float, int]] = []

    @property
    def frame(self) -> int:
        """The frame of the next sample."""
        return int(self._gesture["frame"][0])

    @property
    def friction_bound(self) -> float:
        """See ``physics.bow.friction_bound``."""
        return friction_bound(self._model[0])

    @property
    def unconverged_solves(self) -> int:
        """Friction solves that did not converge, since the start."""
        return int(self._state["unconverged"][0])

    @property
    def lost_states(self) -> int:
        """How often the state was lost and put back to rest, since the start."""
        return int(self._state["lost"][0])

    def frames(self, ms: float) -> int:
        """Milliseconds as a number of frames."""
        return round(ms * 1e-3 * self.rate)

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """Let a parameter of the engine move to a value; return the value accepted.

        Parameters
        ----------
        frame : int
            When; now by default. Events of one frame apply in the order written.
        ramp_ms : float
            How long the way takes; the parameter's own smoothing by default.

        Errors: ParameterError for an unknown address or a value that is not finite.
        """
        param = find(address)
        accepted = param.accept(value)
        slot = SLOT.get(address)
        if slot is None:
            raise ParameterError(f"{address} is not held by the engine")
        ramp = self.frames(param.smooth_ms if ramp_ms is None else ramp_ms)
        self._schedule(frame, slot, accepted, ramp)
        return accepted

    def silence(self, *, frame: int | None = None) -> None:
        """Fade the sound out within 5 ms and put the model to rest."""
        self._schedule(frame, SILENCE, 0.0, 0)

    def _schedule(self, frame: int | None, index: int, target: float, ramp: int) -> None:
        when = self.frame if frame is None else frame
        heapq.heappush(self._queue, (when, next(self._order), index, target, ramp))

    def process(self, out: Array) -> None:
        """Write the next samples to `out` [shape=(frames,), float32], in full scale."""
        if len(out) == 0:
            return
        due = []
        end = self.frame + len(out)
        while self._queue and self._queue[0][0] < end:
            when, _, index, target, ramp = heapq.heappop(self._queue)
            due.append((when, index, target, ramp))
        events = np.array(due, dtype=EVENT)
        process(self._model, self._state, self._gesture, self._output, events, out)
