"""What pages play on the server: applied, known, and ended as they leave."""

from types import SimpleNamespace

import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.player.commands import BEGIN, DRAW, END, EXPRESS, LIFT, WRITE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.core.player.record import MAX_HELD
from yehu_server.live.page.players import PagePlayers
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

    def post(_rig, _page, frame, kind, index=0, value=0.0, other=0.0) -> int:
        player.instrument.post(kind, frame=frame, index=index, value=value, other=other)
        return player.instrument.posted

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
    for number in range(MAX_HELD + 50):
        command(pages, 1, BEGIN, number, 69.0, 69.0)
    assert len(player.held()) == MAX_HELD


def test_values_for_a_note_come_before_it_are_known_and_its_pitch_is_as_the_page_tuned_it(
    player, pages
) -> None:
    requested(player)
    command(pages, 0, EXPRESS, INDEX[VELOCITY], 0.25)
    command(pages, 0, BEGIN, 0, 69.0, 69.3)
    (before, *_), (kind, _, *pitches) = requested(player)
    assert (before, kind, pitches) == (EXPRESS, BEGIN, [69.0, 69.3])
    assert player.value(VELOCITY) == 0.25


def test_a_page_that_leaves_holds_nothing_and_draws_no_bow(player, pages) -> None:
    command(pages, 0, BEGIN, 0, 69.0, 69.0)
    command(pages, 0, DRAW, 0, 0.2, 0.5)
    requested(player)
    pages.leave(0, 0)
    assert [kind for kind, *_ in requested(player)] == [END, LIFT]
    pages.leave(0, 0)
    assert requested(player) == []


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
