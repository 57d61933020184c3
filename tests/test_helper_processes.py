"""Helper processes: the modules that they find, and what is done when one has ended."""

import multiprocessing
import os
import subprocess
from pathlib import Path

import pytest

from yehu_server.cli import main
from yehu_server.util import processes
from yehu_server.util.processes import Supervisor, python_command
from yehu_server.util.retry import Backoff

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
