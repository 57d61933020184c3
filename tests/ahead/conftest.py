import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from ahead.phrases import PHRASES, played

from yehu_server.ahead.build import page_linker, page_module
from yehu_server.ahead.interpreter import look_length
from yehu_server.compile import levels

HERE = Path(__file__).parent


@pytest.fixture(scope="session")
def wasm() -> Path:
    """The WebAssembly module of the present sources."""
    if page_linker() is None:
        pytest.skip("there is no wasm-ld")
    return page_module()


def _any_processor(folder: Path) -> Path:
    environment = {
        **os.environ,
        levels.VARIABLE: levels.lowest(),
        "PYTHONPATH": os.pathsep.join(map(str, (HERE.parent, HERE.parents[1]))),
    }
    command = [sys.executable, str(HERE / "phrases.py"), str(folder)]
    subprocess.run(command, env=environment, check=True, capture_output=True)
    return folder


@pytest.fixture(scope="session")
def library(once) -> Path:
    """A folder with the library, its header, and the phrases by code for any processor."""
    return once("any_processor", _any_processor)


@pytest.fixture(scope="session")
def here() -> dict[str, np.ndarray]:
    """The samples of each phrase [shape=(frames, 2)], by this process."""
    return {name: played(wishes)[0] for name, wishes in PHRASES.items()}


@pytest.fixture(scope="session")
def by_any_processor(library) -> dict[str, np.ndarray]:
    """The samples of each phrase, with instructions that any processor has."""
    read = {name: np.fromfile(library / f"{name}.f32", np.float32) for name in PHRASES}
    return {name: samples.reshape(-1, 2) for name, samples in read.items()}


@pytest.fixture
def node(tmp_path, wasm):
    """Runs one of this folder's scripts by Node, with a job; returns what it reports."""

    def run(script: str, **job):
        file = tmp_path / "job.json"
        file.write_text(json.dumps({"wasm": str(wasm), "lookLength": look_length(), **job}))
        command = ["node", str(HERE / script), str(file)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run
