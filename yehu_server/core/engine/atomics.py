"""Atomic loads and stores for memory that threads or processes share. Compiled.

A thread that reads the value of a `store_release` by `load_acquire` sees all that was written
before it. On x86 these are plain moves, on ARM ``stlr`` and ``ldar``.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import Deferred, imported, intrinsic
from yehu_server.compile.memory import WORD, carray

# Imported where something is compiled.
ir = Deferred(lambda: imported("llvmlite.ir"))
types = Deferred(lambda: imported("numba").types)


def _plain_at(base: int, offset: int) -> int:
    return base + offset


def _plain_record_at(base: int, offset: int, kind: Any) -> Any:
    return carray(base + offset, (1,), kind)[0]


def _plain_pointer(address: int) -> int:
    return address


def _plain_load(base: int, offset: int) -> int:
    return int(carray(base + offset, (1,), np.int64)[0])


def _plain_store(base: int, offset: int, value: int) -> None:
    carray(base + offset, (1,), np.int64)[0] = value


def _no_fence() -> None:
    pass


@intrinsic(plain=_plain_at)
def at(_context: Any, base: Any, offset: Any) -> Any:
    """The address `offset` bytes after `base`."""

    def generate(_codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.gep(arguments[0], [arguments[1]])

    return types.voidptr(types.voidptr, types.int64), generate


@intrinsic(plain=_plain_record_at)
def record_at(_context: Any, base: Any, offset: Any, kind: Any) -> Any:
    """The record of a dtype `offset` bytes after `base`; nothing is copied."""

    def generate(codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        place = builder.gep(arguments[0], [arguments[1]])
        return builder.bitcast(place, codegen.get_value_type(kind.dtype))

    return kind.dtype(types.voidptr, types.int64, kind), generate


@intrinsic(plain=_plain_pointer)
def pointer(_context: Any, address: Any) -> Any:
    """The pointer to an address that a record has as a number."""

    def generate(_codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], ir.IntType(8).as_pointer())

    return types.voidptr(types.int64), generate


@intrinsic(plain=_plain_load)
def load_acquire(_context: Any, base: Any, offset: Any) -> Any:
    """Load the 64-bit integer `offset` bytes after `base`."""

    def generate(_codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.load_atomic(_word(builder, arguments), "acquire", WORD)

    return types.int64(types.voidptr, types.int64), generate


@intrinsic(plain=_plain_store)
def store_release(_context: Any, base: Any, offset: Any, value: Any) -> Any:
    """Store a 64-bit integer `offset` bytes after `base`."""

    def generate(_codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        builder.store_atomic(arguments[2], _word(builder, arguments), "release", WORD)

    return types.void(types.voidptr, types.int64, types.int64), generate


@intrinsic(plain=_no_fence)
def fence_release(_context: Any) -> Any:
    """Order later stores after earlier loads and stores."""

    def generate(_codegen: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        builder.fence("release")

    return types.void(), generate


@intrinsic(plain=_no_fence)
def fence_acquire(_context: Any) -> Any:
    """Order later loads and stores after earlier loads."""

    def generate(_codegen: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        builder.fence("acquire")

    return types.void(), generate


def _word(builder: Any, arguments: Any) -> Any:
    return builder.bitcast(builder.gep(arguments[0], [arguments[1]]), ir.IntType(64).as_pointer())
