"""The pictures show the motion that the string has, and name it as the ear hears it."""

import json
import math
from itertools import pairwise
from typing import Any

import pytest


@pytest.fixture(scope="module")
def answers(run_node, page) -> Any:
    return json.loads(run_node("page_pictures.mjs", page))


def test_the_slowed_corner_runs_around_once_at_one_speed(answers) -> None:
    """Also where the reported period is wrong by a third of a cent: 0.4 periods in 5 s."""
    for period in ("exact", "drifting"):
        steps = [(after - before + 0.5) % 1.0 - 0.5 for before, after in pairwise(answers[period])]
        assert math.fsum(steps) == pytest.approx(63 / 64, abs=0.06)
        assert max(abs(step - 1 / 64) for step in steps) < 0.06


def test_a_string_is_shown_from_where_it_rests(answers) -> None:
    """A finger displaces it by 12 times as much as it swings."""
    assert answers["rest"] < 0.1 * 0.25  # a tenth of the greatest swing


def test_each_regime_is_named(answers) -> None:
    assert answers["regimes"] == {name: name for name in answers["regimes"]}


def test_the_pitch_that_sounds_is_the_one_heard_if_any_is(answers) -> None:
    assert answers["pitch"] == pytest.approx(69.12)
    assert answers["unheard"] == 69.0


def test_the_limits_are_known_at_every_place_of_the_bow(answers) -> None:
    """The greatest force falls with the distance from the bridge, the least with its square."""
    *places, tip = answers["limits"]
    for beta, limits in zip([0.05, 0.1, 0.4], places, strict=True):
        expected = {"least": 0.0008 / beta**2, "most": 0.2 / beta}
        assert limits == pytest.approx(expected, rel=0.01)
    assert tip == pytest.approx(0.0008 / 0.2, rel=0.01)
