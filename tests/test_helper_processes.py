"""Helper processes find the modules of their parent, and none that lie in the current folder."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
from pathlib import Path

import pytest

from yehu_server.cli import main
from yehu_server.util.processes import python_command

STRANGE = "open('ran', 'w')\nraise SystemExit('a strange module')\n"


@pytest.fixture
def strange(tmp_path, monkeypatch) -> Path:
    """The current folder, in which modules lie that are called as Python's own."""
    monkeypatch.chdir(tmp_path)
    for name in ("json", "multiprocessing", "runpy"):
        (tmp_path / f"{name}.py").write_text(STRANGE)
    return tmp_path


def test_modules_of_the_current_folder_are_not_run(strange, capsys):
    run = subprocess.run(
        python_command("json.tool"), input="{}", capture_output=True, text=True, check=False
    )
    assert (run.returncode, run.stdout.strip(), run.stderr) == (0, "{}", "")
    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out.startswith("yehu-server")
    process = multiprocessing.get_context("spawn").Process(target=os.getpid)
    process.start()
    process.join()
    assert process.exitcode == 0
    assert not (strange / "ran").exists()


def test_a_helper_finds_what_its_parent_does(tmp_path, monkeypatch):
    (tmp_path / "only_here.py").write_text("import sys; print(sys.argv[1:], __name__)")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    run = subprocess.run(
        python_command("only_here", "a", "b c"), capture_output=True, text=True, check=False
    )
    assert (run.stdout, run.stderr) == ("['a', 'b c'] __main__\n", "")
