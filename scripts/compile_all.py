"""Compile what playing, simulations and sweeps need; or load it from the cache.

    .venv/bin/python scripts/compile_all.py [PROCESSES]

scripts/test runs it before tests, scripts/release as it makes the machine code of a wheel.
"""

import sys

from yehu_lab.regimes import strokes
from yehu_server.core.engine import warming
from yehu_server.simulation import run

MORE = {**run.COMPILED, **strokes.COMPILED}


def warm_up(processes: int = 2) -> None:
    """Compile all, or load it from the cache; see `core.engine.warming.warm_up`."""
    warming.warm_up(processes, more=MORE)


if __name__ == "__main__":
    warm_up(*map(int, sys.argv[1:]))
