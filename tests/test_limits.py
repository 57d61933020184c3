"""The limit on open files."""

import subprocess
import sys

import forks
import pytest
from commands import COMMAND

pytest.importorskip("resource", reason="there is no such limit on Windows")

from yehu_server.cli.serve import FILES_NEEDED, MAX_FILES, allow_files


def serve(files: int, *words: str) -> subprocess.CompletedProcess[str]:
    """Run ``serve`` briefly with a limit on open files."""
    limit = f"import resource; resource.setrlimit(resource.RLIMIT_NOFILE, ({files}, {files}));"
    ports = ("--osc", "127.0.0.1:0", "--http", "127.0.0.1:0")
    return forks.run("serve", "--audio-device", "null", *ports, *words, code=limit + COMMAND)


@pytest.mark.parametrize("files", [8, FILES_NEEDED - 1])
def test_too_few_files_are_reported_in_one_line_that_says_how_many_are_needed(files):
    run = serve(files, "--duration", "0.1")
    assert run.returncode == 2
    (line,) = run.stderr.splitlines()
    assert line == (
        f"yehu-server: {files} open files are too few: {FILES_NEEDED} are needed "
        "(raise the limit: ulimit -n)"
    )


def test_with_as_many_as_it_says_it_plays(tmp_path):
    files = ("--record", str(tmp_path / "take.wav"), "--capture", str(tmp_path / "take.jsonl"))
    run = serve(FILES_NEEDED, "--duration", "0.1", *files)
    assert run.returncode == 0
    assert "Too many" not in run.stderr
    assert (tmp_path / "take.wav").exists()


class System:
    """A stand-in for Python's module `resource`."""

    RLIMIT_NOFILE, RLIM_INFINITY = 7, -1

    def __init__(self, soft: int, hard: int) -> None:
        self.limits = soft, hard

    def getrlimit(self, _which: int) -> tuple[int, int]:
        return self.limits

    def setrlimit(self, _which: int, limits: tuple[int, int]) -> None:
        self.limits = limits


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ((256, -1), (MAX_FILES, -1)),  # macOS
        ((256, 1024), (1024, 1024)),
        ((1 << 20, 1 << 20), (1 << 20, 1 << 20)),
        ((-1, -1), (-1, -1)),
    ],
)
def test_as_many_files_are_taken_as_the_user_may_have(monkeypatch, before, after):
    system = System(*before)
    monkeypatch.setitem(sys.modules, "resource", system)
    allow_files(40)
    assert system.limits == after
