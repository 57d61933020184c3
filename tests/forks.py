"""Commands in processes of their own, forked from one that has loaded what they need.

To start Python and load the compiled code costs a second or two of a processor, and hundreds of
tests run a command. Each process of pytest has one prepared process (this file, run as a program),
which forks at a request: in the fork the standard streams, folder, environment and words are as
asked, and the code runs as `python -c` would run it, to Python's own end.

A test starts a true Python instead where it is about what only a new interpreter does: what it
imports, variables that are read at import, the first compilation, limits while it starts.
"""

import atexit
import contextlib
import ctypes
import functools
import gc
import importlib
import inspect
import json
import os
import pkgutil
import signal
import socket
import subprocess
import sys
import threading
import types
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from unittest import mock

from commands import COMMAND

PREPARED = (
    "multiprocessing.spawn",
    "numpy.random",
    "rich.console",
    "yehu_server.cli",
    "yehu_server.simulation.run",
    "yehu_server.live.server",
    "yehu_server.rendering.replay",
    "yehu_server.rendering.to_files",
    "yehu_server.rendering.workers",
    "yehu_server.scores.reading",
    "yehu_server.scores.smf",
    "yehu_server.scores.written",
)
HERE = Path(__file__).resolve().parent
# As it is before any test changes it; without the threads that a fork would lack.
ENVIRONMENT = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
HEADER_BYTES = 8
PID_BYTES = 4
MAX_FILES = 64
PR_SET_CHILD_SUBREAPER = 36

_asking = threading.Lock()


def start(*words: object, code: str = COMMAND, **options: Any) -> subprocess.Popen:
    """Start a command, or other code with some arguments.

    Its input is empty, its output and errors are pipes of text, where the options, those of
    `subprocess.Popen`, do not say otherwise.
    """
    streams = {"stdin": subprocess.DEVNULL} | dict.fromkeys(("stdout", "stderr"), subprocess.PIPE)
    begun = _Forked if sys.platform == "linux" else subprocess.Popen
    how = {"text": True} | streams | options
    return begun([sys.executable, "-c", code, *map(str, words)], **how)


def run(
    *words: object, given: Any = None, timeout: float = 120.0, **options: Any
) -> subprocess.CompletedProcess:
    """Run it to its end, with something on its input."""
    if given is not None:
        options["stdin"] = subprocess.PIPE
    with start(*words, **options) as process:
        try:
            out, err = process.communicate(given, timeout)
        except BaseException:
            process.kill()
            raise
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def _spawn(_python: object, words: list[str], files: Sequence[int]) -> int:
    """Start a process of `multiprocessing`; in the place of its `util.spawnv_passfds`."""
    code = words.index("-c") + 1
    return _forked(words[code], words[code + 1 :], {each: each for each in (0, 1, 2, *files)})


def in_the_place_of_workers() -> contextlib.AbstractContextManager[object]:
    """Let what `multiprocessing` spawns within a block begin as forks, where that is known."""
    if sys.platform != "linux":
        return contextlib.nullcontext()
    return mock.patch("multiprocessing.util.spawnv_passfds", _spawn)


class _Forked(subprocess.Popen):
    """A child of this process, as any that it starts; only that it begins as a fork of another."""

    def _execute_child(self, *arguments: Any) -> None:
        begin = inspect.signature(super()._execute_child).bind(*arguments).arguments
        assert begin["preexec_fn"] is None
        ends = ("p2cread", "p2cwrite", "c2pread", "c2pwrite", "errread", "errwrite")
        files = {each: each for each in (0, 1, 2, *begin["pass_fds"])}
        for number, end in enumerate(("p2cread", "c2pwrite", "errwrite")):
            if begin[end] != -1:
                files[number] = begin[end]
        self.pid = _forked(
            begin["args"][2],
            begin["args"][3:],
            files,
            environment=begin["env"],
            folder=begin["cwd"],
            in_own_session=begin["start_new_session"],
        )
        self._child_created = True
        self._close_pipe_fds(*(begin[end] for end in ends))


def _forked(
    code: str,
    words: Sequence[str],
    files: Mapping[int, int],
    *,
    environment: Mapping[str, str] | None = None,
    folder: object = None,
    in_own_session: bool = False,
) -> int:
    """Ask the prepared process for a fork that has our files by some numbers; return its ID."""
    request = {
        "code": code,
        "words": words,
        "files": [*files],
        "environment": {**(os.environ if environment is None else environment)},
        "folder": str(folder or Path.cwd()),
        "in_own_session": in_own_session,
        "is_deaf": signal.getsignal(signal.SIGINT) is signal.SIG_IGN,  # as behind nohup
    }
    text = json.dumps(request).encode()
    adopt = functools.partial(ctypes.CDLL(None).prctl, PR_SET_CHILD_SUBREAPER)
    with _asking:
        link = _prepared()
        adopt(1, 0, 0, 0)  # a grandchild whose parent ends becomes our child
        try:
            socket.send_fds(link, [len(text).to_bytes(HEADER_BYTES, "big")], [*files.values()])
            link.sendall(text)
            return int.from_bytes(_received(link, PID_BYTES), "big")
        finally:
            adopt(0, 0, 0, 0)


@functools.cache
def _prepared() -> socket.socket:
    """Start the prepared process, and return what it is asked by."""
    ours, theirs = socket.socketpair()
    with theirs:
        process = subprocess.Popen(
            [sys.executable, __file__, str(theirs.fileno())],
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL,
            cwd=HERE,
            env=ENVIRONMENT,
        )

    def end() -> None:
        ours.close()
        process.wait()

    atexit.register(end)
    return ours


def _received(link: socket.socket, count: int) -> bytes:
    text = b""
    while len(text) < count:
        more = link.recv(count - len(text))
        if not more:
            raise ConnectionError("the prepared process has ended")
        text += more
    return text


# ---------------------------------------------------------------- the prepared process


def _be_prepared(link: socket.socket) -> str:
    """Fork at each request, until nobody can ask any more; in a fork, return the code to run."""
    atexit.register(_leave)  # before what is imported does so: it comes last
    for module in PREPARED:
        importlib.import_module(module)
    for module in pkgutil.iter_modules(sys.modules["yehu_server.cli"].__path__):
        if module.name != "__main__":
            importlib.import_module(f"yehu_server.cli.{module.name}")
    importlib.import_module("yehu_server.core.engine.warming").warm_up()
    gc.collect()
    gc.freeze()  # a fork shares what it never touches
    assert len([*Path("/proc/self/task").iterdir()]) == 1
    # multiprocessing blocks signals while it starts its tracker, which may be the first request.
    signal.pthread_sigmask(signal.SIG_SETMASK, ())
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for pytest
    while True:
        header, files, *_ = socket.recv_fds(link, HEADER_BYTES, MAX_FILES)
        if not header:
            sys.exit()
        request = json.loads(_received(link, int.from_bytes(header, "big")))
        if _is_fork():
            if not request["is_deaf"]:
                signal.signal(signal.SIGINT, signal.default_int_handler)
            return _begin(request, files, link)
        for file in files:
            os.close(file)


def _leave() -> None:
    """Let Python end without taking every module apart, which copies all memory of the fork."""
    ctypes.pythonapi.Py_IncRef(ctypes.py_object([*sys.modules.values()]))
    for name in {*sys.modules} - {"builtins", "sys", "__main__"}:
        del sys.modules[name]


def _is_fork() -> bool:
    """Fork, for the client to be the parent; return whether this is the fork."""
    released, release = os.pipe()
    if between := os.fork():
        os.waitpid(between, 0)  # now the fork has its new parent
    elif os.fork():
        os._exit(0)
    os.close(release)
    if not between:
        os.read(released, 1)
    os.close(released)
    return not between


def _begin(request: dict[str, Any], files: list[int], link: socket.socket) -> str:
    """Be as a new process; return the code to run."""
    if request["in_own_session"]:
        os.setsid()
    with link:
        link.sendall(os.getpid().to_bytes(PID_BYTES, "big"))
    import fcntl  # not of Windows

    os.chdir(request["folder"])
    os.environ.clear()
    os.environ.update(request["environment"])
    above = 1 + max(*request["files"], *files)
    moved = [fcntl.fcntl(file, fcntl.F_DUPFD, above) for file in files]
    for file, number in zip(moved, request["files"], strict=True):
        os.dup2(file, number)
    open_files = {int(entry.name) for entry in Path("/proc/self/fd").iterdir()}
    for number in open_files - {*request["files"]}:
        with contextlib.suppress(OSError):  # that of the list is closed already
            os.close(number)
    for number, (name, mode) in enumerate({"stdin": "r", "stdout": "w", "stderr": "w"}.items()):
        old = getattr(sys, f"__{name}__")
        buffering = 1 if name == "stderr" or os.isatty(number) else -1
        new = os.fdopen(number, mode, buffering, old.encoding, old.errors, closefd=False)
        setattr(sys, name, new)
        setattr(sys, f"__{name}__", new)
    sys.argv = ["-c", *request["words"]]
    sys.path[0] = ""
    sys.modules["__main__"] = types.ModuleType("__main__")
    return request["code"]


if __name__ == "__main__":
    text = _be_prepared(socket.socket(fileno=int(sys.argv[1])))
    exec(compile(text, "<string>", "exec"), vars(sys.modules["__main__"]))  # noqa: S102
