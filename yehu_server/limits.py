"""Raise the limit of open files, which include sockets and pipes."""

from __future__ import annotations

import contextlib

from yehu_server.errors import YehuError

try:
    import resource
except ImportError:  # not on Windows, where there is no such limit
    resource = None  # type: ignore[assignment]

MOST_FILES = 4096  # more than all clients together need


def allow_files(needed: int) -> None:
    """Raise the limit of open files as far as allowed; the default of macOS is 256.

    Raises
    ------
    YehuError
        Where it is below `needed`.
    """
    if resource is None:
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    unlimited = resource.RLIM_INFINITY
    most = MOST_FILES if hard == unlimited else min(hard, MOST_FILES)
    if soft != unlimited and soft < most:
        with contextlib.suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
            soft = most
    if soft != unlimited and soft < needed:
        raise YehuError(
            f"{soft} open files are too few: {needed} are needed (raise the limit: ulimit -n)"
        )
