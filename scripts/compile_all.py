"""Compile what playing, simulations and sweeps need; or load it from the cache.

    .venv/bin/python scripts/compile_all.py [PROCESSES]

scripts/test runs it before tests, scripts/machine_code.py before a release.
"""

from __future__ import annotations

import sys

from yehu_lab.regimes.strokes import bow_stroke
from yehu_server.compile.jit import IS_PLAIN, Native, with_called
from yehu_server.compile.machine_code import SIMULATING
from yehu_server.core.engine import warming
from yehu_server.core.physics.time_loop import advance_booked, advance_refined

CALLED = {SIMULATING: (advance_refined, advance_booked), "yehu_lab": (bow_stroke,)}
"""What playing does not call, by the file that its machine code is kept in."""


def functions_of(what: str) -> tuple[Native, ...]:
    """The functions of a file beside playing's, each after those that it calls."""
    return tuple(call for call in with_called(CALLED[what]) if call not in warming.all_functions())


def warm_up(processes: int = 2) -> None:
    """Compile all, or load it from the cache; see `core.engine.warming.warm_up`."""
    warming.warm_up(processes)
    for what, called in CALLED.items():
        if not IS_PLAIN and not all(function.is_kept for function in called):
            warming.keep_all(functions_of(what), what, processes)


if __name__ == "__main__":
    warm_up(*map(int, sys.argv[1:]))
