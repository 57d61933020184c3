"""The bounds on one input: a second of CPU time, and 200 MB more than before."""

import contextlib
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

try:
    import resource
except ImportError:  # as on Windows: time alone is bounded
    resource = None

STATM = Path("/proc/self/statm")  # only Linux has it
MAX_CPU_S = 1.0
MAX_MEMORY_BYTES = 200 * 10**6


class TooSlowError(BaseException):
    """An input that takes too long; no reader may catch it."""


def _too_slow(_signal: int, _frame: FrameType | None) -> None:
    raise TooSlowError(f"more than {MAX_CPU_S:g} s of CPU time")


@contextlib.contextmanager
def bounded() -> Iterator[None]:
    """Bound the time and memory of the block. Errors: TooSlowError, MemoryError."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGPROF, _too_slow)
    if bounds_memory := resource is not None and STATM.exists():
        pages = int(STATM.read_text().split()[0])
        limits = resource.getrlimit(resource.RLIMIT_AS)
        most = pages * resource.getpagesize() + MAX_MEMORY_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most, limits[1]))
    signal.setitimer(signal.ITIMER_PROF, MAX_CPU_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        if bounds_memory:
            resource.setrlimit(resource.RLIMIT_AS, limits)
        signal.signal(signal.SIGPROF, before)
