"""The process that holds the MIDI inputs."""

import sys
from collections.abc import Callable
from unittest.mock import Mock

import pytest

from yehu_server.live.midi import input_process
from yehu_server.live.midi.midi_inputs import MidiInputs, MidiOptions
from yehu_server.system.processes import SWITCH_INTERVAL_S


class Desk:
    """A MIDI system whose ports come and go."""

    name = "desk"

    def __init__(self) -> None:
        self.names = ["Pads:out"]

    def ports(self) -> list[str]:
        return self.names

    def left(self) -> set[str]:
        return set()

    def open(self, *_) -> Callable[[], None]:
        return lambda: None


def test_a_keyboard_that_no_name_matches_says_so_when_it_is_plugged_in(monkeypatch):
    desk, lines = Desk(), []
    monkeypatch.setattr(input_process, "open_system", lambda _: desk)
    options = MidiOptions(patterns=["keystap"])
    inputs = MidiInputs([Mock()], options, Mock(), [0], lines.append)
    parent = Mock(send=lambda kind, **event: inputs.on_event({"event": kind, **event}))
    order = {"patterns": options.patterns, "virtual": None, "api": None}
    process = input_process.Inputs(parent, Mock(open=lambda _: 0), order)
    for names in (["Pads:out"], ["Pads:out", "KeyStep:out", "Midi Through:0"], ["keystap:1"]):
        desk.names = names
        process.poll()
        process.poll()
    assert lines == [
        "MIDI: no input matches 'keystap' yet (there are: Pads:out)",
        "MIDI: KeyStep:out is connected, but plays nothing: --midi-in names keystap",
        "MIDI: keystap:1 is connected",
    ]


def test_its_threads_take_short_turns_as_jack_waits_for_none(monkeypatch):
    def start() -> None:
        assert sys.getswitchinterval() == pytest.approx(SWITCH_INTERVAL_S)
        raise EOFError

    monkeypatch.setattr(input_process, "Parent", start)
    before = sys.getswitchinterval()
    try:
        with pytest.raises(EOFError):
            input_process.main()
    finally:
        sys.setswitchinterval(before)
