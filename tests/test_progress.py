"""A progress bar; and the time left of a folder: seconds of sound, as far as they are known."""

from __future__ import annotations

import argparse
import io
import sys
import time

import pytest

from yehu_server.cli.folder_runs import ProgressEstimate
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


def test_files_of_unknown_length_count_alike_and_those_that_failed_are_done():
    seconds = ProgressEstimate([0.0] * 4)
    for share in (0.5, 1.0):
        seconds.update(0, share)
        assert seconds.done / seconds.total == pytest.approx(share / 4)
    for file in (1, 2, 3):
        seconds.update(file, 1.0)
    assert seconds.done == pytest.approx(seconds.total)


def test_a_long_file_counts_for_more_than_a_short_one():
    seconds = ProgressEstimate([1.0, 9.0])
    seconds.update(0, 1.0, 1.0)
    assert (seconds.done, seconds.total) == (1.0, 10.0)
    seconds.update(1, 0.5)
    assert seconds.done == pytest.approx(5.5)


def test_the_length_of_a_file_that_has_begun_replaces_a_guess():
    seconds = ProgressEstimate([2.0, 0.0, 0.0])
    assert seconds.total == 6.0
    seconds.update(1, 0.1, 10.0)
    assert (seconds.done, seconds.total) == pytest.approx((1.0, 18.0))
    seconds.update(1, 1.0, 12.0)
    assert (seconds.done, seconds.total) == pytest.approx((12.0, 21.0))
