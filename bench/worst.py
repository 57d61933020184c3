"""The worst block: of hard playing, or beside random mixes of all that may be sent.

    .venv/bin/python bench/worst.py [--seconds 60] [--save bench/results/NAME.json]
    .venv/bin/python bench/worst.py --mixes 20 --seconds 2

Hard playing is everything that costs time: four fingers that trill, slide and press up to 6 N,
tremolo, wide vibrato, scratching and flautando, string crossings, plucks, strings being tuned. The
CPU time is that of this thread, which leaves out most of what else the machine does.

With --mixes, players by each door play beside random mixes of all that may be sent (``mixes.py``).
Each is played RUNS times, and the least CPU time of each block counts. Three bounds are judged:
each note is late by less than a block, none is lost but to a panic, and no callback takes more than
half its deadline.
"""

import argparse
import itertools
import random
import time
from typing import Any

import numpy as np
import report
from mixes import MOST_OF_DEADLINE, failures, figures

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import KINDS, WRITE
from yehu_server.params.table import ENGINE

RATE, BLOCK = 44100.0, 64
EVERY = 12  # blocks between two changes
HARD = {
    "/bow/speed": (-0.6, 0.6),
    "/bow/side": (-1.0, 1.0),
    "/bow/pressure": (0.05, 6.0),
    "/bow/position": (0.05, 0.3),
    "/bow/tremolo": (0.0, 16.0),
    "/bow/noise": (0.0, 0.3),
    "/vibrato/depth": (0.0, 100.0),
    "/pluck/force": (-3.0, 3.0),
    "/string/inner/tuning": (-100.0, 40.0),
    "/string/outer/loss": (0.3, 4.0),
    **{f"/finger/{number}/position": (0.01, 0.25) for number in (1, 2, 3, 4)},
    **{f"/finger/{number}/press": (-2.0, 6.0) for number in (1, 2, 3, 4)},  # below 0: up
}

BLOCKS, RUNS = (64, 128), 3


def play(instrument: Instrument, blocks: int) -> np.ndarray:
    """Play blocks; return the CPU time of each (s)."""
    chance = random.Random(7)  # noqa: S311 - for music, not secrets
    out = np.zeros(BLOCK, np.float32)
    times = np.zeros(blocks)
    known = {param.address: param for param in ENGINE}
    for block in range(blocks):
        if block % EVERY == 0:
            for address in chance.sample(sorted(HARD), 4):
                lo, hi = HARD[address]
                value = known[address].clamped(chance.uniform(lo, hi))
                if address == "/bow/side":
                    value = 1.0 if value > 0.0 else -1.0
                instrument.write(address, value)
        start = time.thread_time_ns()
        instrument.process(out)
        times[block] = 1e-9 * (time.thread_time_ns() - start)
    return times


def measure_mixes(mixes: int, seconds: float) -> dict[str, dict[str, Any]]:
    rows = {}
    for block, mix in itertools.product(BLOCKS, (*range(mixes + 1), *KINDS[WRITE:])):
        row = figures(mix, block, seconds, RUNS)
        missed = ", ".join(failures(row, block))
        rows[f"{block}, {mix or 'alone'}"] = {"": f"FAIL: {missed}" if missed else "PASS"} | row
    failed = [name for name, row in rows.items() if row[""] != "PASS"]
    most = f"no block longer than {MOST_OF_DEADLINE} of its deadline"
    verdict = f"FAIL: {'; '.join(failed)}" if failed else "PASS"
    print(f"bounds: each note late by less than a block, none lost, {most}: {verdict}")
    return rows


# ---------------------------------------------------------------- the whole


def measure(arguments: argparse.Namespace) -> dict[str, dict[str, float]]:
    if arguments.mixes:
        return measure_mixes(arguments.mixes, arguments.seconds)
    instrument = Instrument(InstrumentSpec(RATE))
    play(instrument, 100)
    times = play(instrument, round(arguments.seconds * RATE / BLOCK)) / (BLOCK / RATE)
    print(
        f"of the deadline of {1e3 * BLOCK / RATE:.2f} ms; {instrument.lost_states} lost states, "
        f"{instrument.unconverged_solves} unconverged solves"
    )
    shares = {"mean": times.mean(), "worst": times.max()}
    shares |= {f"{100 * share:g} %": np.quantile(times, share) for share in (0.999, 0.9999)}
    return {name: {"share": float(share)} for name, share in shares.items()}


if __name__ == "__main__":
    report.run(__doc__, measure, seconds=(60.0, "of playing"), mixes=(0, "random mixes"))
