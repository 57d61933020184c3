"""How processes start, inherit, take their turn and end."""

import ctypes
import math
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from typing import IO, Any

PIPE_BYTES = 1 << 20  # buffer for events while the parent is stopped
F_SETPIPE_SZ = 1031  # of Linux
LOWER, LOWEST = 5, 19  # niceness
SIGNALS_EVERY_S = 0.1  # how often handlers of signals have their turn, on Windows
# Of Windows: BELOW_NORMAL_PRIORITY_CLASS, IDLE_PRIORITY_CLASS; and what goes before most programs.
CLASSES = {LOWER: 0x4000, LOWEST: 0x40}
HIGH_PRIORITY_CLASS, TIMER_MS = 0x80, 1
# Python's threads take short turns, so that a busy one does not delay the others.
SWITCH_INTERVAL_S = 0.0001
SCREENS = {"DISPLAY", "WAYLAND_DISPLAY"}  # where a program with windows may open them


def spawn_options(share: Sequence[int]) -> dict[str, Any]:
    """Arguments of `subprocess.Popen` for a child that inherits descriptors, and no Ctrl-C."""
    if sys.platform == "win32":
        return {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
    return {"pass_fds": share, "start_new_session": True}


def enlarge_pipe(pipe: IO[bytes]) -> None:
    """Enlarge a pipe, where that can be done, so that who writes does not wait for who reads."""
    if sys.platform == "linux":
        import fcntl

        fcntl.fcntl(pipe, F_SETPIPE_SZ, PIPE_BYTES)


def lower_priority(by: int) -> None:
    """Let other processes go first: LOWER, or LOWEST."""
    if sys.platform == "win32":
        _set_class(CLASSES[by])
    else:
        os.nice(by)


def be_prompt() -> None:
    """Let threads of this process go on soon after what they wait for.

    On Windows, beside busy programs, too, and after timeouts, else in steps of 16 ms.
    """
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    if sys.platform == "win32":
        _set_class(HIGH_PRIORITY_CLASS)
        ctypes.WinDLL("winmm").timeBeginPeriod(TIMER_MS)


def _set_class(priority: int) -> None:
    if sys.platform == "win32":
        kernel = ctypes.WinDLL("kernel32")
        kernel.SetPriorityClass(ctypes.c_void_p(kernel.GetCurrentProcess()), priority)


def allow_files(most: int) -> int | None:
    """Raise the limit of open files, up to so many; return it, None where there is none."""
    if sys.platform == "win32":
        return None
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft == resource.RLIM_INFINITY:
        return None
    wanted = most if hard == resource.RLIM_INFINITY else min(hard, most)
    if soft < wanted:
        try:
            resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
        except (OSError, ValueError):
            return soft
        return wanted
    return soft


def on_termination(handler: Callable[..., object]) -> None:
    """Call a function at SIGTERM, and at SIGHUP where that is not ignored.

    Under ``nohup`` it is ignored: the process goes on when its terminal is closed. On Windows,
    SIGBREAK stands for both.
    """
    signal.signal(signal.SIGTERM, handler)
    if sys.platform == "win32":
        signal.signal(signal.SIGBREAK, handler)
    elif signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        signal.signal(signal.SIGHUP, handler)


def wait_for(event: threading.Event, seconds: float | None = None) -> None:
    """Wait in the main thread; handlers of signals run meanwhile (on Windows: between waits)."""
    if sys.platform == "win32":
        end = math.inf if seconds is None else time.monotonic() + seconds
        while time.monotonic() < end and not event.wait(SIGNALS_EVERY_S):
            pass
    else:
        event.wait(seconds)


def terminate_main_thread() -> None:
    """Interrupt the main thread as SIGTERM does, from another thread."""
    if sys.platform == "win32":
        signal.raise_signal(signal.SIGTERM)
    else:
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGTERM)


def needs_no_screen() -> dict[str, str]:
    """What to add to the environment of a program with windows, so that it starts without any."""
    if sys.platform == "linux" and SCREENS.isdisjoint(os.environ):
        return {"QT_QPA_PLATFORM": "offscreen"}
    return {}
