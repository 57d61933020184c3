"""Performances that come in links and files, as the page reads them."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

FILE = Path(__file__).with_name("performances.test.mjs")


def test_performances_are_bounded_and_reach_nothing_but_the_sound(node, page, everything):
    run = subprocess.run(
        [node, "--test", str(FILE)],
        env={**os.environ, "WEB": str(page), "MANY": "2000" if everything else "200"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert run.returncode == 0, run.stdout[-3000:]
