"""Whatever is sent, the work for a frame is bounded, and no writer makes another late."""

import numpy as np
import pytest
import sound

from yehu_server.core.engine import native
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import (
    BUDGET_PER_FRAME,
    KIND_BITS,
    LIVE_BUDGET,
    MIDI_INPUTS,
    PAGE_QUEUE,
    PAGES,
    RESERVE,
    SENDER_QUEUE,
    SENDER_QUEUES,
    SERVER,
    SMALL_RING,
)
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.events import LEAVE, MESSAGE, NOTE_ON, RELEASE_ALL, START
from yehu_server.core.midi.packing import packed
from yehu_server.core.player.commands import BEGIN, DRAW, END, EXPRESS, LIFT, SLIDE, WRITE, cost
from yehu_server.core.player.parameter_indices import INDEX

RATE, BLOCK = 22050, 64
VOLUME = INDEX["/playing/volume"]
DUE = 1000  # a frame to come
MARK = 55.0  # the pitch of notes that are looked for


def live() -> Instrument:
    instrument = Instrument(InstrumentSpec(RATE), is_live=True)
    instrument.report_commands()
    return instrument


def post(instrument: Instrument, writer: int, frame: int, kind: int, *numbers: float) -> None:
    index, value, other = (*numbers, 0, 0.0, 0.0)[:3]
    native.post_from.call(
        instrument.address, writer, frame, kind, int(index), float(value), float(other)
    )


def post_of_page(instrument: Instrument, page: int, frame: int, kind: int, *numbers: float) -> None:
    post(instrument, PAGES, frame, kind + (page << KIND_BITS), *numbers)


def post_of_sender(
    instrument: Instrument, sender: int, frame: int, kind: int, *numbers: float
) -> None:
    post(instrument, SERVER, frame, kind + (sender << KIND_BITS), *numbers)


def play(instrument: Instrument, frames: int, block: int = BLOCK) -> list[tuple]:
    """Play on; return the commands that were applied: frame, kind, index, value, other."""
    applied = []
    for begin in range(0, frames, block):
        sound.run(instrument, min(block, frames - begin), block=block)
        applied += instrument.applied_commands().tolist()
    return applied


def fill_queues(instrument: Instrument, pages: int, due: int = DUE, kind: int = END) -> int:
    """Fill the queues of pages, with ends of notes that nobody plays; return how many."""
    for n in range(PAGE_QUEUE - RESERVE):
        for page in range(pages):
            post_of_page(instrument, page, due, kind, 7, 60.0 + n % 12)
        if n % 16 == 0:  # or the ring is full
            play(instrument, BLOCK)
    play(instrument, 4 * BLOCK)
    assert instrument.frame < due
    assert instrument.dropped_events == 0
    return pages * (PAGE_QUEUE - RESERVE)


def frames_of(applied: list[tuple], kind: int, value: float) -> list[int]:
    return [frame for frame, its, _, its_value, _ in applied if (its, its_value) == (kind, value)]


@pytest.mark.parametrize("kind", [BEGIN, END, SLIDE, LIFT])
def test_events_of_one_frame_come_as_far_as_they_may_cost_and_the_rest_later(kind: int) -> None:
    instrument = live()
    count, price = fill_queues(instrument, 12, due := 4000, kind), cost(kind, 7, 0.0)
    applied = play(instrument, due + count - instrument.frame)
    frames = np.array([frame for frame, *_ in applied])
    assert len(frames) == count
    assert frames[0] == due
    for window in (1, 7, 64, 128):
        most = max(((frames >= at) & (frames < at + window)).sum() for at in frames)
        assert (most - 1) * price <= LIVE_BUDGET + BUDGET_PER_FRAME * (window - 1), window
    assert frames[-1] <= due + count * price / BUDGET_PER_FRAME


def test_what_takes_long_costs_more() -> None:
    followed = cost(WRITE, INDEX["/playing/velocity"], 0.0)
    assert cost(EXPRESS, VOLUME, 0.0) < cost(WRITE, VOLUME, 0.0) < followed < cost(BEGIN, 1, 0.0)
    # Of more keys that end the last does the work, less than where one begins among as many.
    assert cost(END, 1, 1.0) < cost(END, 1, 0.0) < cost(BEGIN, 1, 0.0)
    assert cost(-5, 0, 0.0) == cost(99, 0, 0.0) == 1
    assert cost(WRITE, -1, 0.0) == cost(WRITE, 1 << 20, 0.0) == cost(WRITE, VOLUME, 0.0)


@pytest.mark.parametrize("block", [1, 33, 1000])
def test_what_is_deferred_does_not_depend_on_the_size_of_blocks(block: int) -> None:
    found = []
    for size in (BLOCK, block):
        instrument = live()
        fill_queues(instrument, 3, due := 4000)
        for n in range(600):
            post(instrument, SERVER, due + n % 5, WRITE, VOLUME, n / 600)
            post_of_page(instrument, 9 + n % 3, due + n % 70, WRITE, VOLUME, n / 600)
        found.append(play(instrument, due + 1200 - instrument.frame, size))
    assert len(found[0]) > 1200
    assert found[0] == found[1]


def test_a_note_of_midi_of_the_server_and_of_a_page_is_not_late_for_what_other_pages_send() -> None:
    instrument = live()
    count = fill_queues(instrument, 12, due := 4000)
    play(instrument, due - instrument.frame)
    now = instrument.frame
    post_of_page(instrument, 40, now, BEGIN, 1, MARK, MARK)
    post(instrument, SERVER, now, BEGIN, 2, MARK + 1, MARK + 1)
    post(instrument, MIDI_INPUTS, 0, MESSAGE, packed([0x90, int(MARK) + 2, 100], 0))
    applied = play(instrument, 2 * count)
    (page,), (server,), (midi,) = (frames_of(applied, BEGIN, MARK + n) for n in range(3))
    assert server < now + BLOCK
    assert midi < now + BLOCK
    assert page < now + BLOCK
    ends = [frame for frame, kind, *_ in applied if kind == END]
    assert max(ends) > now + 4 * BLOCK


@pytest.mark.parametrize("by", ["MIDI", "a page"])
def test_neither_midi_nor_a_page_is_late_for_what_the_server_is_sent(by: str) -> None:
    instrument = live()
    for n in range(8000):
        post(instrument, SERVER, DUE, END, 7, 60.0 + n % 12)
    play(instrument, DUE - instrument.frame)
    if by == "MIDI":
        post(instrument, MIDI_INPUTS, 0, MESSAGE, packed([0x90, int(MARK), 100], 0))
    else:
        post_of_page(instrument, 5, instrument.frame, BEGIN, 1, MARK, MARK)
    applied = play(instrument, 4000)
    (frame,) = frames_of(applied, BEGIN, MARK)
    assert frame < DUE + BLOCK
    assert max(frame for frame, *_ in applied) > DUE + 1000


@pytest.mark.parametrize("block", [64, 128])
def test_a_note_of_a_sender_is_not_late_for_bundles_of_others(block: int) -> None:
    instrument = live()
    wanted, applied = [], []
    for n in range(60):
        for sender in range(2, SENDER_QUEUES + 1) if n % 15 == 0 else ():
            for key in range(200 if sender == 2 else 26):
                post_of_sender(instrument, sender, instrument.frame, NOTE_ON, 7, 60.0 + key, 0.5)
        wanted.append(instrument.frame)
        post_of_sender(instrument, 1, instrument.frame, BEGIN, 2, MARK + n / 100, MARK)
        applied += play(instrument, block, block)
    applied += play(instrument, 3000, block)
    found = [frames_of(applied, BEGIN, MARK + n / 100) for n in range(60)]
    late = [frame - asked for (frame,), asked in zip(found, wanted, strict=True)]
    assert max(late) < block
    assert instrument.dropped_events == 0


def test_of_twelve_senders_eleven_are_not_late_for_the_one_that_floods() -> None:
    instrument = live()
    for n in range(900):
        post_of_sender(instrument, 12, 0, NOTE_ON, 7, 60.0 + n, 0.5)
    applied, now = play(instrument, BLOCK), instrument.frame
    for sender in range(1, 12):
        post_of_sender(instrument, sender, now, BEGIN, sender, MARK + sender / 100, MARK)
    applied += play(instrument, 3000)
    for sender in range(1, 12):
        (frame,) = frames_of(applied, BEGIN, MARK + sender / 100)
        assert frame < now + BLOCK
    assert max(frame for frame, *_ in applied) > now + 4 * BLOCK


def test_where_the_queues_of_all_senders_are_full_each_plays_a_thousand_notes_a_second() -> None:
    instrument, senders = live(), range(1, SENDER_QUEUES + 1)
    room = (SENDER_QUEUE - RESERVE) // 2
    for n in range(room):
        for sender in senders:
            post_of_sender(instrument, sender, DUE, NOTE_ON, sender, 40.0 + n % 40, 0.5)
            post_of_sender(instrument, sender, DUE, END, sender, 40.0 + n % 40)
        play(instrument, 8 if n % 8 == 0 else 0)  # or the ring is full
    assert instrument.frame < DUE
    applied = play(instrument, DUE + RATE // 4 - instrument.frame)
    found = [sum(command[1:3] == (BEGIN, sender) for command in applied) for sender in senders]
    assert max(found) - min(found) <= 1
    assert min(found) * 4 * 44_100 / RATE > 1_000
    assert max(found) < room
    assert instrument.dropped_events == 0


def test_a_sender_that_fills_its_queue_loses_its_own_events_alone() -> None:
    instrument = live()
    room = SENDER_QUEUE - RESERVE
    for n in range(room + 50):
        post_of_sender(instrument, 3, DUE, WRITE, VOLUME, n / 10000)
        if n % 1000 == 0:  # or more than is drained for a block waits
            play(instrument, BLOCK)
    post_of_sender(instrument, 3, DUE, RELEASE_ALL)
    post_of_sender(instrument, 4, DUE, SLIDE, 0, MARK)
    post(instrument, SERVER, DUE, SLIDE, 0, MARK + 1)
    applied = play(instrument, DUE + 800 - instrument.frame)
    assert instrument.dropped_events == 50
    for pitch in (MARK, MARK + 1):
        (frame,) = frames_of(applied, SLIDE, pitch)
        assert frame < DUE + BLOCK


def test_releases_of_all_cost_as_little_as_others_however_much_waits() -> None:
    instrument = live()
    fill_queues(instrument, 12, due=100_000)
    for _ in range(200):
        post_of_page(instrument, 20, 8000, RELEASE_ALL, 0, 1.0)
    post_of_page(instrument, 20, 8000, SLIDE, 0, MARK)
    (last,) = frames_of(play(instrument, 8400 - instrument.frame), SLIDE, MARK)
    assert last < 8000 + BLOCK


def test_a_page_that_fills_its_queue_loses_its_own_events_and_still_ends_what_it_played() -> None:
    instrument = live()
    room = PAGE_QUEUE - RESERVE
    for n in range(room + 50):
        post_of_page(instrument, 3, DUE, WRITE, VOLUME, n / 1000)
    post_of_page(instrument, 3, DUE, LEAVE, 1 << 16, 1 << 12)
    post_of_page(instrument, 3, DUE, LIFT)
    post_of_page(instrument, 4, DUE, SLIDE, 0, MARK)
    applied = play(instrument, DUE + 400)
    assert instrument.dropped_events == 50
    assert len(frames_of(applied, SLIDE, MARK)) == 1
    assert [kind for _, kind, *_ in applied].count(LIFT) == 1


def test_an_event_that_comes_to_many_commands_takes_as_much_of_the_budget() -> None:
    instrument = live()
    for _ in range(16):
        post(instrument, SERVER, DUE, START, 0, 1.0)
    applied = play(instrument, DUE + 1000)
    at_once = [frame for frame, *_ in applied if frame < DUE + BLOCK]
    most = LIVE_BUDGET + BUDGET_PER_FRAME * BLOCK
    assert len(applied) > 3 * len(at_once) // 2
    assert len(at_once) <= most


def test_offline_nothing_is_deferred() -> None:
    instrument = Instrument(InstrumentSpec(RATE))
    instrument.report_commands()
    for n in range(1000):
        post(instrument, SERVER, DUE, WRITE, VOLUME, n / 1000)
    frames = [frame for frame, *_ in play(instrument, DUE + 64)]
    assert len(frames) == 1000
    assert max(frames) < DUE + 16


def test_a_replay_of_what_was_applied_under_a_flood_applies_it_at_the_same_frames() -> None:
    instrument = live()
    chance = np.random.default_rng(4)
    for n in range(2000):
        kind = (BEGIN, END, WRITE, EXPRESS, SLIDE, DRAW)[chance.integers(6)]
        index = VOLUME if kind in (WRITE, EXPRESS) else 5
        numbers = (index, chance.uniform(0, 1) if index == VOLUME else 60.0, 60.0)
        writer = (SERVER, PAGES)[n % 2]
        post(instrument, writer, DUE + int(chance.integers(20)), kind, *numbers)
        if n % 400 == 0:
            play(instrument, BLOCK)
    applied = play(instrument, 6000)
    for is_live, block in ((False, 64), (True, 64), (True, 333)):
        again = Instrument(InstrumentSpec(RATE), is_live=is_live)
        again.report_commands()
        for frame, kind, index, value, other in applied:
            again.post(kind, frame=frame, index=index, value=value, other=other)
        assert play(again, instrument.frame, block) == applied, (is_live, block)


def test_a_release_of_all_cancels_what_waits_in_every_queue() -> None:
    instrument = live()
    post(instrument, SERVER, DUE, NOTE_ON, 1, 60.0, 0.5)
    for page in (0, 63):
        post_of_page(instrument, page, DUE, BEGIN, 2, 61.0, 61.0)
    play(instrument, BLOCK)
    post(instrument, SERVER, DUE - 10, RELEASE_ALL)
    applied = play(instrument, DUE + 100)
    assert not [kind for _, kind, *_ in applied if kind in (-1, BEGIN)]  # nor anything else


def test_a_full_queue_of_midi_waits_in_its_ring() -> None:
    instrument = live()
    soon = 10**8  # ns: some thousand frames
    for _ in range(SMALL_RING):
        post(instrument, MIDI_INPUTS, soon, MESSAGE, packed([0xB0, 7, 100], 0))
    play(instrument, 8 * BLOCK)
    assert instrument.dropped_events == 0


def test_a_page_is_not_late_for_what_costs_much_of_many_others() -> None:
    instrument = live()
    for page in range(30):
        post_of_page(instrument, page, 0, LIFT)
    for n in range(100):
        for page in range(30):
            post_of_page(instrument, page, DUE, START, 0, 1.0)
        if n % 16 == 0:
            play(instrument, BLOCK)
    play(instrument, DUE + 10 - instrument.frame)
    post_of_page(instrument, 40, now := instrument.frame, BEGIN, 1, MARK, MARK)
    (page,) = frames_of(play(instrument, 9000), BEGIN, MARK)
    assert page < now + BLOCK
