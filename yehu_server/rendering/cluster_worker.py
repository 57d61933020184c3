"""A worker's part of a job, and who it is; light, as the scheduler loads it too."""

import pickle
import platform
import threading
from dataclasses import astuple, dataclass
from functools import cache
from typing import Any

from yehu_server.compile import levels
from yehu_server.util import PACKAGE, __version__
from yehu_server.util.processes import machine_lock
from yehu_server.util.source_key import key_of

_turn = threading.Lock()  # threads of one process take turns: warnings are gathered by process
_set_up: set[bytes] = set()  # of this process

DONE, FAILED, UNLIKE = range(3)


@dataclass(frozen=True)
class Identity:
    """What has to be the same for the same samples, and what may differ in the last bit."""

    version: str
    code: str  # key of all code of this package and of those beside it that use it
    level: str  # of processors, where LLVM is installed

    @property
    def shown(self) -> str:
        """Version and code, for a message."""
        return f"yehu-server {self.version} ({self.code[:8]})"


@cache
def identity() -> Identity:
    """Who this process is."""
    code = key_of(sorted(PACKAGE.parent.glob("yehu_*/**/*.py")))
    return Identity(__version__, code, _level())


def _level() -> str:
    try:
        return levels.level()
    except ImportError:  # a scheduler may go without LLVM
        return platform.machine()


def identity_of(sent: Any) -> Identity:
    """The identity that another process sent by `who`; one that is like none where it is none."""
    if isinstance(sent, (list, tuple)) and len(sent) == 3 and all(type(x) is str for x in sent):
        return Identity(*sent)
    return Identity("?", "", "")


def who() -> tuple[str, str, str]:
    """Return version, code and level of processors of this process, as plain texts."""
    return astuple(identity())


def do(job: bytes, code: str) -> bytes:
    """Do a job, a pickled function with its task and setup, as the same code would elsewhere.

    Returns a pair, packed: one of `DONE`, `FAILED` and `UNLIKE`; then what its function returned,
    what it raised, or `who` this process is, where it has another code.
    """
    import msgpack

    from yehu_server.compile.cache_folder import data_folder

    if code != identity().code:
        return bytes(msgpack.packb((UNLIKE, who())))
    perform, task, setup = pickle.loads(job)  # noqa: S301 - workers do what their scheduler says
    try:
        with _turn:
            if setup not in _set_up:
                with machine_lock(data_folder(), "setup"):
                    pickle.loads(setup)()  # noqa: S301
                _set_up.add(setup)
            return bytes(msgpack.packb((DONE, perform(task))))
    except Exception as error:  # noqa: BLE001 - no exception travels: it would be unpickled
        return bytes(msgpack.packb((FAILED, f"{type(error).__name__}: {error}")))


def no_setup() -> None:
    """Prepare nothing."""
