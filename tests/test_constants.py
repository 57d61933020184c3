"""Constants that compiled code holds are the same on every processor."""

import subprocess
import sys
from pathlib import Path

import pytest
from as_processor import CANNOT, PROCESSORS, V2

TESTS = Path(__file__).parent
PRINT = """
import importlib, pkgutil, sys
import numpy as np
import yehu_server
parts = ("physics", "controls", "player", "stage", "engine")
for folder in ("params", *(f"core.{part}" for part in parts)):
    package = importlib.import_module(f"yehu_server.{folder}")
    for found in pkgutil.iter_modules(package.__path__):
        module = importlib.import_module(f"{package.__name__}.{found.name}")
        for name, value in sorted(vars(module).items()):
            if isinstance(value, float):
                print(module.__name__, name, value.hex())
            elif isinstance(value, np.ndarray) and value.dtype.kind == "f":
                print(module.__name__, name, *(each.hex() for each in value.ravel().tolist()))
"""


def constants(*command: str) -> list[str]:
    child = subprocess.run(
        [*command, sys.executable, "-c", PRINT], check=False, capture_output=True, text=True
    )
    if child.returncode == CANNOT:
        pytest.skip(child.stderr)
    child.check_returncode()
    return child.stdout.splitlines()


@pytest.fixture(scope="module")
def here() -> list[str]:
    return constants()


@pytest.mark.parametrize(
    "processor",  # the first has the least of what this one has
    [pytest.param(each, marks=[pytest.mark.slow][: each != V2]) for each in PROCESSORS],
)
def test_constants_are_the_same_on_every_processor(here, processor):
    other = constants(sys.executable, str(TESTS / "as_processor.py"), processor)
    assert [line for line in other if line not in here] == []
    assert len(other) == len(here)
