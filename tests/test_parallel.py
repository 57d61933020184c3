"""Forked workers run every test once, and tell of each as one process would."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import parallel
import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing forks here")
TESTS = """
import os, signal, warnings
import pytest

@pytest.fixture(scope="session", autouse=True)
def ends(tmp_path_factory):
    yield
    (tmp_path_factory.getbasetemp() / "taken down").touch()

def test_passes(tmp_path):
    print("unseen")

def test_fails():
    print("what it printed")
    assert False

def test_skips():
    pytest.skip("for no reason")

def test_warns():
    warnings.warn("a warning")

def test_is_killed():
    os.kill(os.getpid(), signal.SIGKILL)

def test_comes_later():
    pass
"""


@pytest.fixture
def run(tmp_path):
    def run(*options: str) -> str:
        names = [f"test_{number}.py" for number in range(3)]
        for name in names:
            (tmp_path / name).write_text(TESTS)
        words = ["-p", "parallel", "-p", "no:cacheprovider", "--basetemp", tmp_path / "temporary"]
        command = [sys.executable, "-m", "pytest", "-q", "-rs", *words, *options, *names]
        place = {"PYTHONPATH": str(Path(parallel.__file__).parent)}
        done = subprocess.run(
            command, cwd=tmp_path, env=place, capture_output=True, text=True, check=False
        )
        assert (done.returncode, done.stderr) == (1, "")
        return done.stdout

    return run


def test_every_test_is_run_once_whatever_ends_a_worker(run, tmp_path):
    told = run("--workers", "2")
    assert "6 failed, 9 passed, 3 skipped, 3 warnings" in told
    assert told.count("its process ended with exit code -9") == 3
    assert told.count("what it printed") == 6  # in the code, and what was captured
    assert "unseen" not in told
    folders = {folder.name for folder in (tmp_path / "temporary").iterdir()}
    assert all(re.fullmatch(r"worker\d", name) for name in folders)
    assert any(tmp_path.glob("temporary/*/taken down"))


def test_the_first_failure_is_enough_where_it_is_to_be(run):
    assert re.search(r"^[12] failed", run("--workers", "2", "-x").splitlines()[-1])
