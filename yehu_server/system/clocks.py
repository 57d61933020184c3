"""The clocks that all processes of a machine share, in Python and for compiled code."""

import ctypes
import sys
import time
from typing import Any

# `time.monotonic_ns` has steps of 16 ms on Windows before Python 3.13.
monotonic_ns = time.perf_counter_ns if sys.platform == "win32" else time.monotonic_ns
"""The time since some moment (ns), the same in all processes of the machine."""

# Clocks of clock_gettime. `monotonic_ns` reads the first.
MONOTONIC, THREAD_CPU = (8, 16) if sys.platform == "darwin" else (1, 3)
NS = 1_000_000_000  # in a second
TICK_NS, TICKS_TO_1970 = 100, 116_444_736_000_000_000  # of Windows, from 1601
WINDOWS_CLOCKS = ("QueryPerformanceCounter", "QueryPerformanceFrequency")


def now_s() -> float:
    """The system's clock (s since 1970); `time.time` has steps of 16 ms there, too."""
    if sys.platform != "win32":
        return time.time()
    ticks = ctypes.c_uint64()
    ctypes.WinDLL("kernel32").GetSystemTimePreciseAsFileTime(ctypes.byref(ticks))
    return (ticks.value - TICKS_TO_1970) * TICK_NS / NS


def provide() -> None:
    """Let compiled code of this process find the functions that its clocks call."""
    if sys.platform == "win32":
        from llvmlite import binding

        kernel = ctypes.WinDLL("kernel32")
        for name in WINDOWS_CLOCKS:
            binding.add_symbol(name, ctypes.cast(getattr(kernel, name), ctypes.c_void_p).value)


def monotonic_code(builder: Any) -> Any:
    """Generate code that reads `monotonic_ns`, as an integer of LLVM."""
    return _counter(builder) if sys.platform == "win32" else _posix(builder, MONOTONIC)


def thread_cpu_code(builder: Any) -> Any:
    """Generate code that reads the CPU time of its thread (ns).

    On Windows, `monotonic_ns`: there CPU time has steps of 16 ms, longer than most deadlines.
    """
    return _counter(builder) if sys.platform == "win32" else _posix(builder, THREAD_CPU)


def _posix(builder: Any, number: int) -> Any:
    from llvmlite import ir

    word = ir.IntType(64)
    times = _place(builder, ir.ArrayType(word, 2))  # a struct timespec
    _call(builder, "clock_gettime", ir.Constant(ir.IntType(32), number), times)
    seconds, ns = (_load(builder, times, index) for index in (0, 1))
    return builder.add(builder.mul(seconds, ir.Constant(word, NS)), ns)


def _counter(builder: Any) -> Any:
    """What `time.perf_counter_ns` computes: ticks, by their number in a second."""
    from llvmlite import ir

    word = ir.IntType(64)
    read = []
    for name in WINDOWS_CLOCKS:
        place = _place(builder, ir.ArrayType(word, 1))
        _call(builder, name, place)
        read.append(_load(builder, place, 0))
    ticks, per_second = read
    second = ir.Constant(word, NS)
    whole = builder.mul(builder.sdiv(ticks, per_second), second)
    rest = builder.mul(builder.srem(ticks, per_second), second)
    return builder.add(whole, builder.sdiv(rest, per_second))


def _place(builder: Any, kind: Any) -> Any:
    from numba.core import cgutils

    return cgutils.alloca_once(builder, kind)


def _load(builder: Any, place: Any, index: int) -> Any:
    from numba.core import cgutils

    return builder.load(cgutils.gep_inbounds(builder, place, 0, index))


def _call(builder: Any, name: str, *arguments: Any) -> Any:
    from llvmlite import ir
    from numba.core import cgutils

    kind = ir.FunctionType(ir.IntType(32), [argument.type for argument in arguments])
    builder.call(cgutils.get_or_insert_function(builder.module, kind, name), arguments)
