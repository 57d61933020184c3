"""How files are opened, and whose they are."""

import ctypes
import os
import stat
import sys
from pathlib import Path

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


def may_others_write(folder: Path) -> bool:
    """Whether another user, but for root, may write to a folder, as far as the system says.

    Or put another in its place, who may write to one that it lies in; or its group may, unless that
    has no other member.
    """
    real = folder.resolve()
    around = {*real.parents, *folder.absolute().parents}
    return _is_shared(real.stat()) or any(_is_shared(one.stat(), stat.S_ISVTX) for one in around)


def _is_shared(status: os.stat_result, sticky: int = 0) -> bool:
    """Whether others may write to a folder; with the bit `sticky` they replace nothing there."""
    if sys.platform == "win32":
        return False
    if status.st_uid not in (0, os.getuid()):
        return True
    if status.st_mode & sticky:
        return False
    by_group = bool(status.st_mode & stat.S_IWGRP) and not _is_private(status.st_gid)
    return by_group or bool(status.st_mode & stat.S_IWOTH)


def _is_private(group: int) -> bool:
    """Whether a group is root's, or this user's alone, as many systems give each user one."""
    if sys.platform == "win32":
        return False
    import grp
    import pwd

    try:
        name, found = pwd.getpwuid(os.getuid()).pw_name, grp.getgrgid(group)
    except KeyError:
        return group == 0
    return group == 0 or (found.gr_name == name and {*found.gr_mem} <= {name})


def c_library() -> ctypes.CDLL:
    """The C library of this process."""
    return ctypes.CDLL("msvcrt" if sys.platform == "win32" else None)


def linker_options(file: str) -> list[str]:
    """What a linker is told beside ``-shared``, so that equal code gives equal files."""
    return ["-Wl,--build-id=none", f"-Wl,-soname,{file}"] if sys.platform == "linux" else []
