import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from ahead.phrases import PHRASES, RATE, played

from yehu_server.ahead.build import HEADER_FILE, build, page_linker, page_module
from yehu_server.ahead.build_hash import build_hash
from yehu_server.ahead.interpreter import snapshot_length
from yehu_server.compile import levels
from yehu_server.compile.cache_folder import data_folder

HERE = Path(__file__).parent


@pytest.fixture(scope="session")
def wasm() -> Path:
    """The WebAssembly module of the present sources."""
    if page_linker() is None:
        pytest.skip("there is no wasm-ld")
    return page_module()


@pytest.fixture(scope="session")
def library(once) -> Path:
    """A folder with the library of this level, and its header; kept, as the page's module is."""
    folder = data_folder() / f"library-{RATE:.0f}-{levels.level()}-{build_hash()}"

    def make(_: Path) -> Path:
        if not (folder / HEADER_FILE).is_file():  # which is written last
            build("library", folder, rates=[RATE], level=levels.level())
        return folder

    return once("library", make)


@pytest.fixture(scope="session")
def here() -> dict[str, np.ndarray]:
    """The samples of each phrase [shape=(frames, 2)], by this process."""
    return {name: played(commands)[0] for name, commands in PHRASES.items()}


@pytest.fixture
def node(tmp_path, wasm):
    """Runs one of this folder's scripts by Node, with a job; returns what it reports."""

    def run(script: str, **job):
        file = tmp_path / "job.json"
        file.write_text(json.dumps({"wasm": str(wasm), "snapshotLength": snapshot_length(), **job}))
        command = ["node", str(HERE / script), str(file)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run
