"""Helper processes: the modules that they find, and what is done when one has ended."""

import json
import multiprocessing
import os
import subprocess
import sys
from pathlib import Path

import pytest

from yehu_server.cli import main
from yehu_server.util import processes
from yehu_server.util.processes import Supervisor, python_command
from yehu_server.util.retry import Backoff

READS = """
import os
from yehu_server.util.processes import Parent
parent = Parent()
parent.send("input", read=os.read(0, 1).decode())
for order in parent.orders():
    parent.send("heard", **order)
"""
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


def test_a_library_that_asks_for_the_input_of_a_helper_finds_it_empty_and_does_not_wait():
    # Windows lets nobody ask about a pipe that another thread reads [numpy issue 24290].
    run = subprocess.run(
        [sys.executable, "-c", READS],
        input='{"order": "open"}\n', stdout=subprocess.PIPE, text=True, check=True,
    )  # fmt: skip
    assert [*map(json.loads, run.stdout.splitlines())] == [
        {"event": "input", "read": ""},
        {"event": "heard", "order": "open"},
    ]


def test_the_end_of_a_helper_is_acted_on_however_it_came(monkeypatch):
    done: list[str] = []

    class Child:
        def __init__(self, _module, heard, _share) -> None:
            self.ends = lambda: heard({"event": "gone"})

        def stop(self) -> None:
            done.append("stopped")

    class Helped(Supervisor):
        def attend(self, child, gone) -> None:
            if way == "it fails":
                raise RuntimeError(way)
            self.stop() if way == "it is stopped" else child.ends()
            assert gone.is_set()

        def on_exit(self, *, by_itself: bool) -> None:
            done.append("by itself" if by_itself else "as asked")

    monkeypatch.setattr(processes, "Child", Child)
    monkeypatch.setattr(processes, "Backoff", lambda: Backoff(0.0, 0.0))
    for way, reason in {"it ends": "by itself", "it is stopped": "as asked"}.items():
        Helped("some.module", "help", print, ())._serve()
        assert done == ["stopped", reason], way
        done.clear()
    way = "it fails"
    with pytest.raises(RuntimeError, match=way):
        Helped("some.module", "help", print, ())._serve()
    assert done == ["stopped", "by itself"]
