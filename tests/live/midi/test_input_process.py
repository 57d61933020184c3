"""The process that holds the MIDI inputs."""

import sys

import pytest

from yehu_server.live.midi import input_process
from yehu_server.system.processes import SWITCH_INTERVAL_S


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
