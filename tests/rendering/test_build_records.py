"""What is up to date of earlier runs."""

import os

import pytest

from yehu_server.errors import OutputError
from yehu_server.rendering import build_records


@pytest.fixture
def target(tmp_path):
    """A result that was made and kept, from a file of settings."""
    (tmp_path / "settings").write_text("1")
    path = tmp_path / "a.wav"
    path.write_bytes(b"sound")
    build_records.make_folder_for(path)
    build_records.keep(path, "key", [tmp_path / "settings"], [path], {"file": "a.mid"})
    return path


def test_what_has_not_changed_is_up_to_date_whatever_its_time(target):
    assert build_records.up_to_date(target, "key", [target]) == {"file": "a.mid"}
    os.utime(target, (1, 1))
    assert build_records.up_to_date(target, "key", [target]) == {"file": "a.mid"}


@pytest.mark.usefixtures("target")
def test_a_folder_may_be_moved(tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    for name in ("a.wav", ".yehu-server"):
        (tmp_path / name).rename(other / name)
    assert build_records.up_to_date(other / "a.wav", "key", [other / "a.wav"]) is not None


def change_bytes(target):
    target.write_bytes(b"soune")
    os.utime(target, (1, 1))


CHANGES = {
    "gone": lambda target: target.unlink(),
    "other bytes": change_bytes,
    "another length": lambda target: target.write_bytes(b"soun"),
    "other settings": lambda target: (target.parent / "settings").write_text("2"),
    "no settings": lambda target: (target.parent / "settings").unlink(),
    "no record": lambda target: build_records.record_of(target).unlink(),
    "a record cut short": lambda target: build_records.record_of(target).write_text('{"key": "ke'),
    "no record but JSON": lambda target: build_records.record_of(target).write_text("[[]]"),
    "a record of lists": lambda target: build_records.record_of(target).write_text(
        '{"line": [], "key": 1}'
    ),
    "deep": lambda target: build_records.record_of(target).write_text("[" * 100_000),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_has_changed_is_not(target, change):
    CHANGES[change](target)
    assert build_records.up_to_date(target, "key", [target]) is None


def test_what_a_killed_process_left_is_removed_and_records_stay(target):
    left = build_records.temporary_of(target).with_name(".yehu-server-0.part")
    left.touch()
    build_records.clear_work([target.parent])
    assert not left.exists()
    assert build_records.up_to_date(target, "key", [target]) is not None


def test_one_at_a_time_writes_to_a_folder(tmp_path):
    with (
        build_records.alone_in(tmp_path),
        pytest.raises(OutputError, match="another command"),
        build_records.alone_in(tmp_path),
    ):
        pass
    with build_records.alone_in(tmp_path):
        pass


def test_a_pipe_for_a_lock_is_reported_at_once(tmp_path):
    (tmp_path / build_records.HIDDEN).mkdir()
    os.mkfifo(tmp_path / build_records.HIDDEN / build_records.LOCK)
    with pytest.raises(OutputError, match="cannot write"), build_records.alone_in(tmp_path):
        pass
