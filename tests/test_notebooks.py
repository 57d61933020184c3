"""The notebooks in ``examples/notebooks/`` run, and show pictures and sounds."""

import base64
import io
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from pages import ROOT

FOLDER = ROOT / "examples" / "notebooks"
RUNNER = ROOT / "tests" / "notebooks.py"
# How many pictures and players each shows.
SHOWN = {
    "1_first_sound.ipynb": (3, 3),
    "2_figures_of_the_paper.ipynb": (5, 2),
    "3_schelleng_diagram.ipynb": (3, 0),
    "4_your_own_body.ipynb": (3, 2),
}


def cells_of(path: Path) -> list[dict]:
    return json.loads(path.read_text("utf-8"))["cells"]


def code_of(path: Path) -> list[dict]:
    return [cell for cell in cells_of(path) if cell["cell_type"] == "code"]


@pytest.fixture
def environment(tmp_path) -> Iterator[dict[str, str]]:
    """Of a reader without settings; the paths of sockets must be short."""
    with tempfile.TemporaryDirectory(prefix="nb") as short:
        settings = {name: str(tmp_path / name) for name in ("IPYTHONDIR", "JUPYTER_CONFIG_DIR")}
        yield {**os.environ, **settings, "JUPYTER_RUNTIME_DIR": short, "MPLBACKEND": ""}


def run(name: str, folder: Path, environment: dict[str, str]) -> list[dict]:
    """Run a notebook in a folder; its outputs."""
    target = folder / "done.ipynb"
    command = [sys.executable, str(RUNNER), str(FOLDER / name), str(target)]
    del environment["MPLBACKEND"]
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return [output for cell in code_of(target) for output in cell["outputs"]]


def pictures(outputs: list[dict]) -> list[np.ndarray]:
    found = [output.get("data", {}).get("image/png") for output in outputs]
    return [matplotlib.image.imread(io.BytesIO(base64.b64decode(data))) for data in found if data]


@pytest.mark.slow
@pytest.mark.parametrize("name", SHOWN)
def test_a_notebook_runs_and_shows_pictures_and_sounds(name, tmp_path, environment):
    outputs = run(name, tmp_path, environment)
    printed = [output.get("name") for output in outputs]
    assert "stderr" not in printed, [each for each in outputs if each.get("name") == "stderr"]
    drawn = pictures(outputs)
    players = [each for each in outputs if "<audio" in str(each.get("data", {}).get("text/html"))]
    assert (len(drawn), len(players)) == SHOWN[name]
    for picture in drawn:
        assert picture.shape[0] > 200
        assert picture[..., :3].std() > 0.05
