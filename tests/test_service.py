"""The systemd unit that comes along, and `serve` as it runs it: without a terminal."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from yehu_server import cli
from yehu_server.cli.config import parse
from yehu_server.util.files import shipped_folder

UNIT = shipped_folder("examples") / "systemd" / "yehu-server.service"


def entries() -> dict[str, str]:
    lines = UNIT.read_text("utf-8").splitlines()
    return dict(line.split("=", 1) for line in lines if "=" in line and not line.startswith("#"))


def test_its_command_is_one_of_ours_with_options_that_are_there():
    program, *words = entries()["ExecStart"].split()
    assert Path(program).name == "yehu-server"
    assert parse(words, cli._parser()).run is not None


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="there is no systemd-analyze")
def test_systemd_finds_nothing_wrong_with_it(tmp_path):
    # With a program that is there: it checks that, too.
    text = UNIT.read_text("utf-8").replace("%h/.local/bin/yehu-server", f'"{sys.executable}"')
    unit = tmp_path / "yehu-server.service"
    unit.write_text(text, "utf-8")
    done = subprocess.run(
        ["systemd-analyze", "verify", "--user", "--man=no", unit],  # noqa: S607
        env={"XDG_RUNTIME_DIR": str(tmp_path), "PATH": "/usr/bin:/bin", "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    about_it = [line for line in done.stderr.splitlines() if "yehu-server" in line]
    assert about_it == [], done.stderr
    assert done.returncode == 0, done.stderr
