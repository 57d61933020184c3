"""Performances that come in links and files, as the page reads them."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from yehu_server.live.page.facts import write
from yehu_server.live.page.site import page_folder

FILE = Path(__file__).with_name("performances.test.mjs")


def test_performances_are_bounded_and_reach_nothing_but_the_sound(node, tmp_path):
    web = tmp_path / "web"
    shutil.copytree(page_folder(), web)
    write(web)
    run = subprocess.run(
        [node, "--test", str(FILE)],
        env={**os.environ, "WEB": str(web)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert run.returncode == 0, run.stdout[-3000:]
