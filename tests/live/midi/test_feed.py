"""Messages of MIDI inputs, from the process that holds them to the rings of the parts."""

import threading
import time

import numpy as np
import pytest

from yehu_server.core.engine.event_dispatch import LEAST_COST
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import BUDGET_PER_FRAME, MIDI_INPUTS, SMALL_RING
from yehu_server.core.engine.rig import ring_place
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.events import DISCONNECT, MESSAGE
from yehu_server.core.midi.packing import packed
from yehu_server.live.midi.feed import PORTS, MidiFeed, SharedRing
from yehu_server.live.midi.routes import Route, Router

NOTE = [0x90, 67, 90]


class Ring:
    """Keeps what is posted."""

    def __init__(self) -> None:
        self.got: list[tuple[int, int, int]] = []

    def post(self, time_ns: int, kind: int, index: int) -> bool:
        self.got.append((time_ns, kind, index))
        return True


def feed(*routes: Route, parts: int = 1, **known) -> tuple[MidiFeed, list[Ring]]:
    rings = [Ring() for _ in range(parts)]
    router = Router(routes, parts)
    return MidiFeed(rings, router, message=MESSAGE, disconnect=DISCONNECT, **known), rings


def test_each_input_plays_its_part_with_channels_of_its_own():
    made, rings = feed(parts=2)
    assert [made.open(name) for name in ("a", "b", "c")] == [0, 1, 2]
    for time_ns, name in enumerate("cba"):
        made.receive(name, NOTE, time_ns)
    made.end_port_notes("c", 3, is_gone=True)
    assert rings[0].got == [(2, MESSAGE, packed(NOTE, 0))]
    assert rings[1].got == [
        (0, MESSAGE, packed(NOTE, 2)),
        (1, MESSAGE, packed(NOTE, 1)),
        (3, DISCONNECT, 2),
    ]


def test_a_channel_plays_its_part_and_a_reset_all_of_the_input():
    made, rings = feed(Route(0, "daw", 0), Route(2, "daw", 1), parts=3)
    made.open("daw")
    for data in (NOTE, [0x91, 67, 90], [0x92, 67, 90], [0xFF]):
        made.receive("daw", data, 0)
    sent = [[index & 0xFF for _, _, index in ring.got] for ring in rings]
    assert sent == [[0x90, 0xFF], [], [0x91, 0xFF]]


def test_an_input_that_comes_back_has_its_number_and_a_new_one_that_of_one_that_is_gone():
    made, _ = feed(numbers={"before": 3})
    names = [f"input {number}" for number in range(PORTS - 1)]
    numbers = [made.open(name) for name in names]
    assert sorted(numbers) == [number for number in range(PORTS) if number != 3]
    assert made.open("before") == 3
    assert made.open("too many") is None
    made.end_port_notes(names[5], 0, is_gone=True)
    assert made.open(names[5]) == numbers[5]
    made.end_port_notes(names[5], 0, is_gone=True)
    assert made.open("another") == numbers[5]
    assert made.open(names[5]) is None


@pytest.fixture
def shared() -> tuple[Instrument, SharedRing]:
    instrument = Instrument(InstrumentSpec(48000.0), is_live=True)
    return instrument, SharedRing(instrument.memory, ring_place(MIDI_INPUTS, 0))


def test_the_callback_takes_messages_from_shared_memory_at_their_time(shared):
    instrument, ring = shared
    out = np.zeros(64, np.float32)
    instrument.process(out)
    instrument.delay = 480
    late_ns = time.monotonic_ns() + 10_000_000_000  # seconds ahead: it stays
    assert ring.post(0, MESSAGE, packed(NOTE, 2))
    assert ring.post(late_ns, MESSAGE, packed([0x90, 70, 90]))
    instrument.process(out)
    midi = instrument.midi
    assert midi["messages"] == 1
    assert midi["held_channel"][: midi["held"]].tolist() == [32]
    assert instrument.dropped_events == 0


def test_what_is_no_message_is_counted_and_kept_and_plays_nothing(shared):
    instrument, ring = shared
    damaged = [[0x90, 200, 1], [0x90, 67, 128], [0xD0, 67, 1], [0x90, 67], [0x43, 67, 1]]
    for count, data in enumerate(damaged, 1):
        ring.post(0, MESSAGE, packed(data, 2))
        instrument.process(np.zeros(64, np.float32))
        midi = instrument.midi
        assert midi["malformed"] == count, data
        assert midi["malformed_last"] == packed(data, 2)
    assert midi["held"] == 0


def test_the_last_that_is_no_message_is_in_the_status(live, until):
    assert live.server.status()["midi_malformed_last"] == ""
    ring = SharedRing(live.server.output.memory.buffer, ring_place(MIDI_INPUTS, 0))
    assert ring.post(0, MESSAGE, packed([0xD0, 0x4A, 0x11], 0))
    until(lambda: live.server.status()["midi_malformed"] == 1, "it to be counted")
    assert live.server.status()["midi_malformed_last"] == "d0 4a 11"


def test_threads_of_several_inputs_lose_nothing(shared):
    instrument, ring = shared
    made = MidiFeed([ring], Router([], 1), message=MESSAGE, disconnect=DISCONNECT)
    made.open("a"), made.open("b")
    count = SMALL_RING // 4

    def send(name: str) -> None:
        for _ in range(count):
            made.receive(name, [0xB0, 20, 1], 0)

    threads = [threading.Thread(target=send, args=(name,)) for name in "ab"]
    for thread in threads:
        thread.start()
    out = np.zeros(64, np.float32)
    while any(thread.is_alive() for thread in threads):
        instrument.process(out)
    for _ in range(1 + LEAST_COST * 2 * count // (BUDGET_PER_FRAME * len(out))):
        instrument.process(out)
    assert instrument.midi["messages"] == 2 * count
