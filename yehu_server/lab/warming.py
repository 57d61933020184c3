"""Compile what simulations and sweeps need besides playing; or load it from the cache."""

from __future__ import annotations

import contextlib

from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import IS_CACHED, cache_folder, source_hash
from yehu_server.compile.jit import IS_PLAIN, Native, with_called
from yehu_server.core.engine import warming
from yehu_server.core.physics.time_loop import advance_booked, advance_refined
from yehu_server.lab.regimes.strokes import bow_stroke
from yehu_server.util.sealed import SealError

CALLED = (advance_refined, advance_booked, bow_stroke)


def all_functions() -> tuple[Native, ...]:
    """All functions that these need and playing does not, each after those that it calls."""
    return tuple(call for call in with_called(CALLED) if call not in warming.all_functions())


def warm_up(processes: int = 2) -> None:
    """Compile what playing, simulations and sweeps need, or load it from the cache.

    `processes`: see `core.engine.warming.warm_up`.
    """
    if IS_PLAIN:
        return
    is_kept = all(function.is_kept for function in CALLED)
    if not is_kept:
        # First: what compiles for pages meanwhile comes to these parts of the model last.
        for function in all_functions():
            _ = function.address
    warming.warm_up(processes)
    if IS_CACHED and not is_kept:
        with contextlib.suppress(OSError, SealError):  # the cache has told of it
            machine_code.keep(cache_folder(), source_hash(), all_functions(), machine_code.LAB)
            machine_code.loaded.cache_clear()
