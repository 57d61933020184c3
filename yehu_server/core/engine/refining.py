"""Calls the kernel of an instrument that is not plain (refined.py), where one is played. Compiled.

Few instruments are, and that kernel takes long to compile. So it is compiled with the first
such instrument, and the others call it by the address in their memory; 0 is the plain kernel.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.compile.jit import IS_PLAIN, Deferred, imported, intrinsic, native
from yehu_server.compile.memory import carray
from yehu_server.core.engine.atomics import at, record_at
from yehu_server.core.engine.output import OUTPUT
from yehu_server.core.engine.rig import MODEL_AT, OUTPUT_AT, REFINED_AT, STATE_AT
from yehu_server.core.physics import refined
from yehu_server.core.physics.layout import MODEL, REFINED, STATE

# Imported where something is compiled.
ir = Deferred(lambda: imported("llvmlite.ir"))
types = Deferred(lambda: imported("numba").types)


@native
def advance_refined(rig: Any, begin: int, end: int) -> None:
    """Advance the model of an instrument over some rows of its controls."""
    model = carray(at(rig, MODEL_AT), (1,), MODEL)
    state = carray(at(rig, STATE_AT), (1,), STATE)
    more = carray(at(rig, REFINED_AT), (1,), REFINED)
    o = record_at(rig, OUTPUT_AT, OUTPUT)
    refined.advance(model, state, more, o.controls[begin:end], o.probes[begin:end], None)


def refine(rig: Any, made: Any) -> None:
    """Give an instrument's memory (RIG) what ``refined.prepare`` made, or the plain kernel."""
    rig["refined"] = np.zeros(1, REFINED) if made is None else made
    is_plain = made is None
    rig["kernel"][0, 0] = 0 if is_plain else 1 if IS_PLAIN else advance_refined.address


def _plain_call(_address: int, rig: Any, begin: int, end: int) -> None:
    advance_refined.function(rig, begin, end)


@intrinsic(plain=_plain_call)
def advance_at(_context: Any, address: Any, rig: Any, begin: Any, end: Any) -> Any:
    """Call `advance_refined` by its address."""

    def generate(_codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        word, byte = ir.IntType(64), ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [byte, word, word])
        function = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(function, arguments[1:])

    return types.void(types.int64, types.voidptr, types.int64, types.int64), generate
