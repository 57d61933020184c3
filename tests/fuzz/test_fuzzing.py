"""Some moments of fuzzing, and the fuzzer itself: it reports each finding once."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from fuzz import bounds
from fuzz.findings import broken
from fuzz.target import ROOT, Target

RUN = Path(__file__).parent / "run.py"
TARGETS_TAKE_S = 0.2  # each; scripts/test --all takes ten minutes


@pytest.mark.slow
def test_a_moment_of_fuzzing_each_finds_nothing(tmp_path):
    engine = ("--engine", "hypothesis")  # atheris takes a second at least
    words = [sys.executable, RUN, *engine, "--seconds", TARGETS_TAKE_S, "--findings", tmp_path]
    done = subprocess.run(
        [str(word) for word in words], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert not list(tmp_path.iterdir())


# ---------------------------------------------------------------- the fuzzer


def test_an_input_that_takes_too_long_is_a_finding(monkeypatch):
    monkeypatch.setattr(bounds, "MOST_CPU_S", 0.05)

    def patient(data: bytes) -> None:
        while data:
            try:
                sum(range(1000))
            except Exception:  # noqa: BLE001, S112 - as a reader that suppresses much
                continue

    assert isinstance(broken(Target("patient", patient), b"x"), bounds.TooSlowError)


@pytest.mark.skipif(not bounds.STATM.exists(), reason="memory is bounded on Linux only")
def test_an_input_that_takes_too_much_memory_is_a_finding():
    def greedy(data: bytes) -> None:
        assert bytearray(len(data) << 32)  # more than any bound

    assert isinstance(broken(Target("greedy", greedy), b"x"), MemoryError)
    assert broken(Target("greedy", greedy), b"") is not None
    assert bytearray(1 << 28)  # the bound holds for the input only
