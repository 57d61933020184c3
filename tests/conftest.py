"""Settings for all tests."""

import gc
import os
import pickle
import re
import signal
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import forks
import pytest
from commands import is_one_line
from hypothesis import settings
from platformdirs import user_config_path

# Set before numpy loads: the references' matrices are small, and the threads of two test processes
# would only compete.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# An instrument touches little of its memory: to clear all of it, by 2 MB at a time, took a fifth of
# the time of many tests.
os.environ.setdefault("NUMPY_MADVISE_HUGEPAGE", "0")

# The same cases on every machine, and no deadline: a first call may have to compile.
settings.register_profile("yehu", deadline=None, derandomize=True, database=None, max_examples=25)
settings.register_profile("long", settings.get_profile("yehu"), max_examples=200)
settings.load_profile("yehu")

COLLECT_AFTER = (50_000, 20, 20)  # objects: Python's own 700 would look through all of them often

WAITING = {"ahead", "documentation", "page", "real_time"}  # folders of tests that mostly wait
LONGEST = {  # begun last, one of these would leave the other workers nothing to do
    "test_documented_commands.py",
    "test_library.py",
    "test_renders.py",
    "test_stream.py",
    "test_wheel.py",
}
LAST_WAITS = 0.92  # of all files: when the last that waits begins


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--all"):
        settings.load_profile("long")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--all", action="store_true", help="also run the tests that are marked slow")


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Collect without the garbage collector: it would go through all that is kept, many times."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(*COLLECT_AFTER)
        gc.enable()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if not config.getoption("--all"):
        for item in items:
            if item.get_closest_marker("slow"):
                item.add_marker(pytest.mark.skip(reason="slow: run with --all"))
        if not any("::" in argument for argument in config.args):
            quick = [item for item in items if not item.get_closest_marker("slow")]
            left_out = set(combinations(quick))
            config.hook.pytest_deselected(items=list(left_out))
            items[:] = [item for item in items if item not in left_out]
    place = places(list(dict.fromkeys(item.path for item in items)))
    items.sort(key=lambda item: place[item.path])


def combinations(items: list[pytest.Item]) -> list[pytest.Item]:
    """Cases of tests with several axes that bring no value of an axis which others don't bring."""
    tests: dict[str, dict[pytest.Item, set[Any]]] = defaultdict(dict)
    for item in items:
        if len(marks := list(item.iter_markers("parametrize"))) > 1:
            axes = [re.findall(r"\w+", str(mark.args[0])) for mark in marks]
            values = item.callspec.params
            tests[item.nodeid.partition("[")[0]][item] = {
                tuple((name, id(values[name])) for name in names) for names in axes
            }
    for cases in tests.values():
        missing = set().union(*cases.values())
        while missing:
            missing -= cases.pop(max(cases, key=lambda case: len(cases[case] & missing)))
    return [case for cases in tests.values() for case in cases]


def places(files: list[Path]) -> dict[Path, float]:
    """When each file begins: the longest first, and those that mostly wait among the others."""
    waiting = [file for file in files if file.parent.name in WAITING]
    others = [file for file in files if file.parent.name not in WAITING]
    spread = {file: LAST_WAITS * n / len(waiting) for n, file in enumerate(waiting)}
    first = {file: -1.0 for file in files if file.name in LONGEST}
    return {file: n / len(others) for n, file in enumerate(others)} | spread | first


@pytest.fixture(scope="session")
def everything(request) -> bool:
    """Whether what is long is wanted as well: ``--all``."""
    return bool(request.config.getoption("--all"))


@pytest.fixture(scope="session")
def once(request, tmp_path_factory) -> Callable[[str, Callable[[Path], Any]], Any]:
    """What takes long to make is made by one worker, in a folder; the others read it."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if request.config.getoption("--workers") else base

    def made(name: str, make: Callable[[Path], Any]) -> Any:
        from yehu_server.util.processes import machine_lock

        folder = shared / name
        result = folder / "result.pickle"
        with machine_lock(shared, name):
            if not result.exists():
                folder.mkdir(exist_ok=True)
                result.write_bytes(pickle.dumps(make(folder)))
        return pickle.loads(result.read_bytes())  # noqa: S301 (written above)

    return made


@pytest.fixture(scope="session", autouse=True)
def _config_home(tmp_path_factory) -> Iterator[None]:
    """Keep tests from reading the mappings and settings of the user who runs them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))
        yield


@pytest.fixture
def config_home(tmp_path, monkeypatch) -> Path:
    """A folder of settings for one test."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    return tmp_path / "config"


@pytest.fixture(scope="session")
def own_presets(_config_home) -> Path:
    """The empty folder that stands for the user's own presets."""
    return user_config_path("yehu-server", appauthor=False) / "presets"


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    """Restore what tests change in this process: handlers of signals, where Pythons look, figures.

    Without the latter, scripts that are started later would not find what lies beside them.
    """
    changed = (signal.SIGTERM, signal.SIGINT, getattr(signal, "SIGHUP", signal.SIGTERM))
    before = {number: signal.getsignal(number) for number in changed}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)
    os.environ.pop("PYTHONSAFEPATH", None)
    if "matplotlib.pyplot" in sys.modules:  # else others would draw into the last one
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def command(capsys) -> Callable[..., tuple[int, str, str]]:
    """Run a command line in this process; its exit code, stdout and stderr."""
    from yehu_server.cli import main

    def run(*words: object) -> tuple[int, str, str]:
        try:
            code = main([str(word) for word in words])
        except SystemExit as end:
            code = end.code
        out, err = capsys.readouterr()
        return code, out, err

    return run


@pytest.fixture
def _forked_workers() -> Iterator[None]:
    """Let workers of `multiprocessing` begin as forks."""
    with forks.in_the_place_of_workers():
        yield


@pytest.fixture
def refused(command) -> Callable[..., str]:
    """Run a command line that must be refused in one line; that line."""

    def run(*words: object) -> str:
        code, out, err = command(*words)
        assert (code, out) == (2, "")
        assert is_one_line(err)
        return err

    return run


@pytest.fixture
def mappings(command) -> Callable[..., tuple[int, str, str]]:
    """Run ``yehu-server mappings``; its exit code, stdout and stderr."""
    return lambda *words: command("mappings", *words)
