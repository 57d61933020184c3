"""Which MIDI input plays which part."""

from types import SimpleNamespace

import pytest

from yehu_server.errors import ParameterError
from yehu_server.live.midi.midi_inputs import MidiInputs, MidiOptions
from yehu_server.live.midi.routes import Route, Router, check_routes, route_of

NOTE = [0x90, 67, 90]


def test_an_input_is_words_of_its_name_and_a_channel():
    for text, route in [
        ("keystep", Route(0, "keystep")),
        ("Key  Step", Route(0, "Key Step")),
        ("keystep:1", Route(0, "keystep", 0)),
        ("keystep:16", Route(0, "keystep", 15)),
        (":3", Route(0, "", 2)),
        ("a2j:keys", Route(0, "a2j:keys")),
        ("a2j:keys:4", Route(0, "a2j:keys", 3)),
    ]:
        assert route_of(0, text) == route
    for text in ("", " ", "keys:0", "keys:17", ":0", "keys:99999999999999"):
        with pytest.raises(ParameterError) as error:
            route_of(0, text)
        assert len(str(error.value)) < 120


def routes(*texts: str) -> list[Route]:
    return [route_of(int(text[0]) - 1, text[2:]) for text in texts]


def test_an_input_that_is_named_twice_is_refused_but_shared_by_its_channels():
    for twice in [
        ("1=keys", "1=keys"),
        ("1=keys", "2=KEYS"),
        ("1=keys:2", "2=keys"),
        ("1=keys", "2=keys:2"),
        ("1=keys:2", "2=keys:2"),
        ("1=:2", "2=:2"),
        ("1=key step", "2=step  key"),
    ]:
        with pytest.raises(ParameterError, match="named twice"):
            check_routes(routes(*twice), 2)
    check_routes(routes("1=keys:1", "2=keys:2", "1=breath", "3=:3"), 3)
    for part, parts in ("4=keys", 3), ("2=keys", 1), ("0=keys", 3):
        with pytest.raises(ParameterError, match=f"no part {part[0]}: there"):
            check_routes(routes(part), parts)


def test_by_default_each_input_plays_a_part_and_further_ones_the_last():
    router = Router([], 3)
    names = ["a", "b", "c", "d", "e"]
    assert [router.parts_of(name) for name in names] == [[0], [1], [2], [2], [2]]
    assert [router.parts_of(name) for name in reversed(names)] == [[2], [2], [2], [1], [0]]
    assert router.wants_others
    assert router.patterns == []
    assert [Router([], 1).parts_of(name, 3) for name in "abc"] == [[0], [0], [0]]


def test_inputs_that_are_not_named_play_the_parts_that_are_not():
    router = Router(routes("2=keystep", "2=breath"), 3)
    assert router.parts_of("Keystep MIDI 1", 5) == [1]
    assert router.parts_of("Breath Controller") == [1]
    assert [router.parts_of(name) for name in ["x", "y", "z"]] == [[0], [2], [2]]
    assert router.wants_others
    assert router.patterns == ["keystep", "breath"]


def test_channels_of_an_input_play_their_parts():
    router = Router(routes("1=daw:1", "2=daw:2", "3=:3"), 3)
    assert [router.parts_of("daw", channel) for channel in range(4)] == [[0], [1], [2], []]
    assert router.parts_of("other", 2) == [2]
    assert router.parts_of("other", 0) == []
    assert router.parts_of("daw") == [0, 1, 2]  # such as a reset of the whole input
    assert router.wants_others


class Player:
    """Keeps what it hears to learn from, and what it lets go of."""

    def __init__(self) -> None:
        self.learning = SimpleNamespace(waits=True, hear_message=self.hear_message)
        self.heard: list[tuple[str, int]] = []
        self.let_go: list[int] = []

    def frame_of(self) -> int:
        return 0

    def hear_message(self, message, port: int) -> None:
        self.heard.append((message.type, port))

    def end_port_notes(self, port: int, *, frame: int) -> None:  # noqa: ARG002
        self.let_go.append(port)


def opened(parts: int, *texts: str) -> tuple[list[Player], MidiInputs, list[str]]:
    players, said = [Player() for _ in range(parts)], []
    options, memory = MidiOptions(routes=routes(*texts)), SimpleNamespace(inherited=[])
    ports = MidiInputs(players, options, memory, range(parts), said.append)
    for number, name in enumerate(("first", "second", "third")):
        ports.on_event({"event": "appeared", "port": name, "number": number})
    return players, ports, said


def test_what_an_input_plays_is_reported_as_it_comes():
    players, ports, said = opened(2)
    assert said == [
        "MIDI: first is connected to part 1",
        "MIDI: second is connected to part 2",
        "MIDI: third is connected to part 2",
    ]
    ports.on_event({"event": "vanished", "port": "first"})
    ports.on_event({"event": "appeared", "port": "first", "number": 0})
    assert said[-1] == "MIDI: first is connected to part 1"
    _, _, said = opened(3, "1=first:1", "3=first:2", "2=second")
    assert said == [
        "MIDI: first is connected to parts 1, 3",
        "MIDI: second is connected to part 2",
        "MIDI: third is connected, and plays no part",
    ]
    assert [player.let_go for player in players] == [[], []]


def test_players_that_listen_hear_what_their_input_sends_and_damage_is_nothing():
    players, ports, _ = opened(2)
    for name in ("third", "second", "first"):
        ports.on_event({"event": "midi", "port": name, "bytes": NOTE})
        ports.on_event({"event": "midi", "port": name, "bytes": [0x90, 200, 1]})
    assert [player.heard for player in players] == [
        [("note_on", 0)],
        [("note_on", 2), ("note_on", 1)],
    ]


def test_notes_of_inputs_whose_process_died_are_ended():
    players, ports, said = opened(2)
    ports.on_exit(by_itself=True)
    assert [player.let_go for player in players] == [[0], [1, 2]]
    assert said[-1] == "MIDI: first, second, third gone; notes are ended"
    assert ports.connected == []
