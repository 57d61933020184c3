"""Compile what simulations and sweeps need besides playing; or load it from the cache."""

from __future__ import annotations

from yehu_server.compile import machine_code
from yehu_server.compile.helpers import Progress
from yehu_server.compile.jit import IS_PLAIN, Native, with_called
from yehu_server.core.engine import warming
from yehu_server.core.physics.time_loop import advance_booked, advance_refined
from yehu_server.lab.regimes.strokes import bow_stroke

CALLED = (advance_refined, advance_booked, bow_stroke)


def all_functions() -> tuple[Native, ...]:
    """All functions that these need and playing does not, each after those that it calls."""
    return tuple(call for call in with_called(CALLED) if call not in warming.all_functions())


def warm_up(processes: int = 2, progress: Progress | None = None) -> None:
    """Compile what playing, simulations and sweeps need, or load it from the cache.

    `processes`, `progress`: see `core.engine.warming.warm_up`; the second one begins twice.
    """
    warming.warm_up(processes, progress)
    if not IS_PLAIN and not all(function.is_kept for function in CALLED):
        warming.keep_all(all_functions(), machine_code.LAB, processes, progress)
