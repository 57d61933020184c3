"""Recording by OSC: begun and ended, by plain names only."""

from __future__ import annotations


def test_what_is_recorded_is_a_file_when_it_ends(live):
    client = live.client()
    client.tell("/record/start", "take 1")
    assert client.wait_for("/record/started") == ["take 1.wav"]
    assert live.server.status()["recording"] == "take 1.wav"
    client.tell("/record/start", "take 2")
    assert client.wait_for("/error")[0] == "/yehu/record/start"
    live.wait_frames(9600)
    client.tell("/record/stop")
    assert client.wait_for("/record/stopped") == ["take 1.wav"]
    folder = live.server.options.recordings
    assert (folder / "take 1.wav").stat().st_size > 8 * 9600
    client.tell("/record/start", "take 1")  # nothing is overwritten
    assert client.wait_for("/error")[0] == "/yehu/record/start"
    client.tell("/record/stop")
    assert client.wait_for("/error")[0] == "/yehu/record/stop"
    assert [path.name for path in folder.iterdir()] == ["take 1.wav"]


def test_a_name_that_is_more_than_a_name_records_nothing(shared_server):
    client = shared_server.client()
    for name in ("", "../evil", "/evil", "evil\n"):
        client.tell("/record/start", name)
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
        client.tell("/record/start", "take")
        address, reason = client.wait_for("/error")
        assert address == "/yehu/record/start"
        assert reason.startswith("take.wav is a link that leads out of")
        assert live.server.takes.names == ""
        assert (secret.read_text() if secret.exists() else "") == content


def test_a_folder_that_cannot_be_reached_is_answered(make_live, tmp_path):
    live = make_live()
    live.server.takes._folder = tmp_path / ("x" * 300)  # stands in for a folder without access
    client = live.client()
    client.tell("/record/start", "take")
    assert client.next(0.5).address == "/yehu/error"
