"""Recordings and captures are kept whatever clients ask for and whatever fails."""

from __future__ import annotations

import resource
from collections.abc import Callable, Iterator

import pytest
import soundfile

from yehu_server.errors import OutputError
from yehu_server.live.audio import recorder
from yehu_server.scores.capture import read_capture


@pytest.fixture
def disk() -> Iterator[Callable[[int], None]]:
    """A disk that becomes full: no file may grow beyond so many bytes."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    yield lambda most_bytes: resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, hard))
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_no_client_ends_what_the_command_records(make_hall, tmp_path):
    hall = make_hall(record=tmp_path / "all.wav")
    client = hall.client()
    client.tell("/record/stop")
    address, reason = client.wait_for("/error")[:2]
    assert address == "/yehu/record/stop"
    assert "--record ends with the server" in reason
    assert hall.server.status()["recording"] == "all.wav"
    client.tell("/record/start", "some")  # both at once
    assert client.wait_for("/record/started") == ["some.wav"]
    assert hall.server.status()["recording"] == "all.wav; some.wav"
    client.tell("/note", 67, 90)
    hall.wait_frames(9600)
    client.tell("/record/stop")
    assert client.wait_for("/record/stopped") == ["some.wav"]
    assert hall.server.status()["recording"] == "all.wav"
    hall.end()
    whole, _ = soundfile.read(tmp_path / "all.wav", dtype="float32")
    some, _ = soundfile.read(hall.server.options.recordings / "some.wav", dtype="float32")
    assert len(some) >= 9600
    assert some.any()
    assert some.tobytes() in whole.tobytes()
    assert hall.server.is_whole


def test_a_recording_is_not_begun_on_a_full_disk(hall, disk):
    client = hall.client()
    disk(1000)
    client.tell("/record/start", "take")
    address, reason = client.wait_for("/error")[:2]
    assert address == "/yehu/record/start"
    assert "take.wav: cannot write: File too large" in reason
    assert list(hall.server.options.recordings.iterdir()) == []
    assert hall.server.takes.names == ""


def test_a_recording_that_filled_the_disk_is_not_answered_as_if_all_were_well(
    hall, disk, monkeypatch, patience
):
    monkeypatch.setattr(recorder, "ROOM_S", 0.01)
    client = hall.client()
    disk(20_000)
    client.tell("/record/start", "take")
    client.wait_for("/record/started")
    patience(lambda: hall.server.takes.names == "", "the disk to be full")
    client.tell("/record/stop")
    address, reason = client.wait_for("/error")[:2]
    assert address == "/yehu/record/stop"
    assert "take.wav: cannot write" in reason
    take = hall.server.options.recordings / "take.wav"
    assert soundfile.info(take).frames == (20_000 - 58) // 8
    assert any("take.wav" in line and "0.1 s are kept" in line for line in hall.said)


def test_a_full_disk_keeps_take_and_capture_as_far_as_they_got(
    make_hall, disk, tmp_path, monkeypatch, patience
):
    monkeypatch.setattr(recorder, "ROOM_S", 0.01)
    take, capture = tmp_path / "take.wav", tmp_path / "take.jsonl"
    hall = make_hall(record=take, capture=capture)
    disk(100_000)
    client = hall.client()
    client.tell("/note", 67, 90)
    patience(lambda: hall.server.takes.names == "", "the disk to be full")
    disk(capture.stat().st_size + 10)
    client.tell("/note", 69, 90)
    patience(lambda: any("capture ended" in line for line in hall.said), "no room for wishes")
    disk(resource.RLIM_INFINITY)
    hall.end()
    assert not hall.server.is_whole
    assert soundfile.info(take).frames == (100_000 - 58) // 8
    assert capture.read_bytes().endswith(b"]\n")
    assert len(read_capture(capture).wishes) > 0


def test_older_takes_are_refused_before_anything_else(make_hall, tmp_path):
    for name in ("record", "capture"):
        older = tmp_path / f"{name}.wav"
        older.write_text("older")
        with pytest.raises(OutputError, match=rf"{name}\.wav: exists; --overwrite replaces it"):
            make_hall(**{name: older})
        assert older.read_text() == "older"
    hall = make_hall(record=tmp_path / "record.wav", overwrite=True)
    hall.wait_frames(100)
    hall.end()
    assert soundfile.info(tmp_path / "record.wav").frames >= 100


def test_a_take_is_closed_whatever_else_fails_at_the_end(make_hall, tmp_path, monkeypatch):
    take, capture = tmp_path / "take.wav", tmp_path / "take.jsonl"
    hall = make_hall(record=take, capture=capture)
    hall.wait_frames(4800)

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(hall.server.player, "end_notes", interrupted)
        with pytest.raises(KeyboardInterrupt):
            hall.end()
    assert soundfile.info(take).frames >= 4800
    assert read_capture(capture).end is not None
    hall.server.output.end()


def test_a_server_told_to_stop_again_leaves_what_it_has_kept(make_hall, tmp_path):
    take, capture = tmp_path / "take.wav", tmp_path / "take.jsonl"
    hall = make_hall(record=take, capture=capture)
    hall.wait_frames(4800)
    hall.end()
    kept = take.read_bytes(), capture.read_bytes(), list(hall.said)
    hall.end()
    assert (take.read_bytes(), capture.read_bytes(), hall.said) == kept
    assert hall.server.is_whole


def test_who_is_in_a_hurry_does_not_wait_for_what_fades(make_hall, tmp_path):
    hall = make_hall(record=tmp_path / "take.wav")
    client = hall.client()
    client.tell("/playing/release", 1e9)  # the longest there is
    client.sync()
    released_s = hall.player.value("/playing/release") / 1e3
    client.tell("/note", 67, 90)
    hall.wait_frames(9600)
    hall.server.skip_fade_out()
    before = hall.instrument.frame
    hall.end()
    assert (hall.instrument.frame - before) / hall.instrument.rate < 0.5 * released_s
    assert soundfile.info(tmp_path / "take.wav").frames == hall.instrument.frame
