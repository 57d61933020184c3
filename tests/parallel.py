"""Run tests in several processes, each a fork of the one that has collected them: ``--workers``.

The workers of pytest-xdist each load and collect all tests again, and pass their reports through
pure Python: together a tenth of the processor time of this suite.
"""

import itertools
import multiprocessing
import os
import warnings
from collections import deque
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

import pytest

TO_END_S = 30.0  # for a worker to take down what its tests share


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--workers", type=int, metavar="N", help="run N files of tests at a time, in processes"
    )


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> bool | None:
    options = session.config.option
    if options.workers and not hasattr(os, "fork"):
        raise pytest.UsageError("--workers: this system cannot fork; leave it out")
    if not options.workers or options.collectonly or session.testsfailed:
        return None
    files = itertools.groupby(range(len(session.items)), lambda place: session.items[place].path)
    waiting = deque([*places] for _, places in files)
    workers: dict[Connection, Worker] = {}
    folder = session.config._tmp_path_factory.getbasetemp()
    folders = (folder / f"worker{number}" for number in itertools.count())
    try:
        while waiting or workers:
            while waiting and len(workers) < options.workers:
                worker = Worker(session, waiting, next(folders))
                workers[worker.link] = worker
            for link in wait(workers):
                if not workers[link].hear():
                    workers.pop(link).end()
                if session.shouldfail:
                    raise session.Failed(session.shouldfail)
    finally:
        for worker in workers.values():
            worker.process.terminate()
            worker.process.join(TO_END_S)
    return True


class Worker:
    """A process that runs tests, as the one knows it that tells it which."""

    def __init__(self, session: pytest.Session, waiting: deque[list[int]], folder: Path) -> None:
        self.session = session
        self.waiting = waiting  # files that nobody runs yet, by their tests' places
        self.given: list[int] = []  # tests that it has been told to run, and not yet begun
        self.runs: int | None = None
        self.link, theirs = multiprocessing.Pipe()
        fork = multiprocessing.get_context("fork")
        self.process = fork.Process(target=work, args=(session, theirs, folder))
        self.process.start()
        theirs.close()

    def hear(self) -> bool:
        """Do what its next message asks for; return whether there was one."""
        hook, config = self.session.config.hook, self.session.config
        try:
            name, what = self.link.recv()
            if name == "more":
                more = self.waiting.popleft() if self.waiting else []
                self.given += more
                self.link.send(more)
                return True
        except (EOFError, ConnectionError):
            return False
        if name == "begins":
            self.given.remove(what)
            self.runs = what
        elif name == "has run":
            self.runs = None
        elif name == "warning":
            hook.pytest_warning_recorded.call_historic(kwargs=what)
        else:
            report = hook.pytest_report_from_serializable(config=config, data=what)
            hook.pytest_runtest_logreport(report=report)
        return True

    def end(self) -> None:
        """Let another one run what it has left, if it has ended in the middle."""
        self.process.join()
        if self.given:
            self.waiting.appendleft(self.given)
        if self.runs is not None:
            item = self.session.items[self.runs]
            report = pytest.TestReport(
                nodeid=item.nodeid,
                location=item.location,
                keywords={},
                outcome="failed",
                longrepr=f"its process ended with exit code {self.process.exitcode}",
                when="call",
            )
            item.ihook.pytest_runtest_logreport(report=report)
        elif self.process.exitcode:
            self.session.shouldfail = f"a worker ended with exit code {self.process.exitcode}"


def work(session: pytest.Session, link: Connection, folder: Path) -> None:
    """Be a worker: run the tests that the other end of a link tells, with a folder for them."""
    config = session.config
    config.pluginmanager.unregister(name="terminalreporter")
    capture = config.pluginmanager.get_plugin("capturemanager")
    capture.stop_global_capturing()  # its files are shared with the other workers
    capture.start_global_capturing()
    config.option.basetemp = str(folder)
    config.pluginmanager.get_plugin("tmpdir").pytest_configure(config)
    teller = Teller(config, link)
    config.pluginmanager.register(teller)
    teller.is_new = False
    try:
        run_files(session, link)
    except KeyboardInterrupt:  # Ctrl-C, which ends all of them
        pass
    finally:
        capture.stop_global_capturing()  # or nobody would see what went wrong


def run_files(session: pytest.Session, link: Connection) -> None:
    """Run the tests that the other end of a link tells, by their places."""
    link.send(("more", None))
    places = deque(link.recv())
    while places:
        place = places.popleft()
        link.send(("begins", place))
        if not places:  # what comes next decides what is taken down after this one
            link.send(("more", None))
            places.extend(link.recv())
        item, following = session.items[place], session.items[places[0]] if places else None
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        link.send(("has run", place))


class Teller:
    """A plugin that tells the process above what happens in a worker."""

    def __init__(self, config: pytest.Config, link: Connection) -> None:
        self.config = config
        self.link = link
        self.is_new = True  # then it hears again of all warnings before the fork

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        data = self.config.hook.pytest_report_to_serializable(config=self.config, report=report)
        self.link.send(("report", data))

    def pytest_warning_recorded(
        self, warning_message: warnings.WarningMessage, when: str, nodeid: str, location: Any
    ) -> None:
        what = {"warning_message": warning_message, "when": when, "nodeid": nodeid}
        if not self.is_new:
            self.link.send(("warning", what | {"location": location}))
