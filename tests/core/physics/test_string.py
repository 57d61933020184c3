"""A string alone: no bridge, no bow, no finger; simply supported at both ends."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from pitch import cents

from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics import string as string_module
from yehu_server.core.physics.default_quantities import Quantities, StringQuantities
from yehu_server.core.physics.grid import intervals, least_spacing
from yehu_server.core.physics.kernel import derive
from yehu_server.core.physics.string import advance_nodes, prepare_strings, support

PARTIALS = 10
RATES = (44100.0, 48000.0, 96000.0)
YEHU = Quantities(felt_loss=0.0)

both_strings = pytest.mark.parametrize("i", [0, 1], ids=["F4", "C5"])
three_rates = pytest.mark.parametrize("rate", RATES)


def prepared(string: StringQuantities, rate: float, N: int | None = None):
    """The record of an instrument whose both strings are `string`, on N intervals."""
    model = np.zeros(1, layout.MODEL)
    model["k"] = 1.0 / rate
    with pytest.MonkeyPatch.context() as patch:
        if N is not None:
            patch.setattr(string_module, "intervals", lambda *_: N)
        prepare_strings(model[0], replace(YEHU, string_1=string, string_2=string))
    derive.call(model.ctypes.data)
    return model[0]


def advanced(model, shape, steps):
    """The string let go from `shape` (inner nodes): its inner nodes, one row a step."""
    N = int(model["N"][0])
    u = np.zeros((layout.LEVELS, layout.STRINGS, layout.POINTS))
    u[:, :, layout.GHOST + 1 : layout.GHOST + N] = shape
    support(u[0, 0], N)
    u[:] = u[0, 0]
    bend = np.zeros((layout.STRINGS, layout.POINTS))
    bend[:, 1:-1] = np.diff(u[0], 2) * model["inside"][:, 1:-1]
    kept = np.zeros((steps, N - 1))
    for n in range(steps):
        now, following, before = n % 3, (n + 1) % 3, (n + 2) % 3
        kept[n] = u[now, 0, layout.GHOST + 1 : layout.GHOST + N]
        rows = u[following], u[now], u[before], bend, model["inside"], model["held"]
        advance_nodes(*rows, N, model["B"], model["C"])
        for row in u[following]:
            support(row, N)
    return kept


@cache
def measured(string: StringQuantities, rate: float):
    """Frequency (Hz) and decay (1/s) of the first ten partials, as simulated.

    On this grid sin(p pi x/L) is a mode, so each partial's amplitude is a pure decaying
    oscillation, y[n+1] = a y[n] - b y[n-1]: two numbers, fitted by least squares.
    """
    model = prepared(string, rate)

    N = int(model["N"][0])
    modes = np.sin(np.pi * np.outer(np.arange(1, PARTIALS + 1), np.arange(1, N)) / N)
    start = 1e-3 * (modes / np.arange(1, PARTIALS + 1)[:, np.newaxis]).sum(axis=0)
    amplitude = advanced(model, start, 4000) @ modes.T
    poles = []
    for y in amplitude.T:
        (a, minus_b), *_ = np.linalg.lstsq(np.stack([y[1:-1], y[:-2]], axis=1), y[2:])
        poles.append(np.roots([1.0, -a, -minus_b])[0])
    poles = np.array(poles)
    return np.abs(np.angle(poles)) * rate / (2.0 * np.pi), -np.log(np.abs(poles)) * rate


def line_density(string):
    return string.rho * math.pi * string.r**2


def bending_stiffness(string):
    return string.E * math.pi * string.r**4 / 4.0


def grid_bound(string: StringQuantities, k: float, headroom: float = 1.0) -> int:
    """N of [Yehu] eq. (57), corrected, written as the root of its own quadratic.

    The highest grid mode just holds where h^4 - (c^2 k^2 + 4 sigma_1 k) h^2 = 4 kappa^2 k^2.
    """
    c2 = headroom * string.T / line_density(string)
    kappa2 = bending_stiffness(string) / line_density(string)
    h2 = max(np.roots([1.0, -(c2 * k**2 + 4.0 * string.sigma_1 * k), -4.0 * kappa2 * k**2]).real)
    return int(string.L / math.sqrt(h2))


def continuous(string: StringQuantities, rate: float, highest: int):
    """Closed form of eq. (2) for the lowest partials, and the grid's leading error terms.

    Taylor's next terms: D2 measures the curvature too low by (beta h)^2/12, delta_tt bends
    frequencies up by (omega k)^2/24, and delta_t- = delta_t. - (k/2) delta_tt makes the
    sigma_1 term take away mass, k sigma_1 beta^2 of it.
    """
    p = np.arange(1, highest + 1)
    beta = p * math.pi / string.L
    h, k = string.L / grid_bound(string, 1.0 / rate, YEHU.tension_headroom), 1.0 / rate
    c2 = string.T / line_density(string)
    kappa2 = bending_stiffness(string) / line_density(string)
    sigma = string.sigma_0 + string.sigma_1 * beta**2
    omega = np.sqrt(c2 * beta**2 + kappa2 * beta**4 - sigma**2)
    bent = -(c2 * beta**4 * h**2 / 24.0 + kappa2 * beta**6 * h**2 / 12.0) / omega**2
    bent += (omega * k) ** 2 / 24.0 + k * string.sigma_1 * beta**2 / 2.0
    frequency = omega / (2.0 * math.pi) * (1.0 + bent)
    return frequency, sigma - string.sigma_1 * beta**4 * h**2 / 12.0


@both_strings
def test_three_partials_at_96_khz_are_those_of_a_continuous_stiff_string(i):
    """Within 0.7 cents, all of it the grid's own: its leading terms leave 0.002 cents."""
    string = YEHU.strings[i]
    frequency, decay = measured(string, 96e3)
    beta = np.arange(1, 4) * math.pi / string.L
    sigma = string.sigma_0 + string.sigma_1 * beta**2
    stiffness = string.T * beta**2 + bending_stiffness(string) * beta**4
    ideal = np.sqrt(stiffness / line_density(string) - sigma**2) / (2.0 * math.pi)
    assert np.abs(cents(frequency[:3], ideal)).max() < 0.7
    expected, expected_decay = continuous(string, 96e3, highest=PARTIALS)
    assert np.abs(cents(frequency[:3], expected[:3])).max() < 0.002
    assert decay[:3] == pytest.approx(expected_decay[:3], rel=1e-4)
    assert decay == pytest.approx(expected_decay, rel=2e-3)


DAMPED = replace(YEHU.string_1, sigma_1=0.05)  # here the printed (57) would be too fine


@pytest.mark.parametrize("rate", [22050.0, 44100.0, 48000.0, 96000.0, 192000.0])
@pytest.mark.parametrize("string", [*YEHU.strings, DAMPED], ids=["F4", "C5", "damped"])
def test_the_finest_grid_is_stable_and_one_interval_more_is_not(string, rate):
    finest = intervals(string, 1.0 / rate)
    assert finest == grid_bound(string, 1.0 / rate)
    largest = []
    for N in (finest, finest + 1):
        shape = np.random.default_rng(1).normal(size=N - 1)
        with np.errstate(all="ignore"):
            largest.append(np.abs(advanced(prepared(string, rate, N), shape, 3000)[-500:]).max())
    assert largest[0] < 4.0
    assert not largest[1] < 1e6


@both_strings
def test_the_grid_leaves_room_for_a_raised_tension(i):
    string, k = YEHU.strings[i], 1.0 / 44100.0
    raised = replace(string, T=1.5 * string.T)
    assert intervals(string, k, headroom=1.5) == grid_bound(raised, k)
    assert intervals(string, k, headroom=1.5) < intervals(string, k)


# ---------------------------------------------------------------- given other tension and loss


@three_rates
def test_a_string_that_is_retuned_is_as_one_made_so(rate):
    model, state = kernel.prepare(YEHU, rate).copy(), np.zeros(1, layout.STATE)
    silk = YEHU.string_1
    T, sigma_0, sigma_1 = 0.999 * silk.T, 1.5 * silk.sigma_0, 1.01 * silk.sigma_1
    slacker = replace(silk, T=T, sigma_0=sigma_0, sigma_1=sigma_1)
    made = kernel.prepare(replace(YEHU, string_1=slacker), rate)
    assert made["N"][0, 0] == model["N"][0, 0]
    state["contacts"]["placed"] = 1
    kernel.retune(model, state, 0, T, sigma_0, sigma_1)
    assert model["ghat"] == made["ghat"]
    for field in set(layout.MODEL.names) - {"ghat"}:
        np.testing.assert_allclose(model[field], made[field], rtol=1e-12, err_msg=field)
    assert state["contacts"]["placed"] == 0  # its compliances have to be worked out anew


@both_strings
@three_rates
def test_no_more_loss_is_taken_than_the_grid_bears(i, rate):
    model, state = kernel.prepare(YEHU, rate), np.zeros(1, layout.STATE)
    silk = YEHU.strings[i]
    kernel.retune(model, state, i, silk.T, silk.sigma_0, 1.0)
    most = float(model["sigma_1"][0, i])
    assert silk.sigma_1 < most < 1.0
    spacing = least_spacing(replace(silk, sigma_1=most), 1.0 / rate)
    assert spacing == pytest.approx(float(model["h"][0, i]), rel=1e-9)
