"""A process can be given another processor, for ``scripts/test --all``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from as_processor import missing

TESTS = Path(__file__).parent

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
