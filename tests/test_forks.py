"""A fork of the prepared process ends, reads and writes as a new Python does."""

from __future__ import annotations

import functools
import os
import signal
import subprocess
import sys

import forks
import pytest

WORDS = ("a", "b \udcff")
CODES = {
    "an exit code": "raise SystemExit(3)",
    "a sentence": "raise SystemExit('no such thing')",
    "a signal": "import os; os.kill(os.getpid(), 15)",
    "a reader that is gone": "import os; os.close(1); print(1)",
    # A shell's background jobs ignore interrupts, and what they start does.
    "an interrupt": "import _thread, signal; signal.signal(2, signal.default_int_handler)\n"
    "_thread.interrupt_main()\nwhile True: pass",
    "what is left at the end": (
        "import atexit, threading, time; atexit.register(print, 'second');"
        "threading.Thread(target=lambda: (time.sleep(0.1), print('first'))).start()"
    ),
    "its words": "import sys; print(sys.argv, __name__, sys.path[0] == '')",
    "its input": "import sys; print(sys.stdin.read().upper(), sys.stdin.isatty())",
    "its files": "import os; print(sorted(os.listdir('/proc/self/fd'))[:-1])",
    "its place": "import os; print(os.getcwd(), os.getppid(), os.getpgid(0), *os.environ.items())",
    "its signals": (
        "import signal; print({each: signal.getsignal(each) for each in signal.valid_signals()},"
        "signal.pthread_sigmask(signal.SIG_BLOCK, []))"
    ),
    "its log": "import logging, threading; print(logging.root.handlers, threading.enumerate()[1:])",
}


@pytest.fixture
def told(tmp_path):
    """What a process was and wrote, by the function that starts it."""
    options = {
        "stdin": subprocess.PIPE,
        "stdout": subprocess.PIPE,
        "stderr": subprocess.PIPE,
        "text": True,
        "cwd": tmp_path,
        "env": {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"},
    }

    def run(begin) -> tuple[int, str, str]:
        with begin(**options) as process:
            out, err = process.communicate("some text", 60.0)
        return process.returncode, out, err.rpartition("\n")[0].rpartition("\n")[2]

    return run


@pytest.mark.parametrize("code", CODES.values(), ids=CODES)
def test_a_fork_is_as_a_new_python(told, code):
    new = told(functools.partial(subprocess.Popen, [sys.executable, "-c", code, *WORDS]))
    assert told(functools.partial(forks.start, *WORDS, code=code)) == new


def test_a_fork_gets_the_files_that_it_shall_share():
    code = "import os, sys; os.write(int(sys.argv[1]), b'heard')"
    reading, writing = os.pipe()
    assert forks.run(writing, code=code, pass_fds=[writing]).returncode == 0
    os.close(writing)
    with os.fdopen(reading, "rb") as heard:
        assert heard.read() == b"heard"


def test_a_fork_can_be_stopped_and_killed_with_its_group():
    process = forks.start(code="import time; time.sleep(60)", start_new_session=True)
    assert os.getpgid(process.pid) == os.getsid(process.pid) == process.pid
    assert process.poll() is None
    os.killpg(process.pid, signal.SIGKILL)
    assert process.wait(10.0) == -signal.SIGKILL
    process.communicate()
