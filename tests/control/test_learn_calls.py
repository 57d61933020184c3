"""MIDI learn and the table of bindings, by OSC."""

from __future__ import annotations

import mido
import pytest
from midi_input import receive

from yehu_server.live.osc import learn_calls
from yehu_server.playing.mapping import load


@pytest.fixture(autouse=True)
def _own_settings(config_home):
    del config_home


@pytest.fixture(autouse=True)
def _clock(monkeypatch, still_time):
    monkeypatch.setattr(learn_calls, "time", still_time)


def turn(stage, control: int, *values: int, channel: int = 0) -> None:
    for value in values:
        message = mido.Message("control_change", control=control, value=value, channel=channel)
        receive(stage.player, message, frame=stage.player.frame_of(), port=0)


def told(heard, address: str) -> list[list]:
    return [message.arguments for message in heard if message.address == f"/yehu{address}"]


@pytest.mark.parametrize("address", ["/playing/vibrato", "/yehu/playing/vibrato/unit"])
def test_what_is_moved_next_moves_the_parameter_from_then_on(stage, address):
    assert told(stage.ask("/learn", address), "/learning") == [["/yehu/playing/vibrato"]]
    turn(stage, 20, 10, 20, 64)
    (learned,) = told(stage.ear.heard(), "/learned")
    assert learned[:2] == ["/yehu/playing/vibrato", "cc 20"]
    assert learned[2].endswith("keyboard.toml")
    assert stage.services.changed == ["/"]
    assert "cc 20 moves /playing/vibrato" in stage.services.said[0]
    turn(stage, 20, 127)
    assert stage.value("/playing/vibrato") == 100.0
    turn(stage, 21, 0, 127)  # only one thing is learned
    assert stage.player.mapping == load("keyboard", user_first=True)
    assert not stage.player.mapping.of("cc 21")


def test_the_file_is_written_aside_so_that_a_slow_disk_holds_up_nothing(stage, monkeypatch):
    waiting = []
    monkeypatch.setattr(stage.services, "run_in_background", waiting.append)
    stage.ask("/learn", "/playing/vibrato")
    turn(stage, 20, 10, 20, 64)
    assert told(stage.ear.heard(), "/learned") == []
    assert told(stage.ask("/unlearn", "/playing/vibrato"), "/unlearned") == []
    for write in waiting:
        write()
    heard = stage.ear.heard()
    assert told(heard, "/learned")[0][:2] == ["/yehu/playing/vibrato", "cc 20"]
    assert told(heard, "/unlearned") == [["/yehu/playing/vibrato", 1]]


def test_a_knob_of_another_box_moves_the_note_that_sounds(stage):
    for port in (0, 1):  # keyboards, both of them
        receive(stage.player, mido.Message("note_on", note=70), frame=0, port=port)
    stage.ask("/learn", "/playing/vibrato")
    turn(stage, 20, 10, 20, 64)
    assert told(stage.ear.heard(), "/learned")[0][1] == "cc 20"
    turn(stage, 20, 127)
    assert stage.value("/playing/vibrato") == 100.0


def test_a_knob_on_the_drums_channel_is_learned_and_heard(stage):
    receive(stage.player, mido.Message("note_on", note=70), frame=0, port=1)
    stage.ask("/learn", "/playing/vibrato")
    turn(stage, 20, 10, 20, 64, channel=9)
    assert told(stage.ear.heard(), "/learned")[0][1] == "cc 20"
    turn(stage, 20, 127, channel=9)
    assert stage.value("/playing/vibrato") == 100.0


def test_an_address_of_the_users_own_is_learned_as_a_knob_is(stage, wire):
    stage.ask("/learn", "/output/gain")
    for value in (0.0, 0.5):
        stage.take(wire.message("/my/fader", value))
    assert told(stage.ear.heard(), "/learned")[0][1] == "/my/fader"
    stage.take(wire.message("/my/fader", 1.0))
    assert stage.value("/output/gain") == 24.0
    assert stage.player.addresses == ("/my/fader",)


def test_one_that_moves_something_already_can_be_learned_anew(stage, wire):
    for target in ("/output/gain", "/playing/vibrato"):
        stage.ask("/learn", target)
        for value in (0.0, 0.5):
            stage.take(wire.message("/my/fader", value))
    assert [bind.target for bind in stage.player.mapping.of("/my/fader")] == ["/playing/vibrato"]


@pytest.mark.parametrize("arguments", [[], [None]])
def test_listening_can_be_ended(stage, arguments):
    stage.ask("/learn", "/playing/vibrato")
    assert told(stage.ask("/learn", *arguments), "/learning") == [[""]]
    assert not stage.player.listens
    turn(stage, 20, 0, 127)
    assert told(stage.ear.heard(), "/learned") == []
    assert not stage.player.listens


def test_what_comes_after_a_minute_is_not_learned(stage):
    stage.ask("/learn", "/playing/vibrato")
    stage.clock.now += 61.0
    turn(stage, 20, 0, 127)
    assert told(stage.ear.heard(), "/learned") == []
    assert not stage.player.mapping.of("cc 20")


def test_who_asks_last_is_served(stage):
    stage.ask("/learn", "/playing/vibrato")
    stage.ask("/learn", "/playing/tremolo")
    turn(stage, 20, 0, 127)
    assert told(stage.ear.heard(), "/learned")[0][0] == "/yehu/playing/tremolo"


@pytest.mark.parametrize("soft", [0, 1])
def test_a_soft_one_waits_for_its_place(stage, soft):
    stage.ask("/learn", "/playing/speed", soft)
    turn(stage, 20, 0, 20, 30)  # 0.2 m/s is at 80
    assert (stage.value("/playing/speed") == pytest.approx(0.2)) == bool(soft)
    turn(stage, 20, 100)
    passed = stage.value("/playing/speed")
    assert passed > 0.25
    turn(stage, 20, 30)
    assert stage.value("/playing/speed") < 0.1


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        (("/learn", "/bow/speed"), "is moved by the player"),
        (("/learn", "/playing/vibrat"), "did you mean /playing/vibrato"),
        (("/learn", 3), "expected one string"),
        (("/learn", "/playing/speed", "x"), "expected a number"),
        (("/unlearn",), "expected one string"),
        (("/bindings", 1.0), "expected 0 arguments"),
    ],
)
def test_what_cannot_be_done_is_answered(stage, call, reason):
    (error,) = told(stage.ask(*call), "/error")
    assert reason in error[1]
    assert not stage.player.listens


def test_what_cannot_be_kept_is_told_and_changes_nothing(stage, config_home):
    before = stage.player.mapping
    stage.ask("/learn", "/playing/vibrato")
    config_home.mkdir()
    (config_home / "yehu-server").write_text("a file where a folder should be")
    turn(stage, 20, 0, 127)
    assert told(stage.ear.heard(), "/error")
    assert stage.player.mapping is before


def test_what_was_learned_can_be_forgotten(stage):
    stage.ask("/learn", "/playing/speed")
    turn(stage, 20, 0, 127)
    assert not stage.player.mapping.of("cc 1")  # the knob alone moves it
    answer = told(stage.ask("/unlearn", "/playing/speed"), "/unlearned")
    assert answer == [["/yehu/playing/speed", 1]]
    assert stage.player.mapping.of("cc 1")
    assert told(stage.ask("/unlearn", "/playing/speed"), "/unlearned")[0][1] == 0


def test_every_binding_is_told_with_where_it_is(stage):
    turn(stage, 1, 127, channel=3)
    stage.pass_time(0.01)
    heard = stage.ask("/bindings")
    rows = {row[0]: row for row in told(heard, "/binding")}
    assert told(heard, "/bindings") == [[len(stage.player.mapping.binds)]]
    assert set(rows) == set(stage.player.mapping.sources)
    approx = pytest.approx
    assert rows["cc 1"] == [
        "cc 1", "/yehu/playing/speed", approx(0.12), approx(0.26), "exp", "", 1.0, approx(0.26)
    ]  # fmt: skip
    assert rows["bend"][2:4] == [-2.0, 2.0]
    assert rows["cc 7"][6] == -1.0  # not moved yet
