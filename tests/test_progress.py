"""A progress bar."""

from __future__ import annotations

import argparse
import io
import sys
import time

from yehu_server.cli.terminal import progress_bar


class Terminal(io.StringIO):
    encoding = "utf-8"

    def isatty(self) -> bool:
        return True


def test_a_bar_shows_no_zero_of_zero(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with progress_bar(argparse.Namespace(quiet=False), "calibrating", "notes") as progress:
        time.sleep(0.3)
        assert "calibrating" not in terminal.getvalue()
        progress(3.0, 25.0)
        time.sleep(0.3)
    assert "3 of 25 notes" in terminal.getvalue()
    assert "0.0" not in terminal.getvalue()
