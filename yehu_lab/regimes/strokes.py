"""Whole strokes of the bow, each from rest to its finding, in one compiled call without the GIL.

A stroke moves controls along curves that all strokes of a `ControlCurves` share: each stroke scales
a curve's values, and moves and stretches its time. So many strokes are a few numbers each.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np

from yehu_lab.regimes.columns import FINDING, UNBOWED
from yehu_lab.regimes.judge import BOW, RELATIVE, SIGNALS, SOUND, judge_signals
from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.compile.memory import carray
from yehu_server.core.controls.record import PARK_AFTER_S
from yehu_server.core.engine.atomics import at
from yehu_server.core.physics import kernel, planes
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.layout import (
    F_N,
    FINGER_CONTROLS,
    MODEL,
    PRESSURE,
    RELATIVE_VELOCITY,
    STATE,
    V_B,
    Y_B,
    control_columns,
    new_record,
    probe_columns,
)
from yehu_server.core.physics.time_loop import advance_by, kernel_of
from yehu_server.simulation.run import pull

Array = Any

BLOCK = 128  # frames computed at a time, so that controls and probes stay in the cache
MAX_FAULTS = 255
BLOCKS = np.dtype(
    [
        ("controls", np.float64, (BLOCK, control_columns(1))),
        ("probes", np.float64, (BLOCK, probe_columns(1))),
        ("come", np.int64, control_columns(1)),  # the point that each control's curve has come to
    ],
    align=True,
)
_FIELDS: Any = BLOCKS.fields
PROBES_AT = int(_FIELDS["probes"][1])

# What a stroke does with the curve of one control: value = scale * curve((time - start) * pace).
MOVE = np.dtype([("scale", np.float64), ("start", np.float64), ("pace", np.float64)])

STROKE = np.dtype(
    [
        ("model", np.int64),  # which of the models, and of their states at rest
        ("hair", np.int64),  # which of many alike
        ("frames", np.int64),
        ("frequency_hz", np.float64),  # of the note
        ("moves", MOVE, control_columns(1)),  # of each column of the kernel's controls
    ],
    align=True,
)


@dataclass(frozen=True)
class ControlCurves:
    """The curves of all controls, one after another."""

    # [shape=(control columns + 1,), dtype=int64] where in the points the curve of each control
    # begins; a control without points is 0.
    first: Array
    # The points; times (s) do not go back, and values are held before and after.
    times: Array
    values: Array


def control_curves_of(curves: dict[int, list[tuple[float, float]]]) -> ControlCurves:
    """The curves of some columns of the controls as arrays."""
    points = [curves.get(column, []) for column in range(control_columns(1))]
    first = np.cumsum([0, *map(len, points)])
    flat = np.array([point for curve in points for point in curve], np.float64).reshape(-1, 2)
    return ControlCurves(first, flat[:, 0].copy(), flat[:, 1].copy())


class Instruments(NamedTuple):
    """What `find` bows.

    `models` (ndarray [dtype=layout.MODEL]): what is bowed.
    `rests` (ndarray [dtype=layout.STATE]): the state from which each model begins.
    `more` (list of ndarray [shape=(1,)], or None): what each has besides (``planes.prepare``).
    """

    models: Array
    rests: Array
    more: list[Any]


def prepared(
    quantities: Sequence[Quantities], rates: Sequence[float], plucks: Sequence[Any] = ()
) -> Instruments:
    """Prepare instruments for `find`.

    `plucks`: from where the string of each is let go (`gesture.Pluck`), or None.
    """
    count = len(quantities)
    models, rests = np.zeros(count, MODEL), np.zeros(count, STATE)
    besides = []
    for i, (instrument, rate) in enumerate(zip(quantities, rates, strict=True)):
        model = kernel.prepare(instrument, rate)
        rest = kernel.at_rest(model)
        more = planes.prepare(instrument, rate)
        if plucks and plucks[i] is not None:
            pull(model, rest, more, plucks[i])
        # Not by `concatenate`, which would give the records another layout.
        models[i], rests[i] = model[0], rest[0]
        besides.append(more)
    return Instruments(models, rests, besides)


@compiled_exactly
def value_at(times: Array, values: Array, at: int, last: int, time: float) -> float:
    """The value between a point and the next, or at the first or last of a curve."""
    if at == last or time <= times[at]:
        return float(values[at])
    slope = (values[at + 1] - values[at]) / (times[at + 1] - times[at])
    return float(values[at] + slope * (time - times[at]))


@compiled_exactly
def write_controls(
    moves: Array, first: Array, times: Array, values: Array, at: Array, frame: int, rate: float,
    control: Array,
) -> None:  # fmt: skip
    """Write the controls of a frame but the bow's place; `at` keeps the point each has come to."""
    for column in range(len(control)):
        begin, last = first[column], first[column + 1] - 1
        if last < begin:
            control[column] = 0.0
            continue
        move = moves[column]
        time = (frame / rate - move["start"]) * move["pace"]
        point = at[column]
        while point < last and times[point + 1] <= time:
            point += 1
        at[column] = point
        control[column] = move["scale"] * value_at(times, values, point, last, time)


@native
def bow_stroke(
    kernel: int,
    model: Any,
    state: Any,
    more: Any,
    stroke: Annotated[Any, STROKE],
    first: Any,
    times: Any,
    values: Any,
    block: Any,
    signals: Any,
    room: int,
    out: Annotated[Any, FINDING],
) -> None:
    """Bow a stroke from rest, and judge it.

    The first four are as of ``time_loop.advance_by``; `first`, `times` and `values` are pointers to
    the arrays of `ControlCurves`. It works in `block`, and in `signals` as ``judge.judge_signals``
    has them [shape=(SIGNALS, room)].
    """
    m, s = carray(model, (1,), MODEL)[0], carray(state, (1,), STATE)[0]
    work = carray(block, (1,), BLOCKS)[0]
    controls, probes, come = work.controls, work.probes, work.come
    columns = len(come)
    begins = carray(first, (columns + 1,), np.int64)
    points = begins[columns]
    curve_times = carray(times, (points,), np.float64)
    curve_values = carray(values, (points,), np.float64)
    rows = carray(signals, (SIGNALS, room), np.float64)
    rate, place, force = m.rate, 0.0, 0.0
    wait = int(PARK_AFTER_S * rate)
    lifted = wait  # frames without press
    for column in range(columns):
        come[column] = begins[column]
    for begin in range(0, stroke.frames, BLOCK):
        count = min(BLOCK, stroke.frames - begin)
        for n in range(count):
            write_controls(
                stroke.moves,
                begins,
                curve_times,
                curve_values,
                come,
                begin + n,
                m.rate,
                controls[n],
            )
            place += controls[n, V_B] / rate
            controls[n, Y_B] = place
            lifted = 0 if controls[n, FINGER_CONTROLS + 1] > 0.0 else lifted + 1
            if lifted >= wait:  # as ``gesture.parked_frames``
                controls[n, FINGER_CONTROLS] = m.bridge_x
        advance_by(kernel, model, state, more, block, at(block, PROBES_AT), 0, count)
        for n in range(count):
            rows[RELATIVE, begin + n] = probes[n, RELATIVE_VELOCITY]
            rows[SOUND, begin + n] = probes[n, PRESSURE]
            rows[BOW, begin + n] = controls[n, V_B]
        force = controls[count - 1, F_N]
    judge_signals(signals, room, stroke.frames, rate, stroke.frequency_hz, out)
    if abs(force) < m.lift_force:
        out.regime = UNBOWED
    out.faults = min(MAX_FAULTS, s.unconverged + s.lost)


# What sweeps call, but for what playing calls, by the file that its machine code is kept in.
COMPILED = {"yehu_lab": (bow_stroke,)}


def find(instruments: Instruments, strokes: Array, hands: ControlCurves) -> Array:
    """Bow strokes, and judge each: findings [shape=(strokes,), dtype=FINDING].

    The strokes do not touch each other: any order of them, in any number of calls, finds the same.
    The instruments are not changed.
    """
    findings = np.zeros(len(strokes), FINDING)
    strokes = np.ascontiguousarray(strokes)
    model, state = new_record(MODEL), new_record(STATE)
    block = np.zeros(1, BLOCKS)
    signals = np.zeros((SIGNALS, int(strokes["frames"].max(initial=0))))
    curves = [array.ctypes.data for array in (hands.first, hands.times, hands.values)]
    for i, stroke in enumerate(strokes):
        which = stroke["model"]
        model[0], state[0] = instruments.models[which], instruments.rests[which]
        model["hair"], rest, more = stroke["hair"], instruments.more[which], model
        if rest is not None:
            more = new_record(rest.dtype)
            more[0] = rest[0]
        own = [array.ctypes.data for array in (model, state, more)]
        kernel = kernel_of(rest)
        bow_stroke.call(
            kernel, *own, strokes[i:].ctypes.data, *curves, block.ctypes.data, signals.ctypes.data,
            signals.shape[1], findings[i:].ctypes.data,
        )  # fmt: skip
    return findings
