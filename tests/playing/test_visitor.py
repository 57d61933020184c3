"""The wishes of another program's player: fulfilled, known, and ended as it leaves."""

from __future__ import annotations

import math

import mido
import numpy as np
import pytest

from yehu_server.errors import ParameterError
from yehu_server.params.table import FINGERS, TABLE
from yehu_server.player.record import MOST_HELD
from yehu_server.player.rows import ROW
from yehu_server.player.wishes import (
    BEGIN,
    DRAW,
    END,
    EXPRESS,
    HOLD,
    LIFT,
    RAMP,
    RELEASE,
    SLIDE,
    STOP,
    WRITE,
)
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.live import LivePlayer
from yehu_server.playing.style import Style
from yehu_server.playing.visitor import CHANNELS, LOWEST, Wish

PRESSURE, SPEED, VELOCITY = "/playing/pressure", "/playing/speed", "/playing/velocity"


@pytest.fixture(scope="module")
def instrument():
    style = Style()
    instrument = style.instrument(48000.0, calibration_for(48000.0))
    instrument.report_wishes()
    return instrument


@pytest.fixture
def player(instrument) -> LivePlayer:
    instrument.reset()
    instrument.report_wishes()
    return LivePlayer(instrument, Style(), delay_ms=0.0)


def wished(player: LivePlayer) -> list[tuple[int, int, float, float]]:
    """The wishes fulfilled in the next blocks: kind, index, value, other."""
    out = np.zeros((256, 1), np.float32)
    found = []
    for _ in range(4):
        player.instrument.process(out)
        found += player.instrument.applied_wishes().tolist()
    return [tuple(wish[1:]) for wish in found]


def fulfil(player: LivePlayer, number: int, *wish: float) -> None:
    kind, index, value, other = (*wish, 0.0, 0.0, 0.0)[:4]
    player.fulfil(number, Wish(int(kind), int(index), value, other), frame=player.instrument.frame)


def test_equal_keys_of_two_visitors_are_two(player) -> None:
    for number in (0, 1):
        fulfil(player, number, BEGIN, -1, 69.0, 69.0)
    assert len(player._wishes.held()) == 2
    player.dismiss(0, frame=player.instrument.frame)
    assert len(player._wishes.held()) == 1


def test_a_pitch_is_as_the_visitor_tuned_it(player) -> None:
    wished(player)
    fulfil(player, 0, BEGIN, 0, 69.0, 69.3)
    begun = [wish for wish in wished(player) if wish[0] == BEGIN]
    assert [(value, other) for _, _, value, other in begun] == [(69.0, 69.3)]


def test_values_for_a_note_come_before_it_and_are_known(player) -> None:
    wished(player)
    fulfil(player, 0, EXPRESS, ROW[VELOCITY], 0.25)
    fulfil(player, 0, BEGIN, 0, 69.0, 69.0)
    assert [kind for kind, *_ in wished(player)] == [EXPRESS, BEGIN]
    assert player.value(VELOCITY) == 0.25


def test_keys_that_end_together_do_so_also_here(player) -> None:
    for key in (65.0, 69.0, 72.0):
        fulfil(player, 0, BEGIN, 0, key, key)
    wished(player)
    fingers = [player.instrument.target(f"/finger/{number}/position") for number in FINGERS]
    fulfil(player, 0, END, 0, 72.0, 1.0)
    fulfil(player, 0, END, 0, 69.0, 1.0)
    ended = wished(player)
    assert [player.instrument.target(f"/finger/{n}/position") for n in FINGERS] == fingers
    fulfil(player, 0, END, 0, 65.0, 0.0)
    assert [(value, other) for _, _, value, other in ended + wished(player)] == [
        (72.0, 1.0), (69.0, 1.0), (65.0, 0.0),
    ]  # fmt: skip
    assert not player._wishes.held()
    assert player.instrument.target("/bow/speed") == 0.0


def test_a_visitor_that_leaves_holds_nothing_and_draws_no_bow(player) -> None:
    fulfil(player, 0, BEGIN, 0, 69.0, 69.0)
    fulfil(player, 0, DRAW, 0, 0.2, 0.5)
    wished(player)
    player.dismiss(0, frame=player.instrument.frame)
    assert [kind for kind, *_ in wished(player)] == [END, LIFT]
    player.dismiss(0, frame=player.instrument.frame)
    assert wished(player) == []


def test_what_it_sets_all_know(player) -> None:
    fulfil(player, 0, WRITE, ROW[PRESSURE], 0.25)
    assert player.value(PRESSURE) == 0.25
    fulfil(player, 0, HOLD, ROW[PRESSURE], 0.75)
    player.write(PRESSURE, 0.5, frame=player.instrument.frame)
    assert player.value(PRESSURE) == 0.75
    fulfil(player, 0, RELEASE)
    player.write(PRESSURE, 0.5, frame=player.instrument.frame)
    assert player.value(PRESSURE) == 0.5


def test_what_it_moves_slowly_the_next_note_keeps(player) -> None:
    moved = mido.Message("control_change", control=1, value=10)
    player.receive(moved, frame=player.instrument.frame, port=0)
    wished(player)
    fulfil(player, 0, WRITE, ROW[SPEED], 0.25, 40.0)
    assert wished(player) == [(WRITE, ROW[SPEED], 0.25, 40.0)]
    note = mido.Message("note_on", note=69)
    player.receive(note, frame=player.instrument.frame, port=0)
    assert player.value(SPEED) == 0.25


def test_a_panic_ends_what_others_hold(player) -> None:
    player.note_on(69.0, 90.0, frame=player.instrument.frame)
    fulfil(player, 0, STOP, 0, 0.0)
    assert player._wishes.held()
    fulfil(player, 0, STOP, 0, 1.0)
    assert not player._wishes.held()


def test_a_visitor_holds_so_many_keys_at_most(player) -> None:
    for number in range(MOST_HELD + 50):
        fulfil(player, 0, BEGIN, number, 69.0, 69.0)
    assert len(player._wishes.held()) == MOST_HELD


@pytest.mark.parametrize(
    "wish",
    [
        (RAMP, 0, 1.0, 0.0),
        (-1, 0, 1.0, 0.0),
        (11, 0, 1.0, 0.0),
        (WRITE, len(TABLE), 1.0, 0.0),
        (EXPRESS, -1, 1.0, 0.0),
        (BEGIN, LOWEST - 1, 69.0, 69.0),
        (BEGIN, LOWEST + CHANNELS, 69.0, 69.0),
        (SLIDE, 0, math.nan, 0.0),
        (DRAW, 0, 0.0, math.inf),
    ],
)
def test_what_nobody_can_wish_is_refused(wish) -> None:
    with pytest.raises(ParameterError):
        Wish(*wish)
