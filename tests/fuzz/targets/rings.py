"""The rings of events in shared memory, as writers that lost their mind leave them."""

import functools

import numpy as np
from fuzz.target import Program, target

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import WRITERS
from yehu_server.core.engine.rig import RING_SIZES
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.events import TABLES_TO
from yehu_server.core.player.commands import BEGIN, COMMAND

RINGS = ("ring", "midi_ring", "page_ring", "sound_ring")  # by writer
MAX_EVENTS = 64
BLOCK = 64


@functools.cache
def _made() -> tuple[Instrument, np.ndarray]:
    instrument = Instrument(InstrumentSpec(22050.0))
    instrument.process(np.zeros(BLOCK, np.float32))  # compiled now, not within an input's bounds
    return instrument, instrument._rig.copy()


@target("event-ring", words=(b"\xff" * 8, b"\0" * 7 + b"\x80", b"\xff" * 7 + b"\x7f"))
def event_ring(data: bytes) -> None:
    """Any bytes in a ring, and any cursor of its writer: sound stays finite, and others are heard.

    The first byte chooses the writer, and how its cursor moves: as it should, by any number, back,
    or a lap ahead. Each event begins with a byte that chooses how much of it is any bytes.
    """
    instrument, fresh = _made()
    rig = instrument._rig
    rig[:] = fresh
    program = Program(data)
    head = program.byte()
    writer, size = head % WRITERS, int(RING_SIZES[head % WRITERS])
    ring, mail = rig[RINGS[writer]][0], rig["mail"][0]
    place = posted = int(mail["posted"][writer, 0])
    now = instrument.frame
    for _ in range(MAX_EVENTS):
        if not program:
            break
        how = program.byte()
        event = np.frombuffer(program.full(COMMAND.itemsize), COMMAND)[0].copy()
        if how & 1:
            event["frame"] = now + how
        if how & 2:
            event["kind"] = how % (TABLES_TO + 1)
        if how & 4:
            event["index"] = how
        ring[posted % size] = event
        posted += 1
    by = int.from_bytes(program.full(8), "little", signed=True)
    at = [posted, posted + by % (1 << 62), place - 1 - by % (1 << 32), posted + size][
        head // WRITERS % 4
    ]
    mail["posted"][writer, 0] = at
    out = np.zeros((8, BLOCK), np.float32)
    for block in out:
        instrument.process(block)
    assert np.isfinite(out).all()
    assert instrument.frame == now + out.size
    drained, pending = int(mail["drained"][writer, 0]), int(mail["pending_events"])
    assert drained == at or at - drained <= size
    assert 0 <= pending <= MAX_EVENTS + size
    check_a_note_is_heard(instrument)


def check_a_note_is_heard(instrument: Instrument) -> None:
    """The note of a server in its right mind begins."""
    mail = instrument._rig["mail"][0]
    applied = int(mail["applied"])
    assert instrument.post(BEGIN, frame=instrument.frame, index=5, value=69.0, other=0.8)
    for _ in range(4):
        instrument.process(np.zeros(BLOCK, np.float32))
    assert int(mail["applied"]) > applied
