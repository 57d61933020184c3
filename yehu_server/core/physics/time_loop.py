"""All kernels as functions that are compiled apart, with or without a ledger of energy.

Playing, simulations, sweeps and tests call these, so that each is compiled once, and all of
them compute the very same samples.
"""

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
from yehu_server.core.physics import kernel, modal, refined, two_directions
from yehu_server.core.physics.energy import (
    record_energy,
    stored_energy,
    string_energy,
    strings_loss,
)
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
from yehu_server.core.physics.modal_string import MODAL, modal_energy, modal_loss
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


@native
def advance_modal(
    model: Any, state: Any, more: Any, controls: Any, probes: Any, begin: int, end: int
) -> None:
    """As ``modal.advance``, from row `begin` up to row `end`. All are pointers."""
    models, states = carray(model, (1,), MODEL), carray(state, (1,), STATE)
    rows, out = control_rows(models[0], controls, end), probe_rows(models[0], probes, end)
    modal.advance(models, states, carray(more, (1,), MODAL), rows[begin:end], out[begin:end])


PLAIN, IS_REFINED, IN_TWO_DIRECTIONS, IS_MODAL = range(4)
KERNELS = {
    REFINED.itemsize: (IS_REFINED, advance_refined),
    PLANES.itemsize: (IN_TWO_DIRECTIONS, advance_in_two_directions),
    MODAL.itemsize: (IS_MODAL, advance_modal),
}


def kind_of(more: Any) -> int:
    """What ``planes.prepare`` made: PLAIN for None, IS_REFINED, IN_TWO_DIRECTIONS or IS_MODAL."""
    return PLAIN if more is None else KERNELS[more.dtype.itemsize][0]


def kernel_of(more: Any) -> int:
    """Which kernel an instrument has, by what ``planes.prepare`` made for it: for `advance_by`.

    0 is the plain one. The others are named by their addresses, so that each is compiled with the
    first instrument that has it, and not where none has.
    """
    if more is None or IS_PLAIN:
        return kind_of(more)
    return int(KERNELS[more.dtype.itemsize][1].address)


def _plain_call(kernel: int, *arguments: Any) -> None:
    next(each for kind, each in KERNELS.values() if kind == kernel).function(*arguments)


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


@compiled_with_aliasing
def energy_of_strings(m: Model, s: Any, kind: int, more: Any, level: int) -> tuple[float, float]:
    """The energy of each string half a sample before a level of time (J)."""
    now = (level + 2) % LEVELS
    if kind == IS_MODAL:
        d = carray(more, (1,), MODAL)[0]
        return modal_energy(m, d, 0, level, now), modal_energy(m, d, 1, level, now)
    u, u_before = s.motion.u[level], s.motion.u[now]
    return string_energy(m, 0, u[0], u_before[0]), string_energy(m, 1, u[1], u_before[1])


@native
def advance_with_ledger(
    which: int, kind: int, model: Any, state: Any, more: Any, controls: Any, probes: Any,
    ledger: Any, end: int,
) -> None:  # fmt: skip
    """As `advance_by` from the first row on, and keep the energy ledger.

    `kind` is of `kind_of`; `ledger` a pointer to an array [shape=(end, len(LEDGER))], which is
    written: NaN at a sample that lost the state.
    """
    m, s = carray(model, (1,), MODEL)[0], carray(state, (1,), STATE)[0]
    rows, out = control_rows(m, controls, end), probe_rows(m, probes, end)
    ledger_rows = carray(ledger, (end, len(LEDGER)), np.float64)
    level = int(s.motion.level)
    stored_more, now = 0.0, (level + 2) % LEVELS
    stored = stored_energy(m, s.motion, energy_of_strings(m, s, kind, more, level), level, now)
    if kind == IN_TWO_DIRECTIONS:
        d = carray(more, (1,), PLANES)[0]
        stored_more = two_directions.stored_energy(m, s, d, level, now)
    elif kind != PLAIN:
        stored_more = refined.stored_energy(m, carray(more, (1,), REFINED)[0], level, now)
    for n in range(end):
        advance_by(which, model, state, more, controls, probes, n, n + 1)
        if out[n, ITERATIONS] < 0.0:  # lost, and at rest
            ledger_rows[n] = np.nan
            stored, stored_more = 0.0, 0.0
            continue
        row, book, motion, level = rows[n], ledger_rows[n], s.motion, int(s.motion.level)
        prev = (level + 1) % LEVELS
        in_strings = energy_of_strings(m, s, kind, more, level)
        if kind == IS_MODAL:
            lost = modal_loss(m, carray(more, (1,), MODAL)[0], motion, level, prev)
        else:
            lost = strings_loss(m, motion, level, prev)
        stored = record_energy(m, motion, s.contacts, s.work, row, stored, in_strings, lost, book)
        if kind == IN_TWO_DIRECTIONS:
            d = carray(more, (1,), PLANES)[0]
            stored_more = two_directions.record_planes(m, s, d, row, stored_more, book)
        elif kind != PLAIN:
            t = carray(more, (1,), REFINED)[0]
            stored_more = refined.record_points(m, s, t, row, stored_more, book)


def run(
    model: Any, state: Any, more: Any, controls: Array, probes: Array, ledger: Array | None = None
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
    kind = kind_of(more)
    if ledger is not None:
        advance_with_ledger.call(which, kind, *places, ledger.ctypes.data, frames)
    elif kind == PLAIN:
        advance.call(*places, 0, frames)
    else:
        KERNELS[more.dtype.itemsize][1].call(*places, 0, frames)
