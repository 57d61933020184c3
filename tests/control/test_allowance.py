"""What may be done so often, and no more often."""

from __future__ import annotations

from yehu_server.live.osc.limits import TokenBucket


def test_a_burst_is_allowed_and_after_it_what_each_second_brings():
    allowance = TokenBucket(2.0, 5.0)
    assert [allowance.takes(1000.0) for _ in range(7)] == [True] * 5 + [False] * 2
    assert [allowance.takes(1001.0) for _ in range(4)] == [True] * 2 + [False] * 2
    assert [allowance.takes(1e6) for _ in range(7)] == [True] * 5 + [False] * 2


def test_who_spends_more_than_there_is_waits_until_it_is_gained_again():
    allowance = TokenBucket(10.0, 20.0)
    assert allowance.left(0.0) == 20.0
    allowance.spend(30.0)
    assert allowance.left(0.5) == -5.0
    assert allowance.left(1.0) == 0.0
    assert allowance.left(1.5) == 5.0
