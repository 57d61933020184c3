"""MIDI learn and the table of bindings, by OSC."""

import mido
import pytest
from midi_input import receive
from wire import FakePeer

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc import context, learn_calls
from yehu_server.playing import learn, learner
from yehu_server.playing.learner import LearnedSource
from yehu_server.playing.mapping import load


@pytest.fixture(autouse=True)
def _own_settings(config_home):
    del config_home


@pytest.fixture(autouse=True)
def _clock(monkeypatch, still_time):
    for module in (learner, learn_calls):
        monkeypatch.setattr(module, "time", still_time)


def turn(still, control: int, *values: int, channel: int = 0) -> None:
    for value in values:
        message = mido.Message("control_change", control=control, value=value, channel=channel)
        receive(still.player, message, frame=still.player.frame_of(), port=0)


def answers(heard, address: str) -> list[list]:
    return [message.arguments for message in heard if message.address == f"/yehu{address}"]


@pytest.mark.parametrize("address", ["vibrato", "/playing/vibrato", "/yehu/playing/vibrato/unit"])
def test_what_is_moved_next_moves_the_parameter_from_then_on(still, address):
    assert answers(still.ask("/learn", address), "/learning") == [["/yehu/playing/vibrato"]]
    turn(still, 20, 10, 20, 64)
    (learned,) = answers(still.peer.received(), "/learned")
    assert learned[:2] == ["/yehu/playing/vibrato", "cc 20"]
    assert learned[2].endswith("keyboard.toml")
    assert learned[3:] == ["cc 77"]  # which keeps it
    assert still.services.changed == ["/"]
    assert "cc 20 added: /playing/vibrato; cc 77 still moves it, too" in still.services.said[0]
    turn(still, 20, 127)
    assert still.value("/playing/vibrato") == 100.0
    turn(still, 21, 0, 127)  # only one thing is learned
    assert still.player.mapping == load("keyboard", user_first=True)
    assert not still.player.mapping.of("cc 21")


def test_who_waits_is_told_that_another_learns_now(still, wire):
    first = FakePeer(2)
    still.take(wire.message("/yehu/learn", "vibrato"), first)
    first.received()
    assert answers(still.ask("/learn", "/output/gain"), "/learning") == [["/yehu/output/gain"]]
    assert answers(first.received(), "/learning") == [[""]]
    turn(still, 20, 10, 20, 64)
    assert answers(first.received(), "/learned") == []
    assert answers(still.peer.received(), "/learned")[0][0] == "/yehu/output/gain"


def test_a_fader_learns_the_range_that_it_moves_through(still, wire, subtests):
    """The first steps of 0 to 127 are those of a button, 0 and 1."""
    for number, (values, source, ends) in enumerate([
        ((-0.9, -0.5), "/fader0 (-1 to 1)", (-1.0, 1.0)),
        ((0.2, -0.3), "/fader1 (-1 to 1)", (-1.0, 1.0)),
        ((900, 1000), "/fader2 (0 to 1023)", (0.0, 1023.0)),
        (range(9), "/fader3 (0 to 127)", (0.0, 127.0)),
        ((127, 126, 100), "/fader4 (0 to 127)", (0.0, 127.0)),
        ((0.0, 0.05, 0.1), "/fader5", (0.0, 1.0)),
        ((0, 1, 0), "/fader6", (0.0, 1.0)),
        ((1, 0), "/fader7", (0.0, 1.0)),
    ]):  # fmt: skip
        with subtests.test(values=values):
            address = f"/fader{number}"
            still.ask("/learn", "/playing/vibrato")
            for value in values:
                assert answers(still.peer.received(), "/learned") == []
                still.take(wire.message(address, value))
            (learned,) = answers(still.peer.received(), "/learned")
            assert learned[1] == source
            assert source in still.services.said[-1]
            still.pass_time(0.05)
            for end, reached in zip(ends, (0.0, 100.0), strict=True):
                still.take(wire.message(address, end))
                still.pass_time(0.05)
                assert still.value("/playing/vibrato") == reached
            still.peer.received()
            for _ in range(2):
                still.take(wire.message(address, 2.0 * ends[1]))
            (told,) = still.peer.received()
            assert told.address == "/yehu/moved"
            assert "needs input = [LOWEST, HIGHEST] in the mapping keyboard" in told.arguments[1]


def test_one_sweep_is_learned_once_until_the_control_was_still(still, wire):
    for move in (
        lambda value: turn(still, 20, round(127 * value)),
        lambda value: still.take(wire.message("/A", value)),
    ):
        still.ask("/learn", "/playing/vibrato")
        for step in range(5):
            move(step / 8)
        assert [message.address for message in still.peer.received()] == ["/yehu/learned"]
        still.ask("/learn", "/playing/pressure")
        for step in range(5, 9):
            still.clock.now += 1.0
            move(step / 8)
        assert answers(still.peer.received(), "/learned") == []
        still.clock.now += 2.0
        for value in (0.0, 0.5):
            move(value)
        assert len(answers(still.peer.received(), "/learned")) == 1


def test_moves_are_no_errors_while_what_they_teach_is_being_saved(still, wire, monkeypatch):
    monkeypatch.setattr(still.handler.context, "run_in_background", lambda _write: None)
    still.ask("/learn", "/playing/vibrato")
    for step in range(9):
        still.take(wire.message("/A", step / 8))
    assert still.peer.received() == []
    still.take(wire.message("/B", 0.5))
    (error,) = answers(still.peer.received(), "/error")
    assert "did you mean" not in error[1]


def test_others_lose_the_parameter_only_if_asked(still):
    still.ask("/learn", "/playing/vibrato", 0, 1)
    turn(still, 74, 10, 20, 64)
    (learned,) = answers(still.peer.received(), "/learned")
    gone = ["cc 74", "/yehu/playing/bow_position", "cc 77", "/yehu/playing/vibrato"]
    assert learned[3] == ""
    assert sorted(learned[4:]) == sorted(gone)
    assert answers(still.ask("/learn", "/playing/vibrato", 0, 1, 0), "/error")


def test_the_file_is_written_aside_so_that_a_slow_disk_holds_up_nothing(still, monkeypatch):
    waiting = []
    monkeypatch.setattr(still.handler.context, "run_in_background", waiting.append)
    still.ask("/learn", "/playing/vibrato")
    turn(still, 20, 10, 20, 64)
    assert answers(still.peer.received(), "/learned") == []
    assert answers(still.ask("/unlearn", "/playing/vibrato"), "/unlearned") == []
    for write in waiting:
        write()
    heard = still.peer.received()
    assert answers(heard, "/learned")[0][:2] == ["/yehu/playing/vibrato", "cc 20"]
    assert answers(heard, "/unlearned")[0][:2] == ["/yehu/playing/vibrato", 1]


def test_files_are_written_so_many_at_once_and_one_more_each_second(still, monkeypatch):
    monkeypatch.setattr(context, "time", still.clock)
    for _ in range(round(limits.SAVES_AT_ONCE)):
        assert answers(still.ask("/unlearn", "/playing/vibrato"), "/unlearned")
    assert answers(still.ask("/unlearn", "/playing/vibrato"), "/error")
    assert answers(still.ask("/learn", "/playing/vibrato"), "/error")
    still.clock.now += 1.0 / limits.SAVES_A_SECOND
    assert answers(still.ask("/learn", "/playing/vibrato"), "/learning")


def test_listening_can_be_ended_and_ends_after_a_minute(still):
    def end_by(*arguments: object) -> None:
        assert answers(still.ask("/learn", *arguments), "/learning") == [[""]]
        assert not still.player.learning.waits

    for end in (
        end_by,
        lambda: end_by(None),
        lambda: setattr(still.clock, "now", still.clock.now + 61.0),
    ):
        still.ask("/learn", "/playing/vibrato")
        end()
        turn(still, 20, 0, 127)
        assert answers(still.peer.received(), "/learned") == []
        assert not still.player.mapping.of("cc 20")


def test_a_refused_call_leaves_one_that_waits(still):
    still.ask("/learn", "/playing/vibrato")
    for refused in (("/playing/none",), ("/bow/speed",), (1.0,), ("/playing/speed", "soft")):
        assert answers(still.ask("/learn", *refused), "/error")
    turn(still, 20, 0, 127)
    (learned,) = answers(still.peer.received(), "/learned")
    assert learned[:2] == ["/yehu/playing/vibrato", "cc 20"]


def test_what_cannot_be_kept_is_reported_and_changes_nothing(still, config_home):
    before = still.player.mapping
    still.ask("/learn", "/playing/vibrato")
    config_home.mkdir()
    (config_home / "yehu-server").write_text("a file where a folder should be")
    turn(still, 20, 0, 127)
    assert answers(still.peer.received(), "/error")
    assert still.player.mapping is before


def test_every_binding_is_reported_with_where_it_is(still):
    turn(still, 16, 127, channel=3)
    still.pass_time(0.01)
    heard = still.ask("/bindings")
    rows = {row[0]: row for row in answers(heard, "/binding")}
    assert answers(heard, "/bindings") == [[len(still.player.mapping.binds)]]
    assert set(rows) == {bind.source for bind in still.player.mapping.binds}
    approx = pytest.approx
    assert rows["cc 16"] == [
        "cc 16", "/yehu/playing/speed", approx(0.12), approx(0.26), "exp", "", 1.0, approx(0.26)
    ]  # fmt: skip
    assert rows["bend"][2:4] == [-2.0, 2.0]
    assert rows["cc 7"][6] == -1.0  # not moved yet


def test_what_another_server_has_learned_is_not_given_back(still):
    """Two servers of one user share a file."""
    still.ask("/learn", "/playing/vibrato")
    turn(still, 20, 0, 127)
    learn.learn(still.player.mapping, "/playing/volume", LearnedSource("/d"), soft=False)
    ((_, count, *returned),) = answers(still.ask("/unlearn", "/playing/vibrato"), "/unlearned")
    assert (count, returned) == (1, [])


def test_what_another_server_has_learned_is_kept_and_used_with_the_next_that_is_learned(still):
    still.ask("/learn", "/playing/vibrato")
    turn(still, 20, 0, 127)
    learn.learn(still.player.mapping, "/playing/volume", LearnedSource("cc 21"), soft=False)
    still.ask("/learn", "/playing/press")
    assert not still.player.mapping.of("cc 21")
    turn(still, 22, 0, 127)
    assert [len(still.player.mapping.of(f"cc {number}")) for number in (20, 21, 22)] == [1, 1, 1]
    *_, learned, others = still.services.said
    assert learned.startswith("cc 22 added: /playing/press")
    assert others == "what others changed in this file is used from now on, too"
