"""Notes of a controller end that falls silent (active sensing), or is not heard for a while."""

from types import SimpleNamespace

import pytest

from yehu_server.core.midi.events import DISCONNECT, EVENTS, MESSAGE
from yehu_server.live.midi import input_process
from yehu_server.live.midi.feed import MidiFeed
from yehu_server.live.midi.input_process import ACTIVE_SENSING, SENSE_EVERY_S, Input, Inputs
from yehu_server.live.midi.routes import Router
from yehu_server.system import clocks

MS = 1_000_000


class Controller:
    """One open port, a manual clock, and the events reported."""

    def __init__(self, monkeypatch) -> None:
        self.now_ns = 100_000 * MS
        self.posted: list[str] = []
        monkeypatch.setattr(input_process.time, "monotonic", lambda: 1e-9 * self.now_ns)
        monkeypatch.setattr(clocks, "monotonic_ns", lambda: self.now_ns)
        ring = SimpleNamespace(post=self.post)
        feed = MidiFeed([ring], Router([], 1), message=MESSAGE, disconnect=DISCONNECT)
        order = {"patterns": [], "others": True, "virtual": None, "api": None}
        self.inputs = Inputs(self, feed, order)
        feed.open("keystep")
        self.port = self.inputs._open["keystep"] = Input("keystep", None, feed, self)

    def post(self, time_ns: int, kind: int, index: int) -> bool:
        assert time_ns == self.now_ns
        assert index == 0
        self.posted.append(EVENTS[kind - MESSAGE])
        return True

    def send(self, event: str, **_details: object) -> None:
        self.posted.append(event)

    def sense_for(self, ms: int) -> None:
        for _ in range(round(ms / (1e3 * SENSE_EVERY_S))):
            self.now_ns += round(1e9 * SENSE_EVERY_S)
            self.inputs.sense()


@pytest.fixture
def controller(monkeypatch) -> Controller:
    controller = Controller(monkeypatch)
    controller.port.receive([ACTIVE_SENSING])
    return controller


def test_a_controller_that_falls_silent_is_reported_once(controller):
    controller.sense_for(200)
    controller.port.receive([ACTIVE_SENSING])
    controller.sense_for(300)
    assert controller.posted == []
    controller.sense_for(1000)
    assert controller.posted == ["disconnect", "silent"]


@pytest.mark.parametrize("slept_s", [0.4, 2.5, 3600.0])
def test_while_we_sleep_notes_end_once_as_their_ends_may_be_lost_but_nobody_falls_silent(
    controller, slept_s
):
    controller.sense_for(200)
    controller.now_ns += round(1e9 * slept_s)
    controller.sense_for(300)
    assert controller.posted == ["disconnect", "slept"]
    controller.port.receive([ACTIVE_SENSING])
    controller.sense_for(300)
    assert controller.posted == ["disconnect", "slept"]


def test_opening_a_port_is_no_sleep(controller):
    def ports() -> list[str]:
        controller.now_ns += 1000 * MS
        return ["keystep"]

    controller.inputs._system = SimpleNamespace(ports=ports, left=set)
    for _ in range(3):
        controller.sense_for(100)
        controller.inputs.poll()
    assert controller.posted == []


def test_clocks_and_system_exclusive_are_not_passed_on(controller):
    for data in ([0xF8], [0xF9], [0xF0, 0x7E, 9, 1, 0xF7]):
        controller.port.receive(data)
    assert controller.posted == []
