"""The bounds on one input: a second of CPU time, and 200 MB more than before."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from collections.abc import Iterator
from types import FrameType

try:
    import resource

    STATM = os.open("/proc/self/statm", os.O_RDONLY)
except (ImportError, OSError):  # no Linux: time alone is bounded
    STATM = -1

MOST_CPU_S = 1.0
MOST_MEMORY_BYTES = 200 * 10**6


class TooSlowError(BaseException):
    """An input that takes too long; no reader may catch it."""


def _too_slow(_signal: int, _frame: FrameType | None) -> None:
    raise TooSlowError(f"more than {MOST_CPU_S:g} s of CPU time")


@contextlib.contextmanager
def bounded() -> Iterator[None]:
    """Bound the time and memory of the block. Errors: TooSlowError, MemoryError."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGPROF, _too_slow)
    if STATM >= 0:
        pages = int(os.pread(STATM, 64, 0).split()[0])
        limits = resource.getrlimit(resource.RLIMIT_AS)
        most = pages * resource.getpagesize() + MOST_MEMORY_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, limits[1]))
    signal.setitimer(signal.ITIMER_PROF, MOST_CPU_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        if STATM >= 0:
            resource.setrlimit(resource.RLIMIT_AS, limits)
        signal.signal(signal.SIGPROF, before)
