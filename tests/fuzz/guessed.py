"""Fuzzing by hypothesis, without coverage guidance: seeds with some changes, and any bytes."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import hypothesis
from fuzz.findings import Findings
from fuzz.target import MOST_BYTES, Target
from hypothesis import strategies as st

AT_ONCE = 50  # examples, between two looks at the clock


def inputs(target: Target) -> st.SearchStrategy[bytes]:
    """Any bytes, and the target's seeds with some bytes changed."""
    seeds = list(target.seeds().values()) or [b""]
    pieces = st.binary(max_size=8)
    if target.words:
        pieces |= st.sampled_from(target.words)
    place = st.floats(0.0, 1.0)
    changes = st.lists(st.tuples(place, st.integers(0, 16), pieces), max_size=6)
    return st.binary(max_size=200) | st.builds(changed, st.sampled_from(seeds), changes)


def changed(data: bytes, changes: list[tuple[float, int, bytes]]) -> bytes:
    """The data with some bytes at each place (0 to 1) replaced by others."""
    for where, count, piece in changes:
        at = round(where * len(data))
        data = data[:at] + piece + data[at + count :]
    return data[:MOST_BYTES]


def fuzz(target: Target, seconds: float, seed: int, folder: Path) -> None:
    """Fuzz for some seconds; write the number of executions to stderr."""
    findings = Findings(target, folder)
    until, executions = time.monotonic() + seconds, 0
    for data in target.seeds().values():
        findings.take(data)

    def one(data: bytes) -> None:
        nonlocal executions
        executions += 1
        findings.take(data)

    while not executions or time.monotonic() < until:
        seed += 1
        options = hypothesis.settings(
            max_examples=AT_ONCE,
            database=None,
            deadline=None,
            suppress_health_check=list(hypothesis.HealthCheck),
        )
        hypothesis.seed(seed)(options(hypothesis.given(inputs(target))(one)))()
    print(f"executions: {executions}", file=sys.stderr)


def figures(log: str) -> tuple[int, str]:
    """Executions from the log; the coverage is not known."""
    told = log.rpartition("executions: ")[2].split()
    return int(told[0]) if told and told[0].isdigit() else 0, "-"
