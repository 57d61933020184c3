"""Some moments of fuzzing, and the fuzzer itself: it reports each finding once."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from fuzz import bounds, guessed
from fuzz.findings import Findings, broken, described, smaller
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


class RefusedError(Exception):
    pass


def fragile(data: bytes) -> None:
    """Any bytes are accepted, or refused where they begin with an x."""
    if data[:1] == b"x":
        raise RefusedError("begins with an x")
    if b"!" in data:
        raise ValueError("an exclamation mark")
    assert b"?" not in data


FRAGILE = Target("fragile", fragile, (RefusedError,), words=(b"!", b"?"))


def test_a_refusal_as_documented_is_no_finding():
    assert broken(FRAGILE, b"x!") is None
    assert isinstance(broken(FRAGILE, b"a!"), ValueError)


def test_each_place_that_breaks_is_one_finding(tmp_path):
    findings = Findings(FRAGILE, tmp_path)
    for data in (b"fine", b"1!", b"2!", b"3?", b"4?", b"x!"):
        findings.take(data)
    assert [file.read_bytes() for file in sorted(tmp_path.iterdir())] == [b"1!", b"3?"]


def test_a_finding_is_told_at_its_smallest():
    least = smaller(FRAGILE, b"a" * 1000 + b"!" + b"b" * 500)
    assert least == b"!"
    told = described(FRAGILE, least)
    assert "ValueError: an exclamation mark" in told
    assert "1 bytes: b'!'" in told


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


def test_guesses_find_what_breaks(tmp_path, capsys):
    guessed.fuzz(FRAGILE, 0.0, 1, tmp_path)
    executions, _ = guessed.figures(capsys.readouterr().err)
    assert executions == guessed.AT_ONCE
    assert list(tmp_path.iterdir())


def test_guidance_finds_what_breaks(tmp_path):
    pytest.importorskip("atheris", reason="atheris is not to be had here")
    program = f"""
import sys
sys.path[:0] = {[str(RUN.parents[1]), str(ROOT)]!r}
from pathlib import Path
from fuzz import guided
from fuzz.test_fuzzing import FRAGILE
guided.fuzz(FRAGILE, 1, 1, Path({str(tmp_path)!r}))
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    from fuzz import guided

    executions, _ = guided.figures(done.stderr)
    assert executions > 1
    assert len(list(tmp_path.glob("fragile-*"))) == 2
