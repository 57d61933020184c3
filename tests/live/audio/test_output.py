"""The way out: what it does where the device's process fails, dies or does not answer."""

import queue
import threading
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from sound import alone
from waiting import until

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.errors import DeviceError
from yehu_server.live.audio import output, stream
from yehu_server.live.audio.devices import INPUT
from yehu_server.live.audio.output import Output, OutputOptions

ANSWERS = {
    "search": {"event": "found", "name": "card", "rate": 48000.0, "channels": 2},
    "open": {"event": "ready", "latency_ms": 5.0},
    "start": {"event": "failed", "reason": "it does not start"},
}


class AudioProcess:
    """An audio process whose stream opens but does not start; or that answers only some orders."""

    def __init__(self, _module, heard, share=(), answers=ANSWERS) -> None:
        del share
        self._heard, self._answers = heard, answers

    def send(self, order: str, **_details: object) -> None:
        if order in self._answers:
            self._heard(self._answers[order])

    def kill(self) -> None:
        pass

    stop = kill


def ensemble_for(way_out: Output) -> Ensemble:
    return alone(way_out.find(), memory=way_out.memory.buffer, channels=2)


def test_while_a_device_does_not_start_time_goes_on(monkeypatch):
    monkeypatch.setattr(output, "Child", AudioProcess)
    way_out = Output(OutputOptions(), lambda _line: None)
    stage = ensemble_for(way_out)
    instrument = stage.first
    try:
        way_out.begin(stage)  # waits once
        for _ in range(7):  # beyond the second try
            frame = instrument.frame + int(stage.rate) // 5
            until(lambda frame=frame: instrument.frame >= frame, "time to go on")
    finally:
        way_out.end()


def test_a_block_that_a_device_died_in_as_it_started_is_put_in_order(monkeypatch):
    class Dying(AudioProcess):
        def send(self, order: str, **details: object) -> None:
            if order == "start":
                stage.first._rig["meters"]["running"] = 1  # as in the middle of a block
            super().send(order, **details)

    monkeypatch.setattr(output, "Child", Dying)
    way_out = Output(OutputOptions(device="card"), lambda _line: None)
    stage = ensemble_for(way_out)
    with pytest.raises(DeviceError, match="it does not start"):
        way_out.begin(stage)
    way_out.end()
    assert len(stage.gaps) == 1


@pytest.mark.parametrize(
    ("unanswered", "whose"),
    [("search", "the sound system"), ("open", "the audio device"), ("start", "the audio device")],
)
def test_a_process_that_does_not_answer_is_waited_for_no_longer(monkeypatch, unanswered, whose):
    clock = partial(iter, np.arange(0.0, 2.0 * output.ANSWER_WITHIN_S, 0.25))  # and then it fails
    monkeypatch.setattr(output, "AwakeTime", lambda: clock().__next__)
    monkeypatch.setattr(output, "LISTEN_S", 0.0)
    answers = {order: answer for order, answer in ANSWERS.items() if order != unanswered}
    monkeypatch.setattr(output, "Child", partial(AudioProcess, answers=answers))
    way_out = Output(OutputOptions(device="card"), lambda _line: None)
    with pytest.raises(DeviceError, match=f"^{whose} does not answer$"):
        way_out.begin(ensemble_for(way_out))
    way_out.end()


@pytest.fixture
def process(monkeypatch) -> Callable[..., list[str]]:
    """Give a device's process some orders, and the end; what its stream does and it reports."""

    def run(*orders: str) -> list[str]:
        done: list[str] = []

        class Stream:
            latency_ms = 5.0

            def __init__(self, *_what: object) -> None:
                done.append("opened")

            def start(self) -> None:
                done.append("plays")

        parent = SimpleNamespace(send=lambda event, **_details: done.append(event))
        given: queue.Queue = queue.Queue()
        for order in orders:
            given.put({"order": order, "kind": INPUT})
        given.put(None)
        sounddevice = SimpleNamespace(PortAudioError=OSError)
        monkeypatch.setattr(stream, "load_portaudio", lambda _kind: sounddevice)
        monkeypatch.setattr(stream, "_search", lambda *_: done.append("found") or object())
        monkeypatch.setattr(stream, "_watch", lambda *_: None)
        monkeypatch.setattr(stream, "Stream", Stream)
        stream._serve(parent, given)
        return done

    return run


def test_a_device_plays_only_once_the_clock_has_let_go(process):
    """They would both compute the same block: the order comes once the clock has stopped."""
    assert process("search") == ["found"]
    assert process("search", "open") == ["found", "opened", "ready"]
    started = ["found", "opened", "ready", "plays", "started"]
    assert process("search", "open", "start") == started


@pytest.mark.parametrize(
    ("reported_s", "latency_ms"), [(0.01, 10.0), (89478.464, 0.0), (-1.0, 0.0)]
)
def test_a_latency_that_cannot_be_is_none(reported_s, latency_ms):
    opened = object.__new__(stream.Stream)
    opened._stream = SimpleNamespace(latency=reported_s)
    assert opened.latency_ms == pytest.approx(latency_ms)


def test_the_silent_clock_keeps_time_also_where_pythons_has_steps(monkeypatch):
    """On Windows ``time.monotonic`` has steps of 16 ms, of six blocks."""
    clock = SimpleNamespace(now=0.0, slept=[])

    def sleep(seconds):
        clock.slept.append(seconds)
        clock.now += seconds

    monkeypatch.setattr(
        output,
        "time",
        SimpleNamespace(sleep=sleep, monotonic=lambda: clock.now // 0.016 * 0.016),
    )
    monkeypatch.setattr(output, "monotonic_ns", lambda: round(clock.now * 1e9))
    enough = threading.Event()
    ensemble = SimpleNamespace(
        rate=48000.0, channels=2, process=lambda _block: len(clock.slept) > 50 and enough.set()
    )
    silent = output.SilentClock(ensemble, 128)
    assert enough.wait(10.0)
    silent.stop()
    assert clock.slept == pytest.approx([128 / 48000] * len(clock.slept), rel=1e-3)
