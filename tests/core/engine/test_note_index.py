"""Note-ons that wait are found by key, in a time that doesn't grow with what waits."""

import random
from collections import Counter

import numpy as np
import pytest
import sound
from core.engine.test_event_queues import BLOCK, MARK, frames_of, live, play, post, post_of_page

from yehu_server.core.engine.mailbox import HEAP, SENDER_QUEUE, SERVER
from yehu_server.core.engine.note_index import (
    NOTES,
    add_note,
    end_notes,
    find_slot,
    home,
    take_note,
)
from yehu_server.core.player.commands import BEGIN, END, SLIDE

SECRET = 0x1D872B41A5F03C69


def index(events: int) -> np.ndarray:
    return np.zeros(2 * events, NOTES)


def distances(notes: np.ndarray, secret: int, keys: list[tuple[int, float]]) -> np.ndarray:
    """How many slots are looked at for each key."""
    found = [find_slot(notes, secret, *key) - home(notes, secret, *key) for key in keys]
    return np.array(found) % len(notes) + 1


@pytest.mark.parametrize("events", [256, SENDER_QUEUE, HEAP])
def test_so_many_slots_are_looked_at_however_much_waits(events: int) -> None:
    notes, keys = index(events), [(n % 7, n * 0.125) for n in range(events)]
    for key in keys:
        add_note(notes, SECRET, *key)
    others = [(9, key) for _, key in keys]
    there, not_there = distances(notes, SECRET, keys), distances(notes, SECRET, others)
    assert there.mean() < 1.7  # Knuth: 1.5 at half full
    assert not_there.mean() < 3.0  # 2.5
    assert max(there.max(), not_there.max()) < 12 * np.log2(events)


def test_keys_that_meet_under_one_secret_do_not_under_another() -> None:
    notes = index(SENDER_QUEUE)
    met = [(0, key) for key in np.arange(100_000.0) if home(notes, 1, 0, key) == 5]
    assert len(met) > 12
    for secret, most in ((1, 12), (SECRET, 6)):
        notes = index(SENDER_QUEUE)
        for key in met:
            add_note(notes, secret, *key)
        assert (distances(notes, secret, met).max() > most) == (secret == 1)


def test_the_index_finds_what_a_scan_finds() -> None:
    chance = random.Random(3)
    notes, waiting = index(64), []
    for order in range(1, 4000):
        key = (chance.randrange(3), chance.choice((0.0, -0.0, 1.5, 60.0 + chance.randrange(40))))
        act = chance.random()
        if act < 0.2:
            end_notes(notes, 7, order, *key)
            waiting = [(o, k, c or k == key) for o, k, c in waiting]
        elif act < 0.6 and len(waiting) < 64:
            add_note(notes, 7, *key)
            waiting.append((order, key, False))
        elif waiting:
            its, its_key, is_cancelled = waiting.pop(chance.randrange(len(waiting)))
            assert take_note(notes, 7, its, *its_key) == is_cancelled
        held = Counter(k for _, k, _ in waiting)
        assert notes["waiting"].sum() == sum(held.values())
        assert (notes["waiting"] > 0).sum() == len(held)


def test_ends_of_keys_not_held_cost_as_little_as_others_however_much_waits() -> None:
    instrument, due, now = live(), 100_000, 8000
    for n in range(HEAP - 400):
        post(instrument, SERVER, due, BEGIN, 7, float(n), 60.0)
        if n % 1000 == 0:
            play(instrument, BLOCK)
    for n in range(60):
        post(instrument, SERVER, now, END, 8, float(n))
    post(instrument, SERVER, now, SLIDE, 0, MARK)
    (last,) = frames_of(play(instrument, now + 400 - instrument.frame), SLIDE, MARK)
    assert last < now + BLOCK


def test_a_note_that_was_ended_before_it_began_is_not_played_after_a_process_died() -> None:
    instrument, due = live(), 1000
    post_of_page(instrument, 3, due, BEGIN, 1, MARK, MARK)
    post_of_page(instrument, 3, due, BEGIN, 1, MARK + 1, MARK + 1)
    post_of_page(instrument, 3, due, BEGIN, 1, MARK + 2, MARK + 2)
    post_of_page(instrument, 3, 10, END, 1, MARK)
    sound.run(instrument, BLOCK, block=BLOCK)
    instrument.repair()
    post_of_page(instrument, 3, 20, END, 1, MARK + 1)
    applied = play(instrument, due + BLOCK)
    assert [value for _, kind, _, value, _ in applied if kind == BEGIN] == [MARK + 2]
    assert not instrument._rig["notes"]["waiting"].any()


def test_keys_that_are_no_numbers_leave_nothing_behind() -> None:
    instrument = live()
    for key in (np.nan, np.inf, -0.0):
        for kind in (BEGIN, END):
            post(instrument, SERVER, 100, kind, 1, key, key)
    play(instrument, 400)
    assert not instrument._rig["notes"]["waiting"].any()
