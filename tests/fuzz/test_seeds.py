"""Every reader keeps its contract for every seed, including those that once broke it."""

import importlib

import pytest
from fuzz.bounds import TooSlowError
from fuzz.target import SEEDS, TARGETS


@pytest.fixture(scope="module", autouse=True)
def _targets() -> None:
    """Fill TARGETS, which takes long."""
    importlib.import_module("fuzz.targets")


def test_each_reader_keeps_its_contract():
    broken = {}
    for name, target in TARGETS.items():
        for seed, data in target.seeds().items():
            try:
                target.check(data)
            except (Exception, TooSlowError) as error:  # noqa: BLE001 - whatever it is
                broken[f"{name}/{seed}"] = repr(error)
    assert broken == {}


def test_every_folder_of_seeds_is_of_a_target_and_every_target_has_one():
    assert {folder.name for folder in SEEDS.iterdir()} == set(TARGETS)
