"""The delay-locked loop by itself: how it answers a step, a wrong rate, and jitter."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from yehu_server.core.engine.delay_locked_loop import (
    BANDWIDTH_HZ,
    LOOP,
    follow,
    predicted_ns,
    start,
)

RATE, FRAMES = 48000.0, 256
PERIOD_NS = FRAMES * 1e9 / RATE
WHOLE_NS = 200  # what whole nanoseconds add up to in a loop this slow
TURN = 2.0 * math.pi * BANDWIDTH_HZ * FRAMES / RATE  # of the loop's natural frequency, a period


@pytest.fixture
def loop() -> np.void:
    loop = np.zeros(1, LOOP)[0]
    start(loop, 10**12, RATE)
    return loop


def heard(loop: np.void, times_ns: np.ndarray) -> Iterator[tuple[int, float]]:
    """Let it follow events; how late (ns) each was by its prediction, and is the time it has."""
    for time_ns in np.rint(times_ns).astype(int):
        due_ns = predicted_ns(loop, FRAMES)
        follow(loop, due_ns, int(time_ns) - due_ns, FRAMES, RATE)
        yield loop["error_ns"], loop["due_ns"] - time_ns


def events(count: int, period_ns: float = PERIOD_NS) -> np.ndarray:
    return 10**12 + period_ns * np.arange(1, count + 1)


def test_a_step_dies_away_as_in_a_loop_of_second_order_with_a_damping_of_one_over_root_two(loop):
    step_ns = 1e6
    left = np.array([late for late, _ in heard(loop, events(600) + step_ns)]) / step_ns
    x = TURN * np.arange(600) / math.sqrt(2.0)
    expected = np.exp(-x) * (np.cos(x) - np.sin(x))
    np.testing.assert_allclose(left, expected, atol=0.02)


@pytest.mark.parametrize("drift", [0.9995, 1.0005])
def test_a_rate_that_is_off_leaves_no_error_behind(loop, drift):
    errors = [late for late, _ in heard(loop, events(3000, PERIOD_NS * drift))]
    assert np.abs(errors[:200]).max() > 1e4
    assert np.abs(errors[-200:]).max() < WHOLE_NS
    assert loop["ns_per_frame"] == pytest.approx(drift * 1e9 / RATE, rel=1e-6)


def test_of_jitter_it_passes_on_what_lies_within_its_noise_bandwidth(loop):
    jitter_ns = np.random.default_rng(1).normal(0.0, 1e5, 20_000)
    times = events(len(jitter_ns))
    off = np.array([off for _, off in heard(loop, times + jitter_ns)]) + jitter_ns
    # 2 B_n T of a loop of second order, B_n = omega_n (zeta + 1 / 4 zeta) / 2.
    passed = TURN * (math.sqrt(0.5) + 0.25 * math.sqrt(2.0))
    assert np.std(off[2000:]) == pytest.approx(1e5 * math.sqrt(passed), rel=0.15)
