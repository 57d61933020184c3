"""What is left to chance in a data set, and how a description says it."""

import math

import numpy as np
import pytest

from yehu_lab.dataset.draws import chance, read_distribution
from yehu_server.errors import ParameterError
from yehu_server.util.documents import Fields

MANY = 4000


def drawn(entry) -> np.ndarray:
    draw = read_distribution(entry)
    return np.array([draw.value(chance(1, number, "x")) for number in range(MANY)])


def test_chance_is_even_and_the_same_each_time():
    shares = np.array([chance(7, number, "a") for number in range(MANY)])
    counts, _ = np.histogram(shares, 10, (0.0, 1.0))
    assert abs(counts - MANY / 10).max() < 5.0 * math.sqrt(MANY / 10)
    assert shares.tolist() == [chance(7, number, "a") for number in range(MANY)]
    assert 0.0 <= shares.min() < shares.max() < 1.0


def test_chance_of_one_name_tells_nothing_of_another_seed_number_or_name():
    ones = np.array([chance(1, number, "a") for number in range(MANY)])
    for others in (
        [chance(2, number, "a") for number in range(MANY)],
        [chance(1, number, "b") for number in range(MANY)],
        [chance(1, number + 1, "a") for number in range(MANY)],
    ):
        assert abs(np.corrcoef(ones, others)[0, 1]) < 5.0 / math.sqrt(MANY)


def test_whole_draws_are_as_often_each_number_from_one_end_to_the_other():
    values, counts = np.unique(drawn({"from": 1, "to": 3, "spacing": "whole"}), return_counts=True)
    assert values.tolist() == [1.0, 2.0, 3.0]
    assert counts / MANY == pytest.approx(1 / 3, abs=0.03)


def test_choices_have_their_weights():
    values, counts = np.unique(
        drawn({"choose": [1, 5, 9], "weights": [1, 0, 3]}), return_counts=True
    )
    assert values.tolist() == [1.0, 9.0]
    assert counts[1] / MANY == pytest.approx(0.75, abs=0.03)


def test_normal_draws_stay_within_their_ends():
    values = drawn({"mean": 0.0, "deviation": 1.0, "from": -1.0, "to": 1.0})
    assert abs(values).max() <= 1.0
    assert values.mean() == pytest.approx(0.0, abs=0.04)
    # of a normal distribution cut off at one deviation to both sides
    assert values.std() == pytest.approx(0.5396, abs=0.02)


def test_what_is_no_draw_is_refused_by_its_name(subtests):
    ends, normal, chosen = {"from": 1, "to": 2}, {"mean": 0, "deviation": 1}, {"choose": [1, 2]}
    for entry in (
        *("1", True, math.nan, 10**400, [], {}),
        *({"from": 1}, {"from": 2, "to": 1}, ends | {"spacing": "log"}),
        *(ends | {"from": 0, "spacing": "ratio"}, ends | {"from": 0.5, "spacing": "whole"}),
        *({"choose": []}, {"choose": [1, "2"]}),
        *(chosen | {"weights": weights} for weights in ([1], [0, 0], [-1, 2])),
        *(normal, normal | {"deviation": 0, "from": -1, "to": 1}),
        normal | {"from": 100, "to": 101},
    ):
        with subtests.test(entry=entry), pytest.raises(ParameterError, match=r"^here"):
            Fields({"here": entry}).read("here", read_distribution, None)
