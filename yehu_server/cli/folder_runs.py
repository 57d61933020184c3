"""Render the scores of a folder, on the cores of this machine or on a cluster."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from yehu_server.cli.arguments import progress_bar, warn_of_compiling
from yehu_server.cli.folder_cluster import ClusterTransfer, absolute, perform_on_worker
from yehu_server.cli.folder_tasks import Done, Line, Task, perform
from yehu_server.cli.terminal import print_result, warn
from yehu_server.errors import one_line

if TYPE_CHECKING:
    from yehu_server.rendering.cluster import Cluster
    from yehu_server.rendering.workers import Event


class ProgressEstimate:
    """Counts the seconds of jobs: those that are done, and all.

    A job whose length nobody knows yet counts as the mean of the others; so files of one length
    count as files do.

    Parameters
    ----------
    known : sequence of float
        Of each job; 0 where it is not known.
    """

    def __init__(self, known: Sequence[float]) -> None:
        self._known = list(known)
        self._shares = [0.0] * len(self._known)
        self._number = sum(seconds > 0.0 for seconds in self._known)
        self._sum = sum(self._known)
        self._done = 0.0  # of those that are known,
        self._unknown_shares = 0.0  # and of the others

    def update(self, job: int, share: float, seconds: float = 0.0) -> None:
        """Take a job's share that is done, and its length where that is told (else 0)."""
        self._count(job, -1.0)
        if seconds > 0.0:
            self._number += self._known[job] == 0.0
            self._sum += seconds - self._known[job]
            self._known[job] = seconds
        self._shares[job] = share
        self._count(job, 1.0)

    def _count(self, job: int, sign: float) -> None:
        share = sign * self._shares[job]
        if self._known[job] > 0.0:
            self._done += share * self._known[job]
        else:
            self._unknown_shares += share

    @property
    def mean(self) -> float:
        """Of the jobs whose length is known; 1 where none is."""
        return self._sum / self._number if self._number else 1.0

    @property
    def done(self) -> float:
        """Seconds that are done, in all jobs."""
        return self._done + self._unknown_shares * self.mean

    @property
    def total(self) -> float:
        """Seconds of all jobs."""
        return self._sum + (len(self._known) - self._number) * self.mean


@contextlib.contextmanager
def cluster_of(arguments: argparse.Namespace) -> Iterator[Cluster | None]:
    """The cluster that --dask names, if it does, for the time of a block.

    Raises
    ------
    YehuError
        Where it cannot be used.
    """
    if arguments.dask is None:
        yield None
        return
    from yehu_server.rendering.cluster import Cluster

    files = absolute(arguments)
    setup = partial(prepare, files.rate, files.instrument, files.a4)
    with Cluster(arguments.dask, setup, warn) as cluster:
        yield cluster


def prepare(rate: int, instrument: Path | None, a4: float) -> None:
    """Compile, and measure the instrument, on a machine of a cluster."""
    from yehu_server.core.engine.warming import warm_up
    from yehu_server.core.physics.quantities import Quantities, read_quantities
    from yehu_server.playing.calibration_store import calibration_for

    warm_up()
    quantities = read_quantities(instrument) if instrument else Quantities()
    calibration_for(float(rate), quantities, a4=a4)


def _prepare_here(arguments: argparse.Namespace) -> None:
    """Compile, and measure the instrument, once before all processes need it."""
    from yehu_server.core.engine.warming import warm_up
    from yehu_server.core.physics.quantities import Quantities, read_quantities
    from yehu_server.playing.calibration_store import calibration_for

    warn_of_compiling(arguments)
    warm_up()
    quantities = read_quantities(arguments.instrument) if arguments.instrument else Quantities()
    with progress_bar(arguments, "calibrating", "notes") as progress:
        calibration_for(float(arguments.rate), quantities, a4=arguments.a4, progress=progress)


def render_all(
    arguments: argparse.Namespace,
    tasks: Sequence[Task],
    total: int,
    lines: list[Line],
    cluster: Cluster | None,
) -> None:
    """Render all tasks; append what becomes of each to the lines of the manifest.

    Parameters
    ----------
    total : int
        Number of scores in the folder, those that are up to date included.
    """
    if cluster is None:
        _prepare_here(arguments)
    ended = _on_cores(arguments, tasks) if cluster is None else _on_cluster(tasks, cluster)
    number = total - len(tasks)
    seconds = ProgressEstimate([task.seconds for task in tasks])
    left = dict(enumerate(tasks))
    with progress_bar(arguments, "rendering", "s of sound") as progress, contextlib.closing(ended):
        for event in ended:
            done: Done | None = event.result
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
    """Yield what becomes of tasks on processes of this machine; at the end of each, its `Done`."""
    from yehu_server.rendering.workers import perform_all

    workers = min(arguments.jobs or os.cpu_count() or 1, len(tasks))
    with contextlib.closing(perform_all(perform, tasks, workers)) as events:
        for event in events:
            yield _ended(event, event.job, tasks) if event.died else event


def _on_cluster(tasks: Sequence[Task], cluster: Cluster) -> Generator[Event]:
    """Yield what becomes of tasks on a cluster; at the end of each, its `Done`."""
    far = ClusterTransfer(absolute(tasks[0].arguments), cluster)
    unseen: list[int] = []
    with far.marked():
        for travel in (False, True):
            numbers = unseen if travel else range(len(tasks))
            some = far.tasks([tasks[job] for job in numbers], travel=travel)
            with contextlib.closing(cluster.perform_all(perform_on_worker, some)) as events:
                for event in events:
                    job = numbers[event.job]
                    if event.died:
                        yield _ended(event, job, tasks)
                    elif event.result.done is None:  # that worker does not see the folders
                        unseen.append(job)
                    else:
                        done = far.received(tasks[job], event.result)
                        yield replace(event, job=job, result=done)


def _ended(event: Event, job: int, tasks: Sequence[Task]) -> Event:
    """What is told of a task whose process died."""
    why = f"the process that rendered it was {event.died}"
    return replace(event, job=job, result=Done({"file": tasks[job].entry.name, "error": why}))


def _tell_one(arguments: argparse.Namespace, line: Line, number: int, total: int) -> None:
    """Tell of a file: as JSON, or as a line where there is no progress bar."""
    from yehu_server.rendering.build_records import line_of

    if arguments.json:
        print(line_of(line), flush=True)
    elif not arguments.quiet and not sys.stderr.isatty():
        what = "failed" if "error" in line else f"{line['duration_s']:.1f} s"
        print_result(f"{number} of {total}: {one_line(line['file'])}: {what}", flush=True)
