"""A wheel holds all that Python programs need: built, installed alone, and tried."""

import os
import re
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest
from pages import ROOT

# What each public name is tried with; printed is what it gave.
TRIED = """
import sys
import yehu_server as yehu

assert "numba" not in sys.modules
assert "site-packages" in yehu.__file__ and yehu.__file__.startswith(sys.prefix), yehu.__file__

import numpy as np

tune = yehu.render([yehu.Note("A4", 0.0, 0.2), ("C5", 0.2, 0.2)], preset="flautando+hall")
tune.save("tune.flac")
print("render", tune.sound.shape[1], yehu.render(sys.argv[1], tail=0.1).summary.notes_played > 10)
fiddle = yehu.Instrument(instrument={"string_1": {"sigma_0": 1.0}})
fiddle.note_on("G4")
print("Instrument", fiddle.play(0.1).shape, fiddle.record(0.1).arrays["bow_force"].shape)
controls = {"bow_force": 0.7, "bow_velocity": 0.3}
run = yehu.simulate({"duration": 0.05, "controls": controls}, energy=True, strings_every=10)
print("simulate", isinstance(run, yehu.Simulation), "energy" in run.arrays)
swept = yehu.sweep(
    {"duration": 0.05, "controls": controls},
    {"bow_position": [0.25, 0.26], "bow_force": [0.2, 0.8]},
)
print("sweep", swept.grid("regime").shape)
print("AudioWidget", len(yehu.AudioWidget(tune.sound, tune.sample_rate).wav()) > 1000)
for act in (lambda: yehu.plot.level(tune), swept.to_xarray, lambda: yehu.render("none.mid")):
    try:
        act()
        print("done")
    except yehu.YehuError as error:
        print("YehuError:", str(error).replace("\\n", "NEWLINE"))
"""
EXTRAS = ("matplotlib", "xarray", "scipy", "pyuff", "distributed")
WITHOUT = f"import sys; sys.modules.update(dict.fromkeys({EXTRAS}))\n"
WITH = "import matplotlib; matplotlib.use('Agg'); del matplotlib\n"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory) -> Path:
    """The Python of an environment with the wheel alone; dependencies come by PYTHONPATH."""
    folder = tmp_path_factory.mktemp("clean")
    venv.create(folder, with_pip=False)
    python = folder / "bin" / "python"
    command = ["pip", "install", "--offline", "--no-deps", "--python", str(python), str(wheel)]
    subprocess.run([sys.executable, "-m", "uv", *command], check=True, capture_output=True)
    return python


def tried(python: Path, code: str, folder: Path) -> list[str]:
    """What some code printed, in a folder that has nothing of the checkout."""
    # Of a folder on this path no .pth file is read, so the checkout itself is not found by it.
    environment = {**os.environ, "PYTHONPATH": sysconfig.get_path("purelib")}
    score = str(ROOT / "examples" / "shi_bei_jiu.mid")
    run = subprocess.run(
        [str(python), "-W", "error", "-c", code, score],
        capture_output=True,
        text=True,
        cwd=folder,
        env=environment,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    return run.stdout.splitlines()


DONE = [
    "render 2 True",
    "Instrument (4410,) (4410,)",
    "simulate True True",
    "sweep (2, 2)",
    "AudioWidget True",
]


@pytest.mark.slow
def test_all_public_names_work_from_a_wheel_without_extras(python, tmp_path):
    lines = tried(python, WITHOUT + TRIED, tmp_path)
    assert lines[:5] == DONE
    assert "yehu-server[plots]" in lines[5]
    assert "yehu-server[lab]" in lines[6]
    assert lines[7].startswith("YehuError: none.mid")
    assert (tmp_path / "tune.flac").stat().st_size > 1000


@pytest.mark.slow
def test_all_public_names_work_from_a_wheel_with_extras(python, tmp_path):
    lines = tried(python, WITH + TRIED, tmp_path)
    assert lines[:5] == DONE
    assert lines[5:7] == ["done", "done"]


@pytest.mark.slow
def test_a_wheel_has_a_command_types_notebooks_and_pages(wheel, python, tmp_path):
    code = "import sys; from yehu_server.cli import main; sys.exit(main({}))"
    assert tried(python, code.format(["--version"]), tmp_path)
    assert any("sweep" in line for line in tried(python, code.format(["--help"]), tmp_path))
    assert tried(python, code.format(["sweep", "--help"]), tmp_path)
    names = set(zipfile.ZipFile(wheel).namelist())
    assert names >= {
        "yehu_lab/plot/study_page.html",
        "yehu_lab/py.typed",
        "yehu_server/py.typed",
        "yehu_server/docs/python.md",
        "yehu_server/examples/notebooks/1_first_sound.ipynb",
        "yehu_server/web/main.js",
    }
    checkers = r"yehu_server/web/(node_modules|\.|[^/]*\.json$)"
    assert [name for name in names if re.match(checkers, name)] == []
