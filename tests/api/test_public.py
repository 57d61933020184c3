"""``import yehu_server``: its names, its examples, and what it does not load."""

from __future__ import annotations

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
from yehu_server import api, plot
from yehu_server.cli import converters
from yehu_server.errors import YehuError
from yehu_server.lab import plot as lab_plot

HEAVY = {"numba", "llvmlite", "numpy", "matplotlib", "xarray", "scipy", "sounddevice", "IPython"}


def loaded(code: str) -> set[str]:
    """The top modules that a new process has loaded after some code."""
    code += "; import sys; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return {name.partition(".")[0] for name in run.stdout.split()}


def test_to_import_it_loads_nothing_heavy():
    assert not loaded("import yehu_server") & HEAVY


def test_its_error_loads_nothing_heavy():
    assert not loaded("import yehu_server; yehu_server.YehuError") & HEAVY


def test_matplotlib_waits_for_a_picture():
    names = "yehu_server.render, yehu_server.simulate, yehu_server.sweep, yehu_server.plot"
    assert not loaded(f"import yehu_server; {names}") & {"matplotlib", "xarray", "IPython"}


def test_the_public_names_are_these():
    assert sorted(yehu.__all__) == dir(yehu)
    assert set(yehu.__all__) == {
        *("AudioWidget", "Followed", "Instrument", "Note", "Rendering", "Simulation", "Sweep"),
        *(
            "YehuError",
            "__version__",
            "body",
            "Comparison",
            "compare",
            "follow",
            "play",
            "plot",
            "render",
            "simulate",
            "sweep",
        ),
    }
    assert set(plot.__all__) == {
        *("energy", "guettler", "level", "pitch", "regimes", "schelleng", "signals"),
        *("spectrogram", "strings", "sweep"),
    }


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


def test_a_wrong_name_is_told_as_python_does():
    with pytest.raises(AttributeError, match="no attribute 'rendr'"):
        yehu.rendr  # noqa: B018 - that is the test


def test_its_error_is_that_of_all_modules():
    assert yehu.YehuError is YehuError


def test_the_reference_pitch_has_the_range_of_the_command():
    from yehu_server.api import checks

    of_command = converters.LOWEST_A4, converters.HIGHEST_A4
    assert of_command == (checks.LOWEST_A4, checks.HIGHEST_A4)


# ---------------------------------------------------------------- examples


def modules() -> Iterator[str]:
    for package in (api, lab_plot):
        for found in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
            yield found.name
    yield "yehu_server"


@pytest.mark.parametrize("name", list(modules()))
def test_every_example_gives_what_it_says(name, tmp_path, monkeypatch):
    mpl.use("Agg")
    import matplotlib.pyplot as plt

    monkeypatch.chdir(tmp_path)
    module = importlib.import_module(name)
    result = doctest.testmod(module, optionflags=doctest.ELLIPSIS)
    plt.close("all")
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


def test_every_public_function_has_an_example(subtests):
    for name, function in list(with_examples()):
        with subtests.test(name=name, function=function):
            text = inspect.getdoc(function) or ""
            assert doctest.DocTestParser().get_examples(text), name
            assert "Raises\n------" in text or name == "Note"


def test_every_public_argument_is_described():
    for name, function in with_examples():
        text = inspect.getdoc(function) or ""
        for argument in inspect.signature(function).parameters:
            assert argument in text, f"{name}: {argument}"
