"""Every reader keeps its contract for every seed, including those that once broke it."""

from __future__ import annotations

import pytest
from fuzz import targets
from fuzz.target import SEEDS, TARGETS

assert targets.__all__

CASES = [
    pytest.param(target, data, id=f"{name}-{seed}")
    for name, target in TARGETS.items()
    for seed, data in target.seeds().items()
]


@pytest.mark.parametrize(("target", "data"), CASES)
def test_a_reader_keeps_its_contract(target, data):
    target.check(data)


def test_every_folder_of_seeds_is_of_a_target_and_every_target_has_one():
    assert {folder.name for folder in SEEDS.iterdir()} == set(TARGETS)
