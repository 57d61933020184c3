"""Strokes of a sweep a second, beside what the kernel alone allows; printed, saved on request.

    .venv/bin/python bench/strokes.py [--save bench/results/NAME.json]

The strokes are a Schelleng diagram of 0.3 s each. The kernel's figure is the kernel over the
same controls, made in advance, without judging them. Times are medians of several runs.
"""

from __future__ import annotations

import argparse
import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import report

from yehu_lab.regimes.strokes import find
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import Study, study_of
from yehu_server.core.physics import kernel, layout, time_loop

RUNS = 5
DATA = {
    "duration": 0.3,
    "stroke": {"string": 1, "note": 70, "acceleration": 10.0},
    "vary": {
        "force": {"from": 0.05, "to": 5.0, "steps": 12, "spread": "log"},
        "position": {"from": 0.05, "to": 0.3, "steps": 10, "spread": "log"},
    },
}


def kernel_strokes(study: Study) -> list[Any]:
    """Model, state and arrays of each stroke, as `time_loop.run` takes them."""
    strokes = []
    for number in range(study.coarse):
        place = np.unravel_index(number, study.shape)
        gesture = study.bow.gesture(study.axes, [int(i) for i in place])
        model = kernel.prepare(gesture.quantities, gesture.sample_rate)
        controls = gesture.control_rows()
        probes = np.zeros((gesture.frames, layout.probe_columns(1)))
        strokes.append((model, kernel.at_rest(model), controls, probes))
    return strokes


def advance(stroke: Any) -> None:
    model, state, controls, probes = stroke
    state = state.copy()
    time_loop.run(model, state, None, controls, probes)


def paced(work: Callable[[], object], count: int) -> dict[str, Any]:
    """Strokes a second."""
    return report.spread([count / seconds for seconds in report.timed(work, RUNS)], "a second")


def measure(_: argparse.Namespace) -> dict[str, dict[str, Any]]:
    study = study_of(DATA)
    count, alone = study.coarse, kernel_strokes(study)
    index = np.stack(np.unravel_index(np.arange(count), study.shape), axis=1)
    strokes = study.bow.strokes(study.axes, index)
    cores = os.cpu_count() or 1
    print(f"strokes of 0.3 s at 44.1 kHz; load {os.getloadavg()[0]:.1f}")
    figures = {
        "kernel alone, 1 thread": paced(lambda: deque(map(advance, alone), maxlen=0), count),
        "strokes judged, 1 thread": paced(lambda: find(*strokes), count),
    }
    with ThreadPoolExecutor(cores) as pool:
        figures[f"kernel alone, {cores} threads"] = paced(
            lambda: list(pool.map(advance, alone)), count
        )
    figures[f"whole sweep, {cores} threads"] = paced(lambda: sweep(study, workers=cores), count)
    return figures


if __name__ == "__main__":
    report.run(__doc__, measure)
