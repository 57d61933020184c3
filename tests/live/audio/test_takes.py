"""Recordings and captures are kept whatever clients ask for and whatever fails."""

from types import SimpleNamespace

import numpy as np
import pytest
import soundfile

from yehu_server.errors import OutputError
from yehu_server.live import traffic_limits as limits
from yehu_server.live.audio import recordings
from yehu_server.scores.capture import read_capture


def test_no_client_ends_what_the_command_records(make_live, tmp_path):
    live = make_live(record=tmp_path / "all.wav")
    client = live.client()
    client.send("/record/stop")
    address, reason = client.wait_for("/error")[:2]
    assert address == "/yehu/record/stop"
    assert "--record ends with the server" in reason
    assert live.server.status()["recording"] == "all.wav"
    client.send("/record/start", "some")  # both at once
    file = str(live.server.options.recordings / "some.wav")
    assert client.wait_for("/record/started") == [file]
    assert live.server.status()["recording"] == "all.wav; some.wav"
    client.send("/note", 67, 90)
    live.wait_frames(9600)
    client.send("/record/stop")
    assert client.wait_for("/record/stopped") == [file]
    assert live.server.status()["recording"] == "all.wav"
    live.end()
    whole, _ = soundfile.read(tmp_path / "all.wav", dtype="float32")
    some, _ = soundfile.read(live.server.options.recordings / "some.wav", dtype="float32")
    assert len(some) >= 9600
    assert some.any()
    assert some.tobytes() in whole.tobytes()
    assert live.server.is_whole


def test_recordings_are_bounded_in_rate_and_number_and_empty_ones_leave_no_file(
    tmp_path, monkeypatch
):
    clock = SimpleNamespace(now=1.0, monotonic=lambda: clock.now)
    monkeypatch.setattr(recordings, "time", clock)
    monkeypatch.setattr(limits, "RECORDINGS", 12)
    tape = SimpleNamespace(rate=44100.0, frame=0, taped=lambda at: (at, np.zeros((0, 2), "f4")))
    takes = recordings.Recordings(tape, tmp_path, lambda _line: None)
    for ending in (".wav", ".flac"):
        takes.start(f"empty{ending}")
        with pytest.raises(OutputError, match="there is nothing to write"):
            takes.stop()
    assert list(tmp_path.iterdir()) == []
    tape.taped = lambda at: (at, np.zeros((64, 2), "f4"))
    for number in range(8):
        takes.start(f"{number}")
        takes.stop()
    with pytest.raises(OutputError, match="too often"):
        takes.start("more")
    for number in range(4):
        clock.now += 1.0
        takes.start(f"more {number}")
        takes.stop()
    clock.now += 1.0
    with pytest.raises(OutputError, match="has 12 files; remove some first"):
        takes.start("one too many")


def test_a_recording_that_filled_the_disk_is_not_answered_as_if_all_were_well(
    live, limited, monkeypatch, until
):
    monkeypatch.setattr(recordings, "ROOM_S", 0.01)
    client = live.client()
    limited(20_000)
    client.send("/record/start", "take")
    client.wait_for("/record/started")
    until(lambda: live.server.takes.names == "", "the disk to be full")
    client.send("/record/stop")
    address, reason = client.wait_for("/error")[:2]
    assert address == "/yehu/record/stop"
    assert "take.wav: cannot write" in reason
    take = live.server.options.recordings / "take.wav"
    assert soundfile.info(take).frames == (20_000 - 58) // 8
    assert any("take.wav" in line and "0.1 s are kept" in line for line in live.said)


def test_a_full_disk_keeps_take_and_capture_as_far_as_they_got(
    make_live, limited, tmp_path, monkeypatch, until
):
    monkeypatch.setattr(recordings, "ROOM_S", 0.01)
    take, capture = tmp_path / "take.wav", tmp_path / "take.jsonl"
    live = make_live(record=take, capture=capture)
    limited(100_000)
    client = live.client()
    client.send("/note", 67, 90)
    until(lambda: live.server.takes.names == "", "the disk to be full")
    limited(capture.stat().st_size + 10)
    client.send("/note", 69, 90)
    until(lambda: any("capture ended" in line for line in live.said), "no room for commands")
    limited(-1)  # none
    live.end()
    assert not live.server.is_whole
    assert soundfile.info(take).frames == (100_000 - 58) // 8
    assert capture.read_bytes().endswith(b"]\n")
    assert len(read_capture(capture).commands) > 0


def test_a_take_or_a_capture_that_was_removed_is_no_whole_one(make_live, tmp_path, until):
    for name in ("record", "capture"):
        take = tmp_path / f"{name}.{'wav' if name == 'record' else 'jsonl'}"
        live = make_live(**{name: take})
        live.wait_frames(100)
        take.unlink()
        live.client().send("/note", 67, 90)
        line = f"{take}: was removed meanwhile"
        until(lambda: any(each.endswith(line) for each in live.said), "it to be said")  # noqa: B023
        live.end()
        assert not live.server.is_whole
        assert not take.exists()


def test_older_takes_are_refused_before_anything_else(make_live, tmp_path):
    for name in ("record", "capture"):
        older = tmp_path / f"{name}.wav"
        older.write_text("older")
        with pytest.raises(OutputError, match=rf"{name}\.wav: exists; --overwrite"):
            make_live(**{name: older})
        assert older.read_text() == "older"
    live = make_live(record=tmp_path / "record.wav", overwrite=True)
    live.wait_frames(100)
    live.end()
    assert soundfile.info(tmp_path / "record.wav").frames >= 100


def test_a_server_asked_to_stop_again_leaves_what_it_has_kept(make_live, tmp_path):
    take, capture = tmp_path / "take.wav", tmp_path / "take.jsonl"
    live = make_live(record=take, capture=capture)
    live.wait_frames(4800)
    live.end()
    kept = take.read_bytes(), capture.read_bytes(), list(live.said)
    live.end()
    assert (take.read_bytes(), capture.read_bytes(), live.said) == kept
    assert live.server.is_whole


# ---------------------------------------------------------------- names


def test_what_is_recorded_is_a_file_when_it_ends(live):
    client = live.client()
    client.send("/record/start", "take 1")
    file = str(live.server.options.recordings / "take 1.wav")
    assert client.wait_for("/record/started") == [file]
    assert live.server.status()["recording"] == "take 1.wav"
    client.send("/record/start", "take.mp3")
    assert client.wait_for("/error")[1] == "take.mp3: recordings are .wav or .flac"
    client.send("/record/start", "take 2")
    assert client.wait_for("/error")[0] == "/yehu/record/start"
    live.wait_frames(9600)
    client.send("/record/stop")
    assert client.wait_for("/record/stopped") == [file]
    folder = live.server.options.recordings
    assert (folder / "take 1.wav").stat().st_size > 8 * 9600
    client.send("/record/start", "take 1")  # nothing is overwritten
    assert client.wait_for("/error")[0] == "/yehu/record/start"
    client.send("/record/stop")
    assert client.wait_for("/error")[0] == "/yehu/record/stop"
    assert [path.name for path in folder.iterdir()] == ["take 1.wav"]


def test_a_name_that_is_more_than_a_name_records_nothing(shared_server):
    client = shared_server.client()
    for name in ("", "../evil", "/evil", "evil\n"):
        client.send("/record/start", name)
        assert client.wait_for("/error")[0] == "/yehu/record/start"
    assert shared_server.server.takes.names == ""
    assert list(shared_server.server.options.recordings.iterdir()) == []
    assert shared_server.is_well()


def test_a_link_in_the_recordings_that_leads_out_is_not_written_through(make_live, tmp_path):
    live = make_live()
    folder, secret = live.server.options.recordings, tmp_path / "secret"
    folder.mkdir(exist_ok=True)
    (folder / "take.wav").symlink_to(secret)
    client = live.client()
    for content in ("", "kept"):
        if content:
            secret.write_text(content)
        client.send("/record/start", "take")
        address, reason = client.wait_for("/error")
        assert address == "/yehu/record/start"
        assert reason.startswith("take.wav is a link that leads out of")
        assert live.server.takes.names == ""
        assert (secret.read_text() if secret.exists() else "") == content
