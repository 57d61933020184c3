"""All kernels as functions that are compiled apart, with or without a ledger of energy.

Playing, simulations, sweeps and tests call these, so that each is compiled once, and all of
them compute the very same samples.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.compile.jit import (
    IS_PLAIN,
    Deferred,
    compiled_with_aliasing,
    imported,
    intrinsic,
    native,
)
from yehu_server.compile.memory import carray
from yehu_server.core.physics import kernel, refined, two_directions
from yehu_server.core.physics.energy import record_energy, stored_energy
from yehu_server.core.physics.layout import (
    CONTROLS_PER_FINGER,
    FINGER_CONTROLS,
    FINGER_PROBES,
    ITERATIONS,
    LEDGER,
    LEVELS,
    MODEL,
    PROBES_PER_FINGER,
    REFINED,
    STATE,
    control_columns,
    probe_columns,
)
from yehu_server.core.physics.planes import PLANES
from yehu_server.core.physics.records import Array, Model

# Imported where something is compiled.
ir = Deferred(lambda: imported("llvmlite.ir"))
types = Deferred(lambda: imported("numba").types)


@compiled_with_aliasing
def control_rows(m: Model, address: Any, rows: int) -> Any:
    """The rows of controls at an address [shape=(rows, columns)]."""
    return carray(
        address, (rows, FINGER_CONTROLS + CONTROLS_PER_FINGER * int(m.fingers)), np.float64
    )


@compiled_with_aliasing
def probe_rows(m: Model, address: Any, rows: int) -> Any:
    """The rows of probes at an address [shape=(rows, columns)]."""
    return carray(address, (rows, FINGER_PROBES + PROBES_PER_FINGER * int(m.fingers)), np.float64)


@native
def advance(
    model: Any, state: Any, _more: Any, controls: Any, probes: Any, begin: int, end: int
) -> None:
    """As ``kernel.advance``, from row `begin` up to row `end`. All are pointers."""
    models, states = carray(model, (1,), MODEL), carray(state, (1,), STATE)
    rows, out = control_rows(models[0], controls, end), probe_rows(models[0], probes, end)
    kernel.advance(models, states, rows[begin:end], out[begin:end])


@native
def advance_refined(
    model: Any, state: Any, more: Any, controls: Any, probes: Any, begin: int, end: int
) -> None:
    """As ``refined.advance``, from row `begin` up to row `end`. All are pointers."""
    models, states = carray(model, (1,), MODEL), carray(state, (1,), STATE)
    rows, out = control_rows(models[0], controls, end), probe_rows(models[0], probes, end)
    refined.advance(models, states, carray(more, (1,), REFINED), rows[begin:end], out[begin:end])


@native
def advance_in_two_directions(
    model: Any, state: Any, more: Any, controls: Any, probes: Any, begin: int, end: int
) -> None:
    """As ``two_directions.advance``, from row `begin` up to row `end`. All are pointers."""
    models, states = carray(model, (1,), MODEL), carray(state, (1,), STATE)
    rows, out = control_rows(models[0], controls, end), probe_rows(models[0], probes, end)
    planes = carray(more, (1,), PLANES)
    two_directions.advance(models, states, planes, rows[begin:end], out[begin:end])


def has_two_directions(more: Any) -> bool:
    """Whether ``planes.prepare`` made this for strings that move in two directions."""
    return more is not None and more.dtype.itemsize == PLANES.itemsize


def kernel_of(more: Any) -> int:
    """Which kernel an instrument has, by what ``planes.prepare`` made for it: for `advance_by`.

    0 is the plain one. The others are named by their addresses, so that each is compiled with the
    first instrument that has it, and not where none has.
    """
    if more is None:
        return 0
    if IS_PLAIN:
        return 2 if has_two_directions(more) else 1
    return (
        advance_in_two_directions.address if has_two_directions(more) else advance_refined.address
    )


def _plain_call(kernel: int, *arguments: Any) -> None:
    (advance_refined if kernel == 1 else advance_in_two_directions).function(*arguments)


@intrinsic(plain=_plain_call)
def advance_at(
    _context: Any, _kernel: Any, _model: Any, _state: Any, _more: Any, _controls: Any, _probes: Any,
    _begin: Any, _end: Any,
) -> Any:  # fmt: skip
    """Call one of the other kernels by its address."""

    def generate(_codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        word, byte = ir.IntType(64), ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [byte] * 5 + [word] * 2)
        function = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(function, arguments[1:])

    word, addresses = types.int64, [types.voidptr] * 5
    return types.void(word, *addresses, word, word), generate


@compiled_with_aliasing
def advance_by(
    which: int, model: Any, state: Any, more: Any, controls: Any, probes: Any, begin: int, end: int
) -> None:
    """Advance by the kernel that an instrument has, as `kernel_of` names it."""
    if which == 0:
        advance(model, state, more, controls, probes, begin, end)
    else:
        advance_at(which, model, state, more, controls, probes, begin, end)


@native
def advance_with_ledger(
    which: int, directions: int, model: Any, state: Any, more: Any, controls: Any, probes: Any,
    ledger: Any, end: int,
) -> None:  # fmt: skip
    """As `advance_by` from the first row on, and keep the energy ledger.

    `ledger` is a pointer to an array [shape=(end, len(LEDGER))], which is written: NaN at a sample
    that lost the state.
    """
    m, s = carray(model, (1,), MODEL)[0], carray(state, (1,), STATE)[0]
    rows, out = control_rows(m, controls, end), probe_rows(m, probes, end)
    ledger_rows = carray(ledger, (end, len(LEDGER)), np.float64)
    level = int(s.motion.level)
    stored = stored_energy(m, s.motion, level, (level + 2) % LEVELS)
    stored_more, now = 0.0, (level + 2) % LEVELS
    if directions == 2:
        d = carray(more, (1,), PLANES)[0]
        stored_more = two_directions.stored_energy(m, s, d, level, now)
    elif which != 0:
        stored_more = refined.stored_energy(m, carray(more, (1,), REFINED)[0], level, now)
    for n in range(end):
        advance_by(which, model, state, more, controls, probes, n, n + 1)
        if out[n, ITERATIONS] < 0.0:  # lost, and at rest
            ledger_rows[n] = np.nan
            stored, stored_more = 0.0, 0.0
            continue
        stored = record_energy(m, s.motion, s.contacts, s.work, rows[n], stored, ledger_rows[n])
        row, book = rows[n], ledger_rows[n]
        if directions == 2:
            d = carray(more, (1,), PLANES)[0]
            stored_more = two_directions.record_planes(m, s, d, row, stored_more, book)
        elif which != 0:
            t = carray(more, (1,), REFINED)[0]
            stored_more = refined.record_points(m, s, t, row, stored_more, book)


def run(
    model: Any,
    state: Any,
    more: Any,
    controls: Array,
    probes: Array,
    ledger: Array | None = None,
) -> None:
    """Run the model of an instrument over all rows of some controls.

    Parameters
    ----------
    model, state, more : ndarray [shape=(1,)]
        From ``kernel.prepare``, ``kernel.at_rest`` and ``planes.prepare``, which may be None; the
        last two are changed.
    controls, probes : ndarray [shape=(frames, columns)]
        As of ``kernel.advance``; C-contiguous.
    ledger : ndarray [shape=(frames, len(LEDGER))], optional
        As of `advance_with_ledger`; C-contiguous.

    Raises
    ------
    ValueError
        Where the rows are of another shape, or do not lie one after another.
    """
    which, frames, fingers = kernel_of(more), len(controls), int(model["fingers"][0])
    shapes = [(controls, control_columns(fingers)), (probes, probe_columns(fingers))]
    shapes += [] if ledger is None else [(ledger, len(LEDGER))]
    for rows, columns in shapes:
        if rows.shape != (frames, columns) or not rows.flags.c_contiguous:
            raise ValueError(f"{rows.shape}: expected {frames} rows of {columns} numbers")
    arrays = (model, state, model if more is None else more, controls, probes)
    places = [array.ctypes.data for array in arrays]
    directions = 2 if has_two_directions(more) else 1
    if ledger is not None:
        advance_with_ledger.call(which, directions, *places, ledger.ctypes.data, frames)
    elif which == 0:
        advance.call(*places, 0, frames)
    elif directions == 2:
        advance_in_two_directions.call(*places, 0, frames)
    else:
        advance_refined.call(*places, 0, frames)
