"""Bodies of tests, their responses in closed form, and taps with faults."""

import json
from dataclasses import replace
from importlib.resources import files

import numpy as np

BODY = json.loads(files("yehu_server.core.physics").joinpath("body.json").read_text())
MODES = BODY["bridge_modes"]
HZ = np.array([mode["frequency_hz"] for mode in MODES])
MASS = np.array([mode["mass_kg"] for mode in MODES])
DAMPING = np.array([mode["damping_kg_per_s"] for mode in MODES])


def admittance(hz, modes_hz=HZ, mass=MASS, damping=DAMPING):
    """The sum of masses on springs and dashpots, each 1 / (j w M + R + K / j w), in s/kg."""
    omega = 2.0 * np.pi * np.asarray(hz)[:, np.newaxis]
    stiffness = mass * (2.0 * np.pi * modes_hz) ** 2
    return (1.0 / (1j * omega * mass + damping + stiffness / (1j * omega))).sum(axis=1)


def radiation(hz):
    """The measured filter as its sections are written, in Pa/N."""
    z = np.exp(2j * np.pi * np.asarray(hz) / BODY["radiation"]["sample_rate_hz"])
    total = np.full(len(z), BODY["radiation"]["direct_gain"], complex)
    for b0, b1, a1, a2 in BODY["radiation"]["sections"]:
        total += (b0 + b1 / z) / (1.0 + a1 / z + a2 / z**2)
    return total


def off_db(one, other):
    """How far one response is above another (dB)."""
    return 20.0 * np.log10(np.abs(one) / np.abs(other))


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def clipped(tap, share=0.6):
    """A tap whose velocity was too large for the converter."""
    limit = share * np.abs(tap.velocity).max()
    return replace(tap, responses={"velocity": tap.velocity.clip(-limit, limit)})


def hit_twice(tap, after_s=0.01, size=0.3):
    """A tap whose hammer came back: all of it again, a little later and smaller."""
    late = round(after_s * tap.rate)

    def again(values):
        return values + size * np.concatenate([np.zeros(late), values[:-late]])

    responses = {what: again(values) for what, values in tap.responses.items()}
    return replace(tap, force=again(tap.force), responses=responses)


def with_velocity_only(tap):
    return replace(tap, responses={"velocity": tap.velocity})
