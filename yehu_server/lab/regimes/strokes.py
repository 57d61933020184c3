"""Whole strokes of the bow, each from rest to its finding, in one compiled call without the GIL.

A stroke moves controls along curves that all strokes of a `ControlCurves` share: each stroke scales
a curve's values, and moves and stretches its time. So many strokes are a few numbers each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from yehu_server.compile.jit import IS_PLAIN, compiled_exactly, compiled_with_aliasing
from yehu_server.compile.memory import with_attributes
from yehu_server.core.physics import kernel
from yehu_server.core.physics import refined as refined_kernel
from yehu_server.core.physics.layout import (
    F_N,
    MODEL,
    PRESSURE,
    REFINED,
    RELATIVE_VELOCITY,
    STATE,
    V_B,
    Y_B,
    control_columns,
    new_record,
    probe_columns,
)
from yehu_server.core.physics.pluck import pluck_string
from yehu_server.core.physics.quantities import Quantities
from yehu_server.lab.regimes.columns import FINDING, UNBOWED, new_findings
from yehu_server.lab.regimes.judge import judge_stroke

Array = Any

BLOCK = 128  # frames computed at a time, so that controls and probes stay in the cache
MOST_FAULTS = 255
PROBES = probe_columns(1)

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

    Attributes
    ----------
    models : ndarray [dtype=layout.MODEL]
    rests : ndarray [dtype=layout.STATE]
        The state from which each model begins.
    refined : ndarray [dtype=layout.REFINED]
        What each has besides; one with no points has nothing.
    """

    models: Array
    rests: Array
    refined: Array


def prepared(
    quantities: Sequence[Quantities], rates: Sequence[float], plucks: Sequence[Any] = ()
) -> Instruments:
    """Prepare instruments for `find`.

    `plucks` tells from where the string of each is let go (`gesture.Pluck`), or None.
    """
    count = len(quantities)
    models, rests = np.zeros(count, MODEL), np.zeros(count, STATE)
    refined = np.zeros(count, REFINED)
    for i, (instrument, rate) in enumerate(zip(quantities, rates, strict=True)):
        model = kernel.prepare(instrument, rate)
        rest = kernel.at_rest(model)
        if plucks and plucks[i] is not None:
            pluck = plucks[i]
            pluck_string(model, rest, pluck.string - 1, pluck.position, pluck.amplitude)
        # Not by `concatenate`, which would give the records another layout.
        models[i], rests[i] = model[0], rest[0]
        more = refined_kernel.prepare(instrument, rate)
        if more is not None:
            refined[i] = more[0]
    return Instruments(models, rests, refined)


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


@compiled_with_aliasing
def bow_strokes(
    models: Array,
    rests: Array,
    refined: Array,
    strokes: Array,
    first: Array,
    times: Array,
    values: Array,
    model: Array,
    state: Array,
    more: Array,
    signals: Array,
    findings: Array,
) -> None:
    """Bow strokes one after another, and judge each.

    Each model begins from its state in `rests`; curves are those of `ControlCurves`. `refined` is
    None where all strokes are of plain instruments: the other kernel is not compiled then. It works
    in `model`, `state`, `more` [shape=(1,)] and `signals` [shape=(6, most frames)], and writes
    `findings` [shape=(strokes,), dtype=FINDING].
    """
    columns = first.shape[0] - 1
    controls = np.zeros((BLOCK, columns))
    probes = np.zeros((BLOCK, PROBES))
    at = np.zeros(columns, np.int64)
    relative, bow, pressure, work = signals[0], signals[1], signals[2], signals[3:]
    for i in range(strokes.shape[0]):
        stroke = strokes[i]
        model[0] = models[stroke.model]
        model[0].hair = stroke.hair
        state[0] = rests[stroke.model]
        if refined is not None:
            more[0] = refined[stroke.model]
        rate, place, force = model[0].rate, 0.0, 0.0
        at[:] = first[:columns]
        for begin in range(0, stroke.frames, BLOCK):
            count = min(BLOCK, stroke.frames - begin)
            for n in range(count):
                write_controls(stroke.moves, first, times, values, at, begin + n, rate, controls[n])
                place += controls[n, V_B] / rate
                controls[n, Y_B] = place
            if refined is None:
                kernel.advance(model, state, controls[:count], probes[:count], None)
            else:
                refined_kernel.advance(model, state, more, controls[:count], probes[:count], None)
            for n in range(count):
                relative[begin + n] = probes[n, RELATIVE_VELOCITY]
                pressure[begin + n] = probes[n, PRESSURE]
                bow[begin + n] = controls[n, V_B]
            force = controls[count - 1, F_N]
        out = findings[i]
        frequency = stroke.frequency_hz
        judge_stroke(relative, bow, pressure, stroke.frames, rate, frequency, work, out)
        if abs(force) < model[0].lift_force:
            out.regime = UNBOWED
        out.faults = min(MOST_FAULTS, state[0].unconverged + state[0].lost)


def find(instruments: Instruments, strokes: Array, hands: ControlCurves) -> Array:
    """Bow strokes, and judge each: findings [shape=(strokes,), dtype=FINDING].

    The strokes do not touch each other: any order of them, in any number of calls, finds the same.
    The instruments are not changed.
    """
    findings = new_findings(len(strokes))
    strokes = np.ascontiguousarray(strokes)
    if len(strokes) == 0:
        return findings.view(FINDING)
    models, rests, refined = instruments
    is_refined = refined["points"][strokes["model"]] > 0
    signals = np.zeros((6, int(strokes["frames"].max())))
    model, state = new_record(MODEL), new_record(STATE)
    for which, own, more in (
        (~is_refined, None, None),
        (is_refined, refined, new_record(REFINED)),
    ):
        bowed, found = strokes[which], findings[which]
        if IS_PLAIN:
            bowed = bowed.view(with_attributes(STROKE))
        if len(bowed):
            bow_strokes(
                models, rests, own, bowed, hands.first, hands.times, hands.values, model, state,
                more, signals, found,
            )  # fmt: skip
            findings[which] = found
    return findings.view(FINDING)
