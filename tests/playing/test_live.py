"""OSC, MIDI and direct writes to one instrument, in the order of frames."""

import threading
import time

import mido
import numpy as np
import pytest
from midi_input import receive
from sound import run

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.playing.bind import Bind
from yehu_server.playing.delay import Arrivals
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import player_of
from yehu_server.playing.player import Player

RATE = 48000.0
VOLUME = "/playing/volume"


@pytest.fixture
def instrument() -> Instrument:
    instrument = Instrument(InstrumentSpec(RATE))
    instrument.report_commands()
    return instrument


@pytest.fixture
def live(instrument) -> Player:
    return player_of(0, PlayingOptions(), [instrument], delay_ms=3.0)


def test_a_note_is_heard_at_its_frame(live, instrument):
    live.key_on(67.0, 90.0, frame=500)
    live.key_off(67.0, frame=600)
    run(instrument, 500)
    assert live.pitch is None
    assert instrument.target("/bow/speed") == 0.0
    run(instrument, 1)
    assert live.pitch == pytest.approx(67.0, abs=0.5)  # a finger varies
    assert instrument.target("/bow/speed") != 0.0
    run(instrument, 99)
    assert live.pitch is not None
    run(instrument, 1)
    assert live.pitch is None
    assert instrument.target("/bow/speed") == 0.0


def test_what_arrives_is_heard_a_constant_time_later(live, instrument):
    run(instrument, 480)
    now = int(instrument.meters()["loop"]["due_ns"])
    frames = [live.frame_of(now + ns) for ns in range(0, 10_000_000, 1_000_000)]
    assert frames[0] == pytest.approx(144, abs=1)  # 3 ms after the block's beginning
    assert np.diff(frames) == pytest.approx(48, abs=1)


def test_messages_of_one_source_keep_their_order_where_the_delay_becomes_shorter(live, instrument):
    instrument.process(np.zeros(480, np.float32))
    arrivals, frames = Arrivals(live.frame_of, instrument.rate), []
    for number in range(100):
        live.instrument.delay = 1072 if 20 <= number < 60 else 176
        frames.append(arrivals.frame_of(time.monotonic_ns() + 100_000 * number))
    assert frames == sorted(frames)
    assert frames[30] - frames[10] >= 1072 - 176  # more, unless the clock has come to its end


@pytest.mark.parametrize("ending", ["note_off", "end_notes", "panic"])
def test_a_note_that_is_ended_before_it_begins_does_not_hang(live, instrument, ending):
    live.key_on(67.0, 90.0, frame=500)  # with a time tag
    live.key_off(67.0, frame=360)
    if ending != "note_off":
        getattr(live, ending)(frame=700)
    run(instrument, 1000)
    assert live.pitch is None
    assert instrument.target("/bow/speed") == 0.0


def test_what_was_set_is_reported_until_it_is_reached_and_then_what_became_of_it(live, instrument):
    live.set("/bow/speed", 0.11, frame=500)
    live.key_on(67.0, 90.0, frame=600)
    assert live.value("/bow/speed") == 0.11
    for frames in (400, 200):
        run(instrument, frames)
        assert live.value("/bow/speed") == 0.11
    assert instrument.target("/bow/speed") == 0.11
    run(instrument, 1)
    assert live.value("/bow/speed") == instrument.target("/bow/speed") != 0.11


def test_of_mappings_that_come_at_once_the_last_is_used_and_nobody_waits(
    live, instrument, monkeypatch
):
    mappings = [Mapping(f"{n}", (Bind(f"cc {n}", VOLUME),)) for n in range(20, 25)]
    with monkeypatch.context() as patch:
        patch.setattr(time, "sleep", lambda _seconds: pytest.fail("it waits"))
        for mapping in mappings:  # more than the audio side can have waiting
            live.remap(mapping, frame=1000)
    for _ in range(2):
        run(instrument, 2400)
        live.finish_remap()
    assert live.mapping == mappings[-1]
    live.receive(mido.Message("control_change", control=24, value=0), frame=instrument.frame)
    live.receive(mido.Message("control_change", control=20, value=127), frame=instrument.frame)
    run(instrument, 4800)
    assert live.value(VOLUME) == 0.0


@pytest.mark.parametrize("ending", ["panic", "reset", "end_notes"])
def test_nothing_sounds_on_after_the_end_and_a_panic_is_silent_within_ten_milliseconds(
    live, instrument, ending
):
    receive(live, mido.Message("control_change", control=64, value=127), frame=0, port=0)
    receive(live, mido.Message("note_on", note=72, velocity=90), frame=0, port=0)
    receive(live, mido.Message("note_off", note=72), frame=100, port=0)
    live.key_on(67.0, 90.0, frame=200)
    run(instrument, 9600)
    live.draw(0.2, 1.0, frame=9600)
    run(instrument, 9600)
    getattr(live, ending)(frame=19200)
    tail = run(instrument, 2 * 48000)
    assert live.pitch is None
    assert np.abs(tail[-4800:]).max() < 1e-3
    assert not (ending == "panic" and tail[480:].any())
    assert instrument.target("/bow/speed") == 0.0


def test_many_threads_take_turns_without_a_torn_note(live, instrument):
    def hammer(thread: int) -> None:
        for turn in range(200):
            note = 65.0 + (turn * 7 + thread) % 24
            live.key_on(note, 90.0, frame=turn)
            live.key_off(note, frame=turn)

    threads = [threading.Thread(target=hammer, args=(thread,)) for thread in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    run(instrument, 4096)
    assert live.pitch is None
    frames = instrument.applied_commands()["frame"]
    assert instrument.dropped_events == 0
    assert len(frames) >= 1600
    assert (np.diff(frames) >= 0).all()
    assert instrument.target("/bow/speed") == 0.0  # the bow rests
