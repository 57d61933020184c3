"""Point forces on the grid: interpolation, spreading, and the bounds of contact places."""

import numpy as np
import pytest
from core.physics.runs import bump, frequency_near, play, shaped
from hypothesis import given
from hypothesis import strategies as st
from pitch import cents

from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.grid import (
    cubic_weights,
    interpolate,
    linear_weights,
    overlap,
    spread,
)

YEHU = Quantities()
GRIDS = st.integers(min_value=12, max_value=layout.MAX_INTERVALS)


def on_grid(values):
    """The values of N + 1 nodes in the kernel's layout."""
    u = np.zeros(layout.POINTS)
    u[layout.GHOST : layout.GHOST + len(values)] = values
    return u


@st.composite
def contacts(draw):
    """A grid and a place on it, from one node to one node before the end."""
    N = draw(GRIDS)
    return N, draw(st.floats(min_value=1.0, max_value=N - 1.0))


def placed(place, position, N):
    weights = np.zeros(layout.STENCIL)
    return place(position, N, weights), weights


@given(contacts(), st.tuples(*[st.floats(-1.0, 1.0)] * 4))
def test_cubic_weights_read_every_cubic_exactly_that_is_zero_at_the_ends_or_they_are_far(
    contact, factors
):
    """Two polynomials span the former: x (N - x) and x (N - x) (x - N/2)."""
    N, position = contact
    tied = np.polynomial.Polynomial([0.0, 1.0, -1.0]) * np.polynomial.Polynomial(factors[:2])
    any_cubic = np.polynomial.Polynomial(factors)
    inside = min(max(position, 2.0), N - 2.0)
    for cubic, at in ((tied, position), (any_cubic, inside)):
        first, weights = placed(cubic_weights, at, N)
        value = interpolate(on_grid(cubic(np.arange(N + 1.0) / N)), first, weights)
        assert value == pytest.approx(cubic(at / N), abs=1e-13)


@given(contacts(), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_linear_weights_read_every_line_exactly(contact, offset, slope):
    N, position = contact
    position = min(position, N - 1.5)
    first, weights = placed(linear_weights, position, N)
    value = interpolate(on_grid(offset + slope * np.arange(N + 1.0) / N), first, weights)
    assert value == pytest.approx(offset + slope * position / N, abs=1e-14)
    # ... and no more than two nodes, or a bow would not be a point between its neighbours.
    assert np.count_nonzero(weights) <= 2


@given(contacts(), st.sampled_from([cubic_weights, linear_weights]), st.integers(0, 2**32 - 1))
def test_spreading_is_the_transpose_of_reading_and_never_moves_the_fixed_ends(contact, place, seed):
    """<u, J f> = (I u) f: a force works on exactly the motion that it reads."""
    N, position = contact
    first, weights = placed(place, position, N)
    u = on_grid(np.random.default_rng(seed).normal(size=N + 1))
    pushed = np.zeros(layout.POINTS)
    spread(pushed, first, weights, 0.7)
    assert u @ pushed == pytest.approx(0.7 * interpolate(u, first, weights), abs=1e-13)
    assert pushed[: layout.GHOST + 1].tolist() == [0.0, 0.0]
    assert not pushed[layout.GHOST + N :].any()


@given(contacts(), st.floats(0.0, 1.0), st.sampled_from([cubic_weights, linear_weights]))
def test_overlap_is_what_one_contact_reads_of_the_other(contact, fraction, place):
    N, position = contact
    other = min(max(position + 8.0 * (fraction - 0.5), 1.0), N - 1.0)
    first_p, weights_p = placed(cubic_weights, position, N)
    first_q, weights_q = placed(place, other, N)
    pushed = np.zeros(layout.POINTS)
    spread(pushed, first_q, weights_q, 1.0)
    there = overlap(first_p, weights_p, first_q, weights_q)
    assert there == pytest.approx(interpolate(pushed, first_p, weights_p), abs=1e-14)
    assert there == pytest.approx(overlap(first_q, weights_q, first_p, weights_p), abs=1e-14)


def contact_place(state, p):
    """Where a contact is on its string, in nodes: the centre of its weights."""
    c = state[0]["contacts"]
    weights = c["weights"][p]
    return float(c["first"][p] + weights @ np.arange(layout.STENCIL))


@given(st.floats(0.0, 0.38), st.sampled_from([0.7, -0.7]))
def test_the_bow_keeps_one_node_from_the_bridge_and_from_the_loop(x_b, F_N):
    run = play({"F_N": F_N, "x_b": x_b}, 2.0 / 44100.0, ledger=False)
    h = float(run.model["h"][0, 0 if F_N > 0.0 else 1])
    expected = min(max(x_b / h, 1.0), YEHU.bridge_x / h - 1.0)
    assert contact_place(run.state, layout.BOW) == pytest.approx(expected, abs=1e-12)


@given(st.floats(0.0, 0.38))
def test_a_finger_keeps_one_node_from_the_loop_and_stays_before_the_bridge(x_f):
    """Seen by what it reads of a curve: next to the loop the fixed node has no weight."""
    run = play({"x_f": [x_f]}, 2.0 / 44100.0, ledger=False)
    for i in range(layout.STRINGS):
        h, N = float(run.model["h"][0, i]), int(run.model["N"][0, i])
        expected = max(min(x_f, YEHU.bridge_x) / h, 1.0)
        nodes = np.arange(N + 1.0)
        curve = on_grid(nodes * (N - nodes) * (nodes + 3.0))
        c = run.state["contacts"]
        found = interpolate(curve, int(c["first"][0, i]), c["weights"][0, i])
        assert found == pytest.approx(expected * (N - expected) * (expected + 3.0), rel=1e-9)


@pytest.mark.parametrize("string", [0, 1], ids=["F4", "C5"])
def test_a_bridge_moved_by_some_tenths_of_a_millimetre_moves_the_pitch_a_little(string):
    """Over more than a grid interval, no step and no turn: x_c is not rounded to a node."""
    rate, guess = 44100.0, (346.0, 517.0)[string]
    bridge_x = 0.295 + 4e-4 * np.arange(19)
    found = []
    for x_c in bridge_x:
        instrument = override(YEHU, {"bridge_x": float(x_c)})
        model = kernel.prepare(instrument, rate)
        state = shaped(model, string, bump(0.02, 0.26, 3e-4))
        run = play({}, 0.25, rate, quantities=instrument, state=state, ledger=False)
        pull = run.probes[2000:, (layout.BRIDGE_FORCE_1, layout.BRIDGE_FORCE_2)[string]]
        found.append(frequency_near(pull, rate, guess))
    # c/2x: 0.4 mm of 0.3 m is 2.3 cents. Rounding to a node would give 0, and then 40.
    flattening = -np.diff(cents(found, found[0]))
    assert flattening.min() > 1.2
    assert flattening.max() < 3.4
    assert np.ptp(cents(found, bridge_x[0] / bridge_x)) < 8.0
