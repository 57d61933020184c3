"""The model as an old processor computes it: a short version of ``scripts/test --all``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from as_processor import missing

TESTS = Path(__file__).parent
STEPS = "test_one_step_from_any_state_is_the_references_to_rounding[44100-modulation-1]"
CHOSEN = [
    f"physics/test_reference_step.py::{STEPS}",
    "physics/test_power.py",
    "physics/test_elementary.py",
]

here = pytest.mark.skipif("x86-64" in missing("generic"), reason="this is no x86-64 processor")


def run_as(name: str, *command: str, **variables: str) -> subprocess.CompletedProcess[str]:
    script = str(TESTS / "as_processor.py")
    return subprocess.run(
        [sys.executable, script, name, sys.executable, *command],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **variables},
    )


@here
def test_without_any_instruction_newer_than_2003_one_step_is_the_references(tmp_path):
    pytest_alone = ["-m", "pytest", "-p", "no:cacheprovider", "-p", "no:xdist"]
    nodes = [str(TESTS / node) for node in CHOSEN]
    child = run_as("generic", *pytest_alone, *nodes, NUMBA_CACHE_DIR=str(tmp_path))
    assert child.returncode == 0, child.stdout + child.stderr
    assert " skipped" not in child.stdout
    assert list(tmp_path.rglob("*.code"))  # it was compiled there and then


@here
def test_another_processor_is_another_for_each_library():
    show = (
        "from numba.core.registry import cpu_target; import numpy as np;"
        "print(*cpu_target.target_context.codegen().magic_tuple()[1:], sep='|');"
        "print(np.show_config(mode='dicts')['SIMD Extensions'].get('found') or [])"
    )
    child = run_as("generic", "-c", show)
    assert child.stdout.splitlines() == ["generic|", "[]"]
    assert child.stderr == ""


def test_a_processor_that_cannot_be_had_is_told(monkeypatch):
    monkeypatch.setattr("llvmlite.binding.get_host_cpu_features", lambda: {"avx2": True})
    assert {"avx512f", "fma"} <= set(missing("skylake-avx512"))
    assert "avx2" not in missing("haswell")
