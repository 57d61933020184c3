"""``import yehu_server``: its names, its examples, and what it does not load."""

import doctest
import importlib
import inspect
import pkgutil
import subprocess
import sys
from collections.abc import Iterator

import forks
import matplotlib as mpl
import pytest

import yehu_server as yehu
from yehu_lab import api as lab_api
from yehu_lab import plot as lab_plot
from yehu_server import api, plot
from yehu_server.errors import YehuError

HEAVY = {"numba", "llvmlite", "numpy", "matplotlib", "xarray", "scipy", "sounddevice", "IPython"}


def test_to_import_it_loads_nothing_heavy_and_matplotlib_waits_for_a_picture():
    names = "yehu_server.render, yehu_server.simulate, yehu_server.sweep, yehu_server.plot"
    for code, unwanted in (
        ("import yehu_server; yehu_server.YehuError", HEAVY),
        (f"import yehu_server; {names}", {"matplotlib", "xarray", "IPython"}),
    ):
        command = [sys.executable, "-c", f"{code}; import sys; print(*sys.modules)"]
        run = subprocess.run(command, capture_output=True, text=True, check=True)
        assert not {name.partition(".")[0] for name in run.stdout.split()} & unwanted


def test_no_module_hides_a_public_name():
    # Importing a module puts it into its package, in the place of what had its name.
    code = (
        "import importlib, pkgutil, yehu_server as y\n"
        "for m in pkgutil.walk_packages(y.__path__, 'yehu_server.'):\n"
        "    if not m.name.endswith('__main__') and '.cli' not in m.name:\n"
        "        try: importlib.import_module(m.name)\n"
        "        except ImportError: pass\n"
        "print(*(n for n in y.__all__ if not callable(getattr(y, n))))"
    )
    run = forks.run(code=code)
    assert run.stdout.split() == ["__version__", "body", "plot"]


def test_all_names_are_listed_and_a_wrong_one_is_reported_as_python_does():
    assert sorted(yehu.__all__) == dir(yehu)
    assert yehu.YehuError is YehuError
    with pytest.raises(AttributeError, match="no attribute 'rendr'"):
        yehu.rendr  # noqa: B018 - that is the test


# ---------------------------------------------------------------- examples


def modules() -> Iterator[str]:
    for package in (api, plot, lab_api, lab_plot):
        for found in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
            yield found.name
    yield "yehu_server"


@pytest.mark.parametrize("name", list(modules()))
def test_every_example_gives_what_it_says(name, tmp_path, monkeypatch):
    mpl.use("Agg")
    monkeypatch.chdir(tmp_path)
    module = importlib.import_module(name)
    result = doctest.testmod(module, optionflags=doctest.ELLIPSIS)
    assert result.failed == 0


def with_examples() -> Iterator[tuple[str, object]]:
    for name in yehu.__all__:
        found = getattr(yehu, name)
        if inspect.isroutine(found) or name in ("Instrument", "Note"):
            yield name, found
    for name in plot.__all__:
        yield f"plot.{name}", getattr(plot, name)
    for name in ("fit", "load"):
        yield f"body.{name}", getattr(yehu.body, name)


def test_every_public_function_has_an_example_and_tells_of_its_arguments_and_errors(subtests):
    for name, function in with_examples():
        with subtests.test(name):
            text = inspect.getdoc(function) or ""
            assert doctest.DocTestParser().get_examples(text)
            assert "Raises\n------" in text or name == "Note"
            assert [
                each for each in inspect.signature(function).parameters if each not in text
            ] == []
