"""How files are opened, and whose they are."""

import ctypes
import os
import stat
import sys

LIBRARY = {"win32": "{}.dll", "darwin": "lib{}.dylib"}.get(sys.platform, "lib{}.so")  # its file


def open_at_once(path: str, flags: int) -> int:
    """Open without blocking: opening a pipe would wait for its other end."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def open_private(path: str) -> int:
    """Open a file of this user's own to read and write; no link is followed."""
    return os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0), 0o600)


def is_own(status: os.stat_result) -> bool:
    """Whether a file is this user's, or the system does not say."""
    return sys.platform == "win32" or status.st_uid == os.getuid()


def may_others_write(status: os.stat_result) -> bool:
    """Whether another user, but for root, may write to a file, as far as the system says."""
    if sys.platform == "win32":
        return False
    return status.st_uid not in (0, os.getuid()) or bool(status.st_mode & stat.S_IWOTH)


def c_library() -> ctypes.CDLL:
    """The C library of this process."""
    return ctypes.CDLL("msvcrt" if sys.platform == "win32" else None)


def linker_options(file: str) -> list[str]:
    """What a linker is told beside ``-shared``, so that equal code gives equal files."""
    return ["-Wl,--build-id=none", f"-Wl,-soname,{file}"] if sys.platform == "linux" else []
