"""Compile what playing needs, before the first sound; or load it from the cache.

Where no machine code is kept or shipped for this processor and these sources, all is compiled, half
of it in a process of its own, which leaves it in the cache: parts call each other by name, so they
can be compiled at a time.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
from functools import cache

from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import IS_CACHED, cache_folder, source_hash
from yehu_server.compile.jit import IS_PLAIN, Native, with_called
from yehu_server.core.engine.mixing import mix, mix_block
from yehu_server.core.engine.native import (
    callback,
    frame_at,
    post,
    post_from,
    read_meters,
    read_reports,
    taped,
)
from yehu_server.core.engine.sounding import sound, sound_block
from yehu_server.core.physics.kernel import derive
from yehu_server.util.processes import python_command
from yehu_server.util.sealed import SealError

CALLED = (
    callback, sound_block, mix_block, derive, post, post_from, frame_at, read_meters, read_reports,
    taped,
)  # fmt: skip
MODEL = (sound, mix)  # which, with what they call, are half of the work of compiling


@cache
def all_functions() -> tuple[Native, ...]:
    """All functions that playing needs, each after those that it calls."""
    return tuple(with_called(CALLED))


def warm_up(processes: int = 2) -> None:
    """Compile all functions that playing needs, or load them from the cache.

    `processes`: how many compile at a time, 1 or 2. Two are sooner ready where nothing else is
    done meanwhile, and take a quarter more of the processors' time.
    """
    if IS_PLAIN or is_warm():
        return
    with contextlib.ExitStack() as stack:
        beside = None
        processes = min(processes, os.cpu_count() or 1)
        if IS_CACHED and processes > 1 and not sound.is_cached:
            command = python_command("yehu_server.core.engine.warming")
            beside = subprocess.Popen(command, stderr=subprocess.DEVNULL)  # noqa: S603 - our own
            stack.callback(beside.kill)  # where we are interrupted
        model = with_called(MODEL).keys()
        for function in all_functions():
            if not with_called([function]).keys() & model:
                _ = function.address
        if beside is not None:
            beside.wait()
    for function in all_functions():
        _ = function.address
    if IS_CACHED:
        with contextlib.suppress(OSError, SealError):  # the cache has told of it
            machine_code.keep(cache_folder(), source_hash(), all_functions())
            machine_code.loaded.cache_clear()


def is_warm() -> bool:
    """Whether all functions that playing needs are kept, ready to be called."""
    return all(function.is_kept for function in CALLED)


if __name__ == "__main__":
    for part in with_called(MODEL):
        part.keep()
