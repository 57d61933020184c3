"""Constants that compiled code holds are the same on every processor."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from as_processor import CANNOT, PROCESSORS, V2, V3, V4, missing

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


@pytest.mark.skipif("x86-64" in missing(V2), reason="this is no x86-64 processor")
def test_another_processor_is_another_for_each_library():
    show = (
        "import yehu_server.compile.numba_compiler;"
        "from numba.core.registry import cpu_target; import numpy as np;"
        "print(*cpu_target.target_context.codegen().magic_tuple()[1:], sep='|');"
        "print(np.show_config(mode='dicts')['SIMD Extensions'].get('found') or [])"
    )
    command = [sys.executable, TESTS / "as_processor.py", V2, sys.executable, "-c", show]
    child = subprocess.run(command, capture_output=True, text=True, check=True)
    assert (child.stdout.splitlines(), child.stderr) == ([f"{V2}|", "[]"], "")


def test_a_processor_that_cannot_be_had_is_told(monkeypatch):
    monkeypatch.setattr("llvmlite.binding.get_host_cpu_features", lambda: {"avx2": True})
    assert {"avx512f", "fma"} <= set(missing(V4))
    assert "avx2" not in missing(V3)
