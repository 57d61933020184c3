"""Presets over OSC."""

import os
from pathlib import Path

import pytest

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc import context
from yehu_server.playing.preset_folders import Presets

SHIPPED = Presets(Path(os.devnull))
HEAD = "version = 1\n"


@pytest.fixture
def own(own_presets):
    """The user's own folder, empty before and after."""
    own_presets.mkdir(parents=True, exist_ok=True)
    yield own_presets
    for file in own_presets.iterdir():
        file.unlink()


def by_address(heard) -> dict[str, list]:
    return {message.address.removeprefix("/yehu"): message.arguments for message in heard}


def test_a_load_is_heard_at_the_frame_of_its_time_tag_and_at_no_other(still, wire):
    still.send("/note", 74.0, 90.0)
    still.pass_time(0.1)
    still.events.clear()
    at = still.clock.time() + 0.05
    frame = round(still._frame_at(still.clock.monotonic_ns()) + 0.05 * still.RATE)
    still.take(wire.bundle(at, wire.message("/yehu/preset/load", "sul-ponticello")))
    still.pass_time(0.1)
    frames = {moved for moved, _, _ in still.events}
    assert len(frames) == 1
    assert abs(frames.pop() - frame) <= 1
    assert {"/bow/speed", "/bow/position"} <= {address for _, address, _ in still.events}
    assert still.late() == 0


def test_a_held_parameter_is_sent_where_it_stays(still):
    still.player.hold("/playing/speed", 0.5)
    answer = by_address(still.ask("/preset/load", "flautando"))
    assert answer["/playing/speed"] == [0.5]
    assert answer["/error"][1].startswith("/playing/speed: held by --set, left out")
    assert still.player.value("/playing/speed") == 0.5


def test_a_fader_may_morph_sixty_times_a_second_without_reading_files(still, monkeypatch):
    end = SHIPPED.load("vibrato").values["/playing/vibrato"]
    still.ask("/preset/morph", "ordinary", "vibrato", 0.0)
    monkeypatch.setattr("yehu_server.playing.preset_folders.read_text", None)
    still.send("/note", 74.0, 90.0)
    for step in range(61):
        still.send("/preset/morph", "ordinary", "vibrato", step / 60)
        still.pass_time(1 / 60)
    assert still.player.value("/playing/vibrato") == end
    assert still.handler.counts.errors == 0
    depths = [value for _, address, value in still.events if address == "/vibrato/depth"]
    assert len(depths) > 50
    assert depths == sorted(depths)


def test_the_sound_is_saved_comes_back_and_is_deleted(still, own):
    still.send("/playing/vibrato", 33.0)
    still.send("/body/blend", 0.25)
    still.send("/playing/bend", 1.0)
    assert by_address(still.ask("/preset/save", "my sound"))["/preset/saved"] == ["my sound"]
    assert [file.name for file in own.iterdir()] == ["my sound.toml"]
    still.send("/reset")
    still.send("/playing/bend", 2.0)
    answer = by_address(still.ask("/preset/load", "my sound"))
    assert answer["/playing/vibrato"] == [33.0]
    assert answer["/body/blend"] == [0.25]
    assert still.player.value("/playing/vibrato") == 33.0
    assert still.player.value("/body/blend") == 0.25
    assert still.player.value("/playing/bend") == 2.0  # of the moment
    still.send("/playing/vibrato", 20.0)
    still.ask("/preset/save", "my sound")  # once more
    file = own / "my sound.toml"
    assert SHIPPED.find(str(file)).values["/playing/vibrato"] == 20.0
    assert by_address(still.ask("/preset/delete", "my sound")) == {"/preset/deleted": ["my sound"]}
    assert not file.exists()


def test_presets_are_saved_so_many_at_once_and_one_more_each_second(still, own, monkeypatch):
    monkeypatch.setattr(context, "time", still.clock)
    for number in range(20):
        still.send("/preset/save", f"mine {number}")
    assert len(list(own.iterdir())) == limits.SAVES_AT_ONCE
    address, reason = still.ask("/preset/save", "another")[-1].arguments
    assert (address, reason) == (
        "/yehu/preset/save",
        "files are written too often; try again in a second",
    )
    still.clock.now += 1.0 / limits.SAVES_A_SECOND
    for name in ("another", "and another"):
        still.send("/preset/save", name)
    assert len(list(own.iterdir())) == limits.SAVES_AT_ONCE + 1


def test_files_are_written_aside_and_read_in_order(still, own, monkeypatch):
    waiting = []
    monkeypatch.setattr(still.handler.context, "run_in_background", waiting.append)
    still.send("/playing/vibrato", 33.0)
    assert "/preset/saved" not in by_address(still.ask("/preset/save", "mine"))
    still.send("/playing/vibrato", 5.0)
    for call in ("/preset/load", "/preset/delete", "/preset/load"):
        still.send(call, "mine")
    assert list(own.iterdir()) == []  # a slow disk holds up nothing
    while waiting:
        waiting.pop(0)()
    heard = [message.address for message in still.peer.received()]
    answers = [each for each in heard if each.startswith(("/yehu/preset", "/yehu/error"))]
    assert answers == [
        f"/yehu{each}" for each in ("/preset/saved", "/preset/loaded", "/preset/deleted", "/error")
    ]
    assert still.player.value("/playing/vibrato") == 33.0


def test_presets_are_listed_and_a_broken_one_is_sent(still, own):
    (own / "mine.toml").write_text(HEAD + 'about = "wild"\n')
    (own / "bad.toml").write_text("version = 9\n")
    heard = still.ask("/preset/list")
    rooms = [each.arguments[0] for each in heard if each.address == "/yehu/preset/room"]
    assert {"hall", "chamber"} <= {*rooms}
    assert not {"mine", "ordinary", "flautando"} & {*rooms}
    names = ("/yehu/preset", "/yehu/preset/room")
    rows = [message.arguments for message in heard if message.address in names]
    presets = SHIPPED.all()[0]
    expected = [[preset.name, preset.program or 0, preset.about] for preset in presets]
    assert rows == sorted([*expected, ["mine", 0, "wild"]])
    rest = by_address(heard)
    assert rest["/presets"] == [len(rows)]
    address, reason = rest["/error"]
    assert address == "/yehu/preset/list"
    assert reason.startswith("bad:1: version: 9 is newer")


def test_unknown_addresses_of_a_file_are_reported_and_the_rest_is_set_but_for_a_wrong_value(
    still, own
):
    file = own / "mine.toml"
    file.write_text(HEAD + '[values]\n"/a/b" = 1\n"/playing/vibrato" = 5\n')
    answer = by_address(still.ask("/preset/load", "mine"))
    assert answer["/preset/loaded"] == ["mine"]
    assert answer["/playing/vibrato"] == [5.0]
    address, reason = answer["/error"]
    assert address == "/yehu/preset/load"
    assert "mine: unknown parameter '/a/b'" in reason
    file.write_text(HEAD + '[values]\n"/playing/vibrato" = 6\n"/playing/speed" = 5\n')
    before = still.player.values()
    (refused,) = still.ask("/preset/load", "mine")
    assert "/playing/speed: 5 is not within 0.03 to 0.6 m/s" in refused.arguments[1]
    assert still.player.values() == before  # nothing of it
