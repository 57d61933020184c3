"""Partial files."""

from __future__ import annotations

import os
import time

import pytest

from yehu_server.util import files
from yehu_server.util.checksummed import write_checksummed
from yehu_server.util.files import LEFTOVER_AFTER_S, partial_beside, write_bytes


def aged(path, seconds):
    path.write_bytes(b"half")
    os.utime(path, (time.time() - seconds,) * 2)
    return path


@pytest.mark.parametrize("write", [write_bytes, write_checksummed])
def test_what_killed_writers_left_is_removed_at_the_next_start(tmp_path, monkeypatch, write):
    files._remove_leftovers.cache_clear()
    old = [aged(partial_beside(tmp_path / "a"), LEFTOVER_AFTER_S + 60) for _ in range(3)]
    link = tmp_path / f".yehu-server-{'0' * 16}.part"
    link.symlink_to(old[0])
    kept = [
        aged(partial_beside(tmp_path / "a"), LEFTOVER_AFTER_S - 60),  # somebody may be writing it
        aged(tmp_path / ".yehu-server-mine.part", 2 * LEFTOVER_AFTER_S),
        aged(tmp_path / "sweep.npz.part", 2 * LEFTOVER_AFTER_S),
        aged(tmp_path / "piece.wav", 2 * LEFTOVER_AFTER_S),
    ]
    write(tmp_path / "b", b"b")  # this process has looked already
    assert all(path.exists() for path in (*old, *kept))
    files._remove_leftovers.cache_clear()  # a start
    monkeypatch.setattr("os.getuid", lambda: tmp_path.stat().st_uid + 1)
    write(tmp_path / "b", b"b")
    assert all(path.exists() for path in (*old, *kept)), "another user's"
    files._remove_leftovers.cache_clear()
    monkeypatch.undo()
    write(tmp_path / "b", b"b")
    assert sorted(tmp_path.iterdir()) == sorted([*kept, link, tmp_path / "b"])
