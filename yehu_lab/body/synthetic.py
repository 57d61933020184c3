"""Taps that a hammer would give on a body whose modes are known: to try the workshop with.

The modes' velocity under a half-sine pulse is written in closed form, at eight times the sample
rate, and both channels go through the same low-pass filter, as in a recording interface.
"""

import math

import numpy as np

from yehu_lab.body.curve import Floats
from yehu_lab.body.tap import Tap
from yehu_server.core.physics.default_quantities import Body, measured_body
from yehu_server.errors import ParameterError
from yehu_server.util.hints import require_package
from yehu_server.util.values import whole

MAX_TAPS = 1000

OVER = 8  # samples computed for one that is kept
BLOCK = 512  # samples
BEFORE_S = 0.02  # silence before the hit
SPREAD = 0.1  # relative: how much the taps differ in force and length


def made_taps(
    body: Body | None = None,
    *,
    count: int = 5,
    noise_db: float = 60.0,
    rate: float = 44100.0,
    seconds: float = 0.6,
    newtons: float = 20.0,
    contact_s: float = 2e-4,
    seed: int = 0,
) -> list[Tap]:
    """Make taps on a body.

    Parameters
    ----------
    body : Body, optional
        By default the one that comes with the package, of a measured yehu.
    noise_db : float
        How far white noise lies below each channel's rms (dB).
    rate : float
        Sample rate (Hz); pressure is made at the rate of the body's radiation only.
    newtons, contact_s : float
        Peak of the force (N), and how long the hammer touches (s); a little different each time.
    """
    require_package("scipy", "the body workshop", "body")
    try:
        count = whole(count, 1, MAX_TAPS)
    except ParameterError as error:
        raise ParameterError(f"count: {error}") from None
    body = body or measured_body()
    random = np.random.default_rng(seed)
    taps = []
    for i in range(count):
        peak = newtons * (1.0 + SPREAD * random.uniform(-1.0, 1.0))
        contact = contact_s * (1.0 + SPREAD * random.uniform(-1.0, 1.0))
        onset = BEFORE_S + random.uniform(0.0, 1.0) / rate
        time = np.arange(round(seconds * rate) * OVER) / (rate * OVER) - onset
        force = np.where(
            (time > 0.0) & (time < contact), peak * np.sin(math.pi * time / contact), 0.0
        )
        channels = {"force": _kept(force), "velocity": _kept(velocity(body, time, peak, contact))}
        if rate == body.radiation_rate:
            channels["pressure"] = _radiated(body, channels["force"])
        for what, values in channels.items():
            size = float(np.sqrt(np.mean(values**2))) * 10.0 ** (-noise_db / 20.0)
            channels[what] = values + size * random.standard_normal(len(values))
        taps.append(Tap(rate, channels.pop("force"), channels, f"tap {i + 1}"))
    return taps


def velocity(body: Body, time: Floats, newtons: float, contact_s: float) -> Floats:
    """Velocity (m/s) of a body at rest that is hit at time 0 by a half sine, in closed form.

    Times are a grid (s) that goes on after the contact.
    """
    turn = math.pi / contact_s
    first, last = np.searchsorted(time, [0.0, contact_s])
    touched, after = time[first:last], time[last:] - contact_s
    # The free decay's exponentials, as products of those of a block and those within it.
    blocks, within = after[::BLOCK], after[:BLOCK] - after[0]
    total = np.zeros(len(time))
    for omega, mass, damping in zip(body.omega, body.mass, body.damping, strict=True):
        sigma = damping / (2.0 * mass)
        pole = complex(-sigma, math.sqrt(omega**2 - sigma**2))
        # Integral of sin(turn tau) exp(pole (t - tau)) over the contact so far.
        ahead, back = 1j * turn - pole, -1j * turn - pole
        until = np.append(touched, contact_s)
        forced = (np.exp(ahead * until) - 1.0) / ahead - (np.exp(back * until) - 1.0) / back
        driven = pole * np.exp(pole * until) * forced / 2j * newtons / (mass * pole.imag)
        total[first:last] += driven[:-1].imag
        free = np.outer(driven[-1] * np.exp(pole * blocks), np.exp(pole * within))
        total[last:] += free.ravel()[: len(after)].imag
    return total


def _kept(values: Floats) -> Floats:
    """Every eighth sample of what is left below the Nyquist frequency."""
    from scipy.signal import resample_poly

    return np.asarray(resample_poly(values, 1, OVER))


def _radiated(body: Body, force: Floats) -> Floats:
    """Sound pressure (Pa) of a force: the radiation filter's sections, one by one."""
    from scipy.signal import lfilter

    pressure = body.direct_gain * force
    for b_0, b_1, a_1, a_2 in body.sections:
        pressure = pressure + lfilter([b_0, b_1], [1.0, a_1, a_2], force)
    return np.asarray(pressure)
