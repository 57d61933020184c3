"""A moment of fuzzing by hypothesis: seeds with some bytes changed, and any bytes."""

import importlib

import pytest
from fuzz.target import MAX_BYTES, TARGETS, Target
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st


def inputs(target: Target) -> st.SearchStrategy[bytes]:
    """Any bytes, and the target's seeds with some bytes changed."""
    seeds = list(target.seeds().values())
    pieces = st.binary(max_size=8)
    if target.words:
        pieces |= st.sampled_from(target.words)
    changes = st.lists(st.tuples(st.floats(0.0, 1.0), st.integers(0, 16), pieces), max_size=6)
    return st.binary(max_size=200) | st.builds(changed, st.sampled_from(seeds), changes)


def changed(data: bytes, changes: list[tuple[float, int, bytes]]) -> bytes:
    """The data with some bytes at each place (0 to 1) replaced by others."""
    for where, count, piece in changes:
        at = round(where * len(data))
        data = data[:at] + piece + data[at + count :]
    return data[:MAX_BYTES]


@pytest.mark.slow
def test_each_reader_keeps_its_contract_for_any_bytes(subtests):
    importlib.import_module("fuzz.targets")
    for target in TARGETS.values():
        with subtests.test(target.name):
            quickly = settings(max_examples=50, suppress_health_check=list(HealthCheck))
            quickly(given(inputs(target))(target.check.__func__))(target)
