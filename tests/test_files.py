"""Partial files, and locks between processes."""

import os
import sys
import time

import pytest

from yehu_server.util import files
from yehu_server.util.checksummed import write_checksummed
from yehu_server.util.files import LEFTOVER_AFTER_S, partial_beside, write_bytes
from yehu_server.util.processes import machine_lock


def aged(path, seconds):
    path.write_bytes(b"half")
    os.utime(path, (time.time() - seconds,) * 2)
    return path


@pytest.mark.parametrize("write", [write_bytes, write_checksummed])
def test_what_killed_writers_left_is_removed_at_the_next_start(tmp_path, monkeypatch, write):
    files._remove_leftovers.cache_clear()
    old = [aged(partial_beside(tmp_path / "a"), LEFTOVER_AFTER_S + 60) for _ in range(3)]
    kept = [
        aged(partial_beside(tmp_path / "a"), LEFTOVER_AFTER_S - 60),  # somebody may be writing it
        aged(tmp_path / ".yehu-server-mine.part", 2 * LEFTOVER_AFTER_S),
        aged(tmp_path / "sweep.npz.part", 2 * LEFTOVER_AFTER_S),
        aged(tmp_path / "piece.wav", 2 * LEFTOVER_AFTER_S),
    ]
    if sys.platform != "win32":  # where wine takes a link for its target
        kept.append(tmp_path / f".yehu-server-{'0' * 16}.part")
        kept[-1].symlink_to(old[0])
    write(tmp_path / "b", b"b")  # this process has looked already
    assert all(path.exists() for path in (*old, *kept))
    files._remove_leftovers.cache_clear()  # a start
    monkeypatch.setattr("yehu_server.util.files.is_own", lambda _: False)
    write(tmp_path / "b", b"b")
    assert all(path.exists() for path in (*old, *kept)), "another user's"
    files._remove_leftovers.cache_clear()
    monkeypatch.undo()
    write(tmp_path / "b", b"b")
    assert sorted(tmp_path.iterdir()) == sorted([*kept, tmp_path / "b"])


@pytest.mark.skipif(sys.platform == "win32", reason="wine locks for a process, not for a handle")
def test_a_lock_that_is_held_for_good_is_not_waited_for(tmp_path, caplog):
    folder = tmp_path / "cache"
    with machine_lock(folder, "page"):
        with machine_lock(folder, "setup", within_s=0.0):
            assert not caplog.text
        with machine_lock(folder, "page", within_s=0.1):
            assert "held for 0 s by another process" in caplog.text
    caplog.clear()
    with machine_lock(folder, "page", within_s=0.0):
        assert not caplog.text


def test_a_lock_that_cannot_be_made_keeps_nobody(tmp_path):
    (tmp_path / "file").touch()
    with machine_lock(tmp_path / "file", "page"):
        pass
    (tmp_path / "elsewhere").touch()
    with machine_lock(tmp_path, "page"):
        (lock,) = tmp_path.glob("page-*.lock")
    lock.unlink()
    lock.symlink_to(tmp_path / "elsewhere")  # whoever may write there cannot lead it away
    with machine_lock(tmp_path, "page", within_s=0.0):
        assert (tmp_path / "elsewhere").read_bytes() == b""
