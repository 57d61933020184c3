"""Fits that several files look at: each takes seconds."""

import pytest
from lab.body.bodies import with_velocity_only

from yehu_lab.body import average, fit, made_taps


@pytest.fixture(scope="session")
def taps():
    """Five taps of the shipped body, with noise 60 dB below."""
    return made_taps(noise_db=60.0)


@pytest.fixture(scope="session")
def whole_fit(once):
    """Admittance and radiation of five taps with noise 40 dB below."""
    return once("whole_fit", lambda _: fit(average(made_taps(noise_db=40.0, seconds=0.4))))


@pytest.fixture(scope="session", params=[40.0, 30.0], ids=lambda db: f"{db:g}dB")
def fitted(request, whole_fit, once):
    """The noise below the signals (dB), and what is fitted to five such taps."""
    if request.param == 40.0:
        return request.param, whole_fit

    def noisier(_):
        taps = made_taps(noise_db=request.param, seconds=0.4, seed=1)
        measured = average([with_velocity_only(tap) for tap in taps])
        return fit(measured, band_hz=(150.0, 5500.0))

    return request.param, once("noisier_fit", noisier)
