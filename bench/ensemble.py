"""How many instruments play in real time: on one core, on all, by rate and by fingers.

    .venv/bin/python bench/ensemble.py [--save bench/results/NAME.json]

Each instrument plays a bowed, stopped note in blocks of 128, with the default mapping's ordinary
bowing. Figures are medians over runs, with the spread. On several cores each thread plays its share
of the instruments, one block of each in turn, as a mixer asks for them.
"""

from __future__ import annotations

import argparse
import os
import threading
from typing import Any

import numpy as np
import report

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec

BLOCK, SECONDS, RUNS = 128, 0.5, 5
COUNTS = (1, 2, 4, 8, 16, 32, 64)
RATES = (22050.0, 44100.0, 48000.0, 96000.0, 192000.0)


def instrument(number: int, rate: float = 44100.0, fingers: int = 1) -> Instrument:
    """An instrument that bows a stopped note; the number varies its pitch."""
    made = Instrument(InstrumentSpec(rate))
    for finger in range(1, fingers + 1):
        made.write(f"/finger/{finger}/position", 0.11 - 0.02 * finger + 1e-3 * (number % 8))
        made.write(f"/finger/{finger}/press", 1.5)
    made.write("/bow/side", 1.0)
    made.write("/bow/speed", 0.2)
    play([made], 0.3)
    return made


def play(instruments: list[Instrument], seconds: float) -> None:
    """Play all instruments, block by block."""
    out = np.zeros(BLOCK, np.float32)
    for _ in range(round(seconds * instruments[0].rate / BLOCK)):
        for each in instruments:
            each.process(out)


def pace(instruments: list[Instrument], threads: int) -> dict[str, Any]:
    """Seconds of sound, of all instruments together, per second."""
    shares = [instruments[first::threads] for first in range(threads)]

    def play_all() -> None:
        workers = [
            threading.Thread(target=play, args=(share, SECONDS)) for share in shares if share
        ]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()

    paces = [len(instruments) * SECONDS / seconds for seconds in report.timed(play_all, RUNS)]
    return report.spread(paces, "in real time")


def measure(_: argparse.Namespace) -> dict[str, dict[str, Any]]:
    cores = os.cpu_count() or 1
    figures = {}
    for count in COUNTS:
        players = [instrument(number) for number in range(count)]
        figures[f"{count} instruments, one core"] = pace(players, 1)
        if count > 1:
            figures[f"{count} instruments, {cores} cores"] = pace(players, cores)
    for fingers in (1, 2, 3, 4):
        figures[f"{fingers} fingers pressed"] = pace([instrument(0, fingers=fingers)], 1)
    for rate in RATES:
        figures[f"{rate / 1e3:g} kHz"] = pace([instrument(0, rate)], 1)
    return figures


if __name__ == "__main__":
    report.run(__doc__, measure)
