"""What pages play on the server: applied, known, and ended as they leave."""

from __future__ import annotations

from types import SimpleNamespace

import mido
import numpy as np
import pytest
from midi_input import receive

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.player.commands import (
    BEGIN,
    DRAW,
    END,
    EXPRESS,
    HOLD,
    LIFT,
    RELEASE,
    STOP,
    WRITE,
)
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.core.player.record import MOST_HELD
from yehu_server.live.page.players import PagePlayers
from yehu_server.params.table import FINGERS
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import player_of
from yehu_server.playing.player import Player

PRESSURE, SPEED, VELOCITY = "/playing/pressure", "/playing/speed", "/playing/velocity"


@pytest.fixture(scope="module")
def instrument():
    options = PlayingOptions()
    instrument = Instrument(options.spec(48000.0, calibration_for(48000.0)))
    instrument.report_commands()
    return instrument


@pytest.fixture
def player(instrument) -> Player:
    instrument.reset()
    instrument.report_commands()
    return player_of(0, PlayingOptions(), [instrument], delay_ms=0.0)


@pytest.fixture
def pages(player) -> PagePlayers:
    """The pages of a server with one part, whose messages arrive now."""

    def post(_rig, frame, kind, index=0, value=0.0, other=0.0) -> bool:
        return player.instrument.post(kind, frame=frame, index=index, value=value, other=other)

    seen = SimpleNamespace(rate=48000.0, frame_of=lambda _ns: player.instrument.frame, post=post)
    return PagePlayers(seen, [0])


def requested(player: Player) -> list[tuple[int, int, float, float]]:
    """The commands applied in the next blocks: kind, index, value, other."""
    out = np.zeros((256, 1), np.float32)
    found = []
    for _ in range(4):
        player.instrument.process(out)
        found += player.instrument.applied_commands().tolist()
    return [tuple(command[1:]) for command in found]


def command(pages: PagePlayers, page: int, *command: float, at: float = -1.0) -> None:
    kind, index, value, other = (*command, 0.0, 0.0, 0.0)[:4]
    pages.post(page, 0, np.array([[at, kind, index, value, other]]), 0)


def test_equal_keys_of_two_pages_are_two_and_one_holds_so_many_at_most(player, pages) -> None:
    for number in (0, 1):
        command(pages, number, BEGIN, -1, 69.0, 69.0)
    assert len(player.held()) == 2
    pages.leave(0, 0)
    assert len(player.held()) == 1
    for number in range(MOST_HELD + 50):
        command(pages, 1, BEGIN, number, 69.0, 69.0)
    assert len(player.held()) == MOST_HELD


def test_values_for_a_note_come_before_it_are_known_and_its_pitch_is_as_the_page_tuned_it(
    player, pages
) -> None:
    requested(player)
    command(pages, 0, EXPRESS, INDEX[VELOCITY], 0.25)
    command(pages, 0, BEGIN, 0, 69.0, 69.3)
    (before, *_), (kind, _, *pitches) = requested(player)
    assert (before, kind, pitches) == (EXPRESS, BEGIN, [69.0, 69.3])
    assert player.value(VELOCITY) == 0.25


def test_keys_that_end_together_do_so_also_here(player, pages) -> None:
    for key in (65.0, 69.0, 72.0):
        command(pages, 0, BEGIN, 0, key, key)
    requested(player)
    fingers = [player.instrument.target(f"/finger/{number}/position") for number in FINGERS]
    command(pages, 0, END, 0, 72.0, 1.0)
    command(pages, 0, END, 0, 69.0, 1.0)
    ended = requested(player)
    assert [player.instrument.target(f"/finger/{n}/position") for n in FINGERS] == fingers
    command(pages, 0, END, 0, 65.0, 0.0)
    assert [(value, other) for _, _, value, other in ended + requested(player)] == [
        (72.0, 1.0), (69.0, 1.0), (65.0, 0.0),
    ]  # fmt: skip
    assert not player.held()
    assert player.instrument.target("/bow/speed") == 0.0


def test_a_page_that_leaves_holds_nothing_and_draws_no_bow(player, pages) -> None:
    command(pages, 0, BEGIN, 0, 69.0, 69.0)
    command(pages, 0, DRAW, 0, 0.2, 0.5)
    requested(player)
    pages.leave(0, 0)
    assert [kind for kind, *_ in requested(player)] == [END, LIFT]
    pages.leave(0, 0)
    assert requested(player) == []


def test_what_it_sets_all_know(player, pages) -> None:
    command(pages, 0, WRITE, INDEX[PRESSURE], 0.25)
    assert player.value(PRESSURE) == 0.25
    command(pages, 0, HOLD, INDEX[PRESSURE], 0.75)
    player.set(PRESSURE, 0.5, frame=player.instrument.frame)
    assert player.value(PRESSURE) == 0.75
    command(pages, 0, RELEASE)
    player.set(PRESSURE, 0.5, frame=player.instrument.frame)
    assert player.value(PRESSURE) == 0.5


def test_what_it_moves_slowly_the_next_note_keeps(player, pages) -> None:
    moved = mido.Message("control_change", control=16, value=10)
    receive(player, moved, frame=player.instrument.frame, port=0)
    requested(player)
    command(pages, 0, WRITE, INDEX[SPEED], 0.25, 40.0)
    assert requested(player) == [(WRITE, INDEX[SPEED], 0.25, 40.0)]
    note = mido.Message("note_on", note=69)
    receive(player, note, frame=player.instrument.frame, port=0)
    assert player.value(SPEED) == 0.25


def test_a_panic_ends_what_others_hold(player, pages) -> None:
    player.key_on(69.0, 90.0, frame=player.instrument.frame)
    command(pages, 0, STOP, 0, 0.0)
    assert player.held()
    command(pages, 0, STOP, 0, 1.0)
    assert not player.held()


def test_a_note_asked_for_ahead_ends_though_the_page_has_left(player, pages) -> None:
    command(pages, 0, BEGIN, 0, 69.0, 69.0, at=player.instrument.frame + 300)
    pages.leave(0, 0)
    assert [kind for kind, *_ in requested(player)] == [BEGIN, END]
    assert not player.held()


def test_frames_lie_at_most_some_seconds_ahead(player, pages) -> None:
    command(pages, 0, WRITE, INDEX[PRESSURE], 0.25, at=1e12)
    command(pages, 0, WRITE, INDEX[PRESSURE], 0.5)
    requested(player)
    assert player.value(PRESSURE) == 0.5
    out = np.zeros((48000, 1), np.float32)
    for _ in range(4):
        player.instrument.process(out)
    assert player.value(PRESSURE) == 0.25
