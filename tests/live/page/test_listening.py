"""What a page hears of a server, whose clock is not its own."""

import json
from typing import Any

import pytest

AIM = 512  # frames


@pytest.fixture(scope="module")
def heard(run_node, page, everything) -> dict[str, Any]:
    buffer, seconds = page / "sound" / "jitter_buffer.js", 600 if everything else 30
    return json.loads(run_node("jitter_buffer.test.mjs", buffer, seconds))


def test_another_clock_is_followed_without_a_gap(heard) -> None:
    for clock, ppm in ("fast", 200.0), ("slow", -200.0):
        found = heard[clock]
        assert found["gaps"] == 0
        assert found["aim"] == AIM
        assert found["most"] < 2 * AIM
        assert found["frequency"] == pytest.approx(1000.0 * (1.0 + ppm * 1e-6), abs=0.05)


def test_where_sound_comes_late_more_of_it_waits_until_there_are_few_gaps(heard) -> None:
    assert AIM < heard["late"]["aim"] < 8192
    assert heard["late"]["gaps"] < 10
