"""Render the scores of a folder, on the cores of this machine or on a cluster."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
from collections.abc import Generator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.cli.arguments import instrument_of
from yehu_server.cli.folder_cluster import render_on_cluster
from yehu_server.cli.folder_tasks import Done, Line, Task, perform
from yehu_server.cli.playing_options import playing_options_of
from yehu_server.cli.terminal import (
    compile_all,
    print_result,
    progress_bar,
    warn,
)
from yehu_server.errors import one_line

if TYPE_CHECKING:
    from yehu_server.rendering.cluster import Cluster
    from yehu_server.rendering.workers import Event


class ProgressEstimate:
    """Counts the seconds of jobs: those that are done, and all.

    A job whose length nobody knows yet counts as the mean of the others; so files of one length
    count as files do.

    `known`: of each job; 0 where it is not known.
    """

    def __init__(self, known: Sequence[float]) -> None:
        self._known, self._shares = np.array(known, np.float64), np.zeros(len(known))

    def update(self, job: int, share: float, seconds: float = 0.0) -> None:
        """Take a job's share that is done, and its length where that is told (else 0)."""
        self._shares[job] = share
        if seconds > 0.0:
            self._known[job] = seconds

    @property
    def _lengths(self) -> Any:
        is_known = self._known > 0.0
        mean = self._known[is_known].mean() if is_known.any() else 1.0
        return np.where(is_known, self._known, mean)

    @property
    def done(self) -> float:
        """Seconds that are done, in all jobs."""
        return float(self._shares @ self._lengths)

    @property
    def total(self) -> float:
        """Seconds of all jobs."""
        return float(self._lengths.sum())


def prepare(arguments: argparse.Namespace, progress: Any = None) -> None:
    """Compile, and measure the instrument, once on a machine before all its processes need it."""
    from yehu_server.core.engine.warming import warm_up

    warm_up()
    playing = playing_options_of(arguments)
    playing.calibration(float(arguments.rate), instrument_of(arguments), progress)


def render_all(
    arguments: argparse.Namespace,
    tasks: Sequence[Task],
    total: int,
    lines: list[Line],
    cluster: Cluster | None,
) -> None:
    """Render all tasks; append what becomes of each to the lines of the manifest.

    `total`: number of scores in the folder, those that are up to date included.
    """
    if cluster is None:
        compile_all(arguments)
        with progress_bar(arguments, "calibrating", "notes") as progress:
            prepare(arguments, progress)
    ended = _on_cores(arguments, tasks) if cluster is None else render_on_cluster(tasks, cluster)
    number = total - len(tasks)
    seconds = ProgressEstimate([task.seconds for task in tasks])
    left = dict(enumerate(tasks))
    with progress_bar(arguments, "rendering", "s of sound") as progress, contextlib.closing(ended):
        for event in ended:
            done: Done | None = event.result
            if event.died:
                why = f"the process that rendered it was {event.died}"
                done = Done({"file": tasks[event.job].entry.name, "error": why})
            length = event.total if done is None else done.line.get("duration_s", 0.0)
            seconds.update(event.job, event.share, length)
            progress(seconds.done, seconds.total)
            if done is None:
                continue
            del left[event.job]
            lines.append(done.line)
            number += 1
            _tell_one(arguments, done.line, number, total)
            if done.is_full:
                warn("the disk is full: the rest is not rendered")
                break
    why = "not rendered: the disk is full"
    lines += [{"file": task.entry.name, "error": why} for task in left.values()]


def _on_cores(arguments: argparse.Namespace, tasks: Sequence[Task]) -> Generator[Event]:
    from yehu_server.rendering.workers import perform_all

    return perform_all(perform, tasks, min(arguments.jobs or os.cpu_count() or 1, len(tasks)))


def _tell_one(arguments: argparse.Namespace, line: Line, number: int, total: int) -> None:
    """Tell of a file: as JSON, or as a line where there is no progress bar."""
    if arguments.json:
        print(json.dumps(line), flush=True)
    elif not arguments.quiet and not sys.stderr.isatty():
        what = "failed" if "error" in line else f"{line['duration_s']:.1f} s"
        print_result(f"{number} of {total}: {one_line(line['file'])}: {what}", flush=True)
