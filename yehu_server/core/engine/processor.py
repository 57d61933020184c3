"""The processor's clocks and its treatment of denormal numbers. Compiled.

Denormal numbers (below 1e-308) slow some processors down a hundredfold. A decaying string has many
of them, so the audio thread flushes them to zero.
"""

import platform
import time
from typing import Any

from yehu_server.compile.jit import Deferred, imported, intrinsic
from yehu_server.system import clocks

# Imported where something is compiled.
ir = Deferred(lambda: imported("llvmlite.ir"))
types = Deferred(lambda: imported("numba").types)
cgutils = Deferred(lambda: imported("numba.core.cgutils"))

# x86: FTZ and DAZ (flush to zero, denormals are zero) in MXCSR; ARM: FZ in FPCR.
X86_BITS, ARM_BIT = 0x8040, 1 << 24


def _no_mode(_mode: int = 0) -> int:
    """Plain Python leaves the treatment of denormals as it is."""
    return 0


@intrinsic(plain=clocks.monotonic_ns)
def monotonic_ns(_context: Any) -> Any:
    """The time of `clocks.monotonic_ns`, the same in all processes."""

    def generate(_codegen: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        return clocks.monotonic_code(builder)

    return types.int64(), generate


@intrinsic(plain=time.thread_time_ns)
def thread_cpu_ns(_context: Any) -> Any:
    """CPU time of this thread (ns)."""

    def generate(_codegen: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        return clocks.thread_cpu_code(builder)

    return types.int64(), generate


def _read_mode(builder: Any, machine: str) -> Any:
    if machine in X86:
        word = ir.IntType(32)
        place = cgutils.alloca_once(builder, word)
        _call(
            builder,
            "llvm.x86.sse.stmxcsr",
            ir.VoidType(),
            builder.bitcast(place, cgutils.voidptr_t),
        )
        return builder.zext(builder.load(place), ir.IntType(64))
    if machine in ARM:
        return _call(builder, "llvm.aarch64.get.fpcr", ir.IntType(64))
    return ir.Constant(ir.IntType(64), 0)


def _write_mode(builder: Any, machine: str, mode: Any) -> None:
    if machine in X86:
        word = ir.IntType(32)
        place = cgutils.alloca_once(builder, word)
        builder.store(builder.trunc(mode, word), place)
        _call(
            builder,
            "llvm.x86.sse.ldmxcsr",
            ir.VoidType(),
            builder.bitcast(place, cgutils.voidptr_t),
        )
    elif machine in ARM:
        _call(builder, "llvm.aarch64.set.fpcr", ir.VoidType(), mode)


def _call(builder: Any, name: str, returns: Any, *arguments: Any) -> Any:
    kind = ir.FunctionType(returns, [argument.type for argument in arguments])
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), arguments)


X86, ARM = {"x86_64", "AMD64"}, {"aarch64", "arm64"}


@intrinsic(plain=_no_mode)
def flush_denormals(_context: Any) -> Any:
    """Flush denormal numbers to zero on this thread from now on; return the mode before."""

    def generate(_codegen: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        machine = platform.machine()
        mode = _read_mode(builder, machine)
        bits = X86_BITS if machine in X86 else ARM_BIT
        _write_mode(builder, machine, builder.or_(mode, ir.Constant(ir.IntType(64), bits)))
        return mode

    return types.int64(), generate


@intrinsic(plain=_no_mode)
def restore_denormals(_context: Any, mode: Any) -> Any:
    """Restore the mode that `flush_denormals` returned."""

    def generate(_codegen: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        _write_mode(builder, platform.machine(), arguments[0])

    return types.void(types.int64), generate
