"""The page's folder as a browser gets it, and Node to run its modules."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from yehu_server.panel import facts

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def node() -> str:
    """The command of Node."""
    found = shutil.which("node")
    if found is None:
        pytest.skip("there is no Node here")
    return found


@pytest.fixture(scope="session")
def playing(tmp_path_factory) -> Path:
    """A folder with what means MIDI in the page, and the facts generated for it."""
    folder = tmp_path_factory.mktemp("web")
    shutil.copytree(ROOT / "web" / "playing", folder / "playing")
    shutil.copy(ROOT / "web" / "jsconfig.json", folder)
    (folder / "package.json").write_text('{"type": "module"}')
    facts.write(folder)
    return folder
