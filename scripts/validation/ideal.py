"""Limits that are known in closed form: an ideal string on a rigid or a resistive bridge.

The model's own kernel, with another instrument file: a flexible string without losses, an open
string between the loop and a bridge near its end, a rigid hair, and a body that is one dashpot.
What is maintained, and not what begins, is compared: the force changes slowly until Helmholtz
motion ends. Source of the limits: [Schelleng].
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from yehu_server.core.physics.default_quantities import BowQuantities, Quantities, StringQuantities
from yehu_server.scores.gesture import Gesture
from yehu_server.simulation.run import Simulation, simulate

RATE = 176400.0
SPEED = 0.2  # m/s
BRIDGE, AFTER = 0.30, 0.012  # m: the string, and the stub behind the bridge
DASHPOTS = {"rigid": 1e6, "resistive": 25.0}  # kg/s
MODE_HZ, Q = 1000.0, 0.02  # so broad a mode is a dashpot from 20 Hz to 50 kHz
BETAS = (0.088, 0.101, 0.117, 0.135, 0.156, 0.181)
ORDINARY = 0.4  # of the greatest force: from there Helmholtz motion begins
RAMP_S = 2.5
HAIR: dict[str, Any] = {
    "epsilon_0": 1.5e5, "epsilon_1": 0.05, "xi": (0.9, 0.9), "K_h": 1e8, "R_h": 1e3, "M_h": 0.1,
}  # fmt: skip
SETTLE_S = 0.4
REGULAR = 0.25  # of the period: slips that are farther off are others
SLIP = 0.35  # of the slipping velocity: what is faster is a slip


def instrument(bridge: str = "rigid", **bow: Any) -> Quantities:
    """The ideal string; `bow` replaces quantities of the hair."""
    ideal = StringQuantities(L=BRIDGE + AFTER, E=0.0, sigma_0=0.0, sigma_1=0.0)
    other = StringQuantities(L=BRIDGE + AFTER, r=1e-4, T=1.0, E=0.0, sigma_0=100.0)
    dashpot = DASHPOTS[bridge]
    mass = Q * dashpot / (2.0 * math.pi * MODE_HZ)
    body = replace(Quantities().body, frequency_hz=(MODE_HZ,), mass=(mass,), damping=(dashpot,))
    hair = HAIR | bow
    return Quantities(
        string_1=ideal,
        string_2=other,
        bow=BowQuantities(**hair),
        bridge_x=BRIDGE,
        tension_modulation=0.0,
        felt_loss=0.0,
        body=body,
    )


def impedance(quantities: Quantities) -> float:
    """Of string 1 (kg/s)."""
    string = quantities.string_1
    return math.sqrt(string.T * string.rho_A)


def period(quantities: Quantities) -> float:
    """Of string 1 between loop and bridge (s)."""
    string = quantities.string_1
    return 2.0 * BRIDGE / math.sqrt(string.T / string.rho_A)


def run(quantities: Quantities, beta: float, force: Any, seconds: float) -> Simulation:
    """Bow the string from rest; `force` is a number or a curve."""
    curve = ((0.0, force),) if isinstance(force, float) else tuple(force)
    gesture = Gesture(
        sample_rate=RATE,
        duration=seconds,
        quantities=quantities,
        controls={
            "bow_force": curve,
            "bow_velocity": ((0.0, 0.0), (0.03, SPEED)),
            "bow_position": ((0.0, BRIDGE * (1.0 - beta)),),
        },
    )
    return simulate(gesture)


def greatest_force(quantities: Quantities, beta: float) -> float:
    """Schelleng's greatest bow force (N)."""
    bow = quantities.bow
    return 2.0 * impedance(quantities) * SPEED / (beta * (bow.mu_S - bow.mu_C))


def least_force(quantities: Quantities, beta: float) -> float:
    """Schelleng's least bow force (N) on a dashpot."""
    bow, wave = quantities.bow, impedance(quantities)
    return wave**2 * SPEED / (2.0 * DASHPOTS["resistive"] * beta**2 * (bow.mu_S - bow.mu_C))


def slips_of(simulation: Simulation, beta: float) -> Any:
    """When slips begin (s)."""
    velocity = simulation.arrays["relative_velocity"]
    slips = velocity < -SLIP * SPEED / beta
    return simulation.arrays["time"][1:][slips[1:] & ~slips[:-1]]


def helmholtz(beta: float, force: float) -> dict[str, float]:
    """Share of slipping, slipping velocity and sawtooth of a steady note, against their limits."""
    quantities = instrument()
    found = run(quantities, beta, force, SETTLE_S + 0.1)
    cycle, wave = period(quantities), impedance(quantities)
    last = found.arrays["time"] >= SETTLE_S + 0.1 - 20.0 * cycle
    velocity = found.arrays["relative_velocity"][last]
    slipping = velocity < -SLIP * SPEED / beta
    times = slips_of(found, beta)
    force_on_bridge, time = found.arrays["bridge_force_1"][last], found.arrays["time"][last]
    # The n-th partial of a sawtooth that jumps by J has the amplitude J / (n pi).
    partials = np.array([1, 2, 3])
    turns = np.exp(-2j * math.pi * partials[:, np.newaxis] * time / cycle)
    jump = np.mean(math.pi * partials * 2.0 * np.abs(turns @ force_on_bridge) / len(time))
    return {
        "beta": beta,
        "force": force,
        "slips": float(np.sum(times >= SETTLE_S + 0.1 - 20.0 * cycle)) / 20.0,
        "slip_share": float(slipping.mean()) / beta,
        "slip_velocity": float(np.median(velocity[slipping])) / (-SPEED / beta),
        "sawtooth": float(jump) / (2.0 * wave * SPEED / beta),
    }


def measured_limit(bridge: str, beta: float, *, upper: bool, **bow: Any) -> dict[str, float]:
    """The force (N) at which Helmholtz motion ends, as it slowly grows, or falls.

    Beside it the friction coefficient that the hair reaches before it lets go, near that force.
    """
    quantities = instrument(bridge, **bow)
    great, least = greatest_force(quantities, beta), least_force(quantities, beta)
    begin = ORDINARY * great
    end = 10.0 * great if upper else 0.3 * least
    steps = np.linspace(0.0, 1.0, 60)
    forces = begin * (end / begin) ** steps
    curve = [(0.0, begin), *zip((SETTLE_S + RAMP_S * steps).tolist(), forces.tolist(), strict=True)]
    found = run(quantities, beta, curve, SETTLE_S + RAMP_S)
    times = slips_of(found, beta)
    gaps = np.diff(times) / period(quantities)
    off = (gaps > 1.0 + REGULAR) | (gaps < 1.0 - REGULAR)
    lasting = off[:-2] & off[1:-1] & off[2:] & (times[1:-2] > SETTLE_S)
    last = float(times[1:-2][lasting][0]) if lasting.any() else math.nan
    time, force = found.arrays["time"], found.arrays["bow_force"]
    before = (time > last - 0.1) & (time < last)
    friction = np.abs(found.arrays["friction_force"] / force)[before]
    limit = float(np.interp(last, time, force))
    return {
        "beta": beta,
        "limit": limit,
        "schelleng": great if upper else least,
        "reached": float(np.percentile(friction, 99.0)) if len(friction) else math.nan,
    }


def exponent(betas: Any, forces: Any) -> float:
    """Of forces as a power of beta: the median over all pairs."""
    x, y = np.log(betas), np.log(forces)
    one, other = np.triu_indices(len(x), 1)
    return float(np.median((y[other] - y[one]) / (x[other] - x[one])))
