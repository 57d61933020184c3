"""Compile what playing needs, before the first sound; or load it from the cache.

Where no machine code is kept or shipped for this processor and these sources, all is compiled, half
of it in a process of its own, which leaves it in the cache: parts call each other by name, so they
can be compiled at a time.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys

from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import IS_CACHED, cache_folder, source_hash
from yehu_server.compile.jit import IS_PLAIN
from yehu_server.core.engine.intake import interpret_events
from yehu_server.core.engine.mixing import mix, mix_block
from yehu_server.core.engine.native import (
    callback,
    frame_at,
    post,
    post_from,
    publish,
    read_meters,
    read_reports,
    taped,
)
from yehu_server.core.engine.sounding import sound, sound_block
from yehu_server.core.midi.interpret_events import NATIVE_FUNCTIONS, interpret
from yehu_server.core.physics.kernel import derive
from yehu_server.core.player.listening import attend
from yehu_server.core.player.wishes import fulfil
from yehu_server.util.sealed import SealError

# Compiled at a time: the model and the player in a process of their own, and what is sent to them.
MODEL = (sound, fulfil, attend, mix)
BESIDE = (
    *NATIVE_FUNCTIONS,
    interpret,
    derive,
    publish,
    read_meters,
    frame_at,
    post,
    post_from,
    read_reports,
    taped,
)
ALL_FUNCTIONS = (*MODEL, *BESIDE, interpret_events, sound_block, mix_block, callback)


def warm_up() -> None:
    """Compile all functions that playing needs, or load them from the cache."""
    if IS_PLAIN or is_warm():
        return
    with contextlib.ExitStack() as stack:
        beside = None
        if IS_CACHED and (os.cpu_count() or 1) > 1 and not sound.is_cached:
            command = [sys.executable, "-m", __name__]
            beside = subprocess.Popen(command, stderr=subprocess.DEVNULL)  # noqa: S603 - our own
            stack.callback(beside.kill)  # where we are interrupted
        for function in BESIDE:
            _ = function.address
        if beside is not None:
            beside.wait()
    for function in ALL_FUNCTIONS:
        _ = function.address
    if IS_CACHED:
        with contextlib.suppress(OSError, SealError):  # the cache has told of it
            machine_code.keep(cache_folder(), source_hash(), ALL_FUNCTIONS)
            machine_code.loaded.cache_clear()


def is_warm() -> bool:
    """Whether all functions that playing needs are kept, ready to be called."""
    kept = machine_code.loaded(cache_folder(), source_hash())
    return all(function.name in kept for function in ALL_FUNCTIONS)


if __name__ == "__main__":
    for part in MODEL:
        part.keep()
