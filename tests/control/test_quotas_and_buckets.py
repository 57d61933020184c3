"""Limits: what may be done so often, and how much memory peers may hold."""

from __future__ import annotations

from wire import FakePeer

from yehu_server.live.osc.memory_quota import MemoryQuota
from yehu_server.util.token_bucket import TokenBucket


def test_a_burst_is_allowed_and_after_it_what_each_second_brings():
    bucket = TokenBucket(2.0, 5.0)
    assert [bucket.takes(1000.0) for _ in range(7)] == [True] * 5 + [False] * 2
    assert [bucket.takes(1001.0) for _ in range(4)] == [True] * 2 + [False] * 2
    assert [bucket.takes(1e6) for _ in range(7)] == [True] * 5 + [False] * 2


def test_who_spends_more_than_there_is_waits_until_it_is_gained_again():
    bucket = TokenBucket(10.0, 20.0)
    assert bucket.left(0.0) == 20.0
    bucket.spend(30.0)
    assert bucket.left(0.5) == -5.0
    assert bucket.left(1.0) == 0.0
    assert bucket.left(1.5) == 5.0


def test_there_is_always_room_for_a_peer_that_is_limited_otherwise():
    quota = MemoryQuota(1000)
    assert quota.take(FakePeer(1), 400)
    assert not quota.take(FakePeer(2), 700)
    assert quota.take(FakePeer(2), 700, always=True)
    assert quota.taken_bytes == 1100
