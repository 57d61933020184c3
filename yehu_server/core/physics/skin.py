"""The skin of a finger, which drags a string along with it in the bow's direction.

It is a spring that yields: its deflection s follows the string, but for a part that grows with the
force that it bears over mu_s f_n, the friction of skin on string under a normal force f_n [Dahl]:

    ds/dt = v - a s,   a = K_s |v|/(mu_s f_n),   f = K_s s + R ds/dt.

So it bears no more than mu_s f_n for long. Whatever a is, it only loses energy while a R <= 4 K_s,

    f v - K_s s ds/dt = a K_s s^2 + a R s ds/dt + R (ds/dt)^2 >= 0,

so skin that yields fast damps less: R = R_s/(1 + a R_s/(4 K_s)). With a of the step before, the law
is linear within a step.

Differs: [Yehu] has no second direction.
Source: [Dahl]; docs/derivation.md, section 11.
"""

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import LEVELS, STRINGS
from yehu_server.core.physics.records import Contacts, Model, Motion, Planes, Work


@compiled
def let_go(d: Planes, w: Work, p: int) -> None:
    """Drop the deflection of the skin at contact `p`; add its energy to the ledger."""
    if d.s[p] != 0.0:
        w.dropped_Psi += 0.5 * d.K_s * d.s[p] * d.s[p]
        d.s[p] = 0.0


@compiled
def prepare_skin(m: Model, d: Planes, p: int) -> tuple[float, float]:
    """Write the law of contact `p` in this step, f = f_0 + Z v; return f_0/Z and Z (m/s, kg/s)."""
    a = d.K_s * abs(d.skin_velocity[p]) / (d.mu_s * d.f_n[p])
    R = d.R_s / (1.0 + a * d.R_s / (4.0 * d.K_s))
    held = 1.0 / (1.0 + 0.5 * m.k * a)
    Z = (0.5 * m.k * d.K_s + R) * held
    d.yielding[p], d.R_now[p], d.Z[p] = a, R, Z
    return (d.K_s - R * a) * held * d.s[p] / Z, Z


@compiled
def advance_skin(m: Model, d: Planes, p: int, v: float, f: float) -> None:
    """Advance the deflection of the skin at contact `p`, for the velocity (m/s) found."""
    a = d.yielding[p]
    d.s_bar[p] = (d.s[p] + 0.5 * m.k * v) / (1.0 + 0.5 * m.k * a)
    d.s_rate[p] = v - a * d.s_bar[p]
    d.s[p] = 2.0 * d.s_bar[p] - d.s[p]
    d.skin_velocity[p], d.skin_force[p] = v, f


# ---------------------------------------------------------------- for the ledger


@compiled
def skin_power(m: Model, s: Motion, c: Contacts, d: Planes, p: int, next_: int) -> float:
    """Return what the skin at contact `p` takes beyond what it stores (W)."""
    i, prev = p % STRINGS, (next_ + 1) % LEVELS
    first, weights = c.first[p], c.weights[p]
    travel = interpolate(s.u[next_, i], first, weights) - interpolate(s.u[prev, i], first, weights)
    v = 0.5 * m.rate * travel
    return float(d.skin_force[p] * v - d.K_s * d.s_bar[p] * d.s_rate[p])
