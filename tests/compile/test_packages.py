"""Each package has its own key of compiled code: a change of one compiles no other one anew."""

import shutil
import subprocess
import sys
from pathlib import Path

import compile_all
import pytest

from yehu_server.compile import cache_folder
from yehu_server.compile.cache_folder import key_beside, register, source_hash

ROOT = Path(__file__).parents[2]
LOOK = """
import yehu_lab, yehu_server
from yehu_lab.regimes.strokes import bow_stroke
from yehu_server.core.engine import warming
from yehu_server.core.physics.time_loop import advance_with_ledger
print(yehu_lab.__path__[0], yehu_server.__path__[0])
print(warming.is_warm(), advance_with_ledger.is_kept, bow_stroke.is_kept, bow_stroke.is_cached)
"""
"""Prints where both packages are, and whether playing, simulating and a stroke are compiled."""


@pytest.fixture
def studio(tmp_path, monkeypatch) -> Path:
    """The folder of another package's compiled code, with a file."""
    monkeypatch.setattr(cache_folder, "others", {})
    (tmp_path / "strokes.py").write_text("SPEED = 1.0\n", encoding="utf-8")
    register("studio", tmp_path)
    source_hash.cache_clear()
    yield tmp_path
    source_hash.cache_clear()


def test_the_key_of_another_package_follows_its_source_and_ours_stays(studio):
    ours, theirs, folder = source_hash(), source_hash("studio"), cache_folder.cache_folder()
    assert theirs != ours
    (studio / "strokes.py").write_text("SPEED = 2.0\n", encoding="utf-8")
    source_hash.cache_clear()
    assert (source_hash(), cache_folder.cache_folder()) == (ours, folder)
    assert source_hash("studio") != theirs


@pytest.mark.usefixtures("studio")
def test_the_key_of_another_package_follows_our_source(monkeypatch):
    theirs = source_hash("studio")
    monkeypatch.setattr(cache_folder, "SOURCE_FOLDERS", cache_folder.SOURCE_FOLDERS[:-1])
    source_hash.cache_clear()
    assert source_hash("studio") != theirs


@pytest.mark.usefixtures("studio")
def test_only_functions_of_another_package_are_kept_by_its_key():
    assert key_beside("studio.strokes") == source_hash("studio")
    assert key_beside("yehu_server.core.physics.bow") == key_beside("__main__") == ""


def test_a_change_in_the_laboratory_compiles_the_instrument_not_anew(tmp_path):
    compile_all.warm_up()
    shutil.copytree(ROOT / "yehu_lab", tmp_path / "yehu_lab")

    def seen() -> list[str]:
        run = subprocess.run(
            [sys.executable, "-c", LOOK],
            cwd=tmp_path, check=True, capture_output=True, text=True,
        )  # fmt: skip
        places, compiled = run.stdout.splitlines()
        assert places == f"{tmp_path / 'yehu_lab'} {ROOT / 'yehu_server'}"
        return compiled.split()

    assert seen() == ["True", "True", "True", "True"]
    with (tmp_path / "yehu_lab" / "regimes" / "judge.py").open("a", encoding="utf-8") as file:
        file.write("CHANGED = True\n")
    assert seen() == ["True", "True", "False", "False"]
