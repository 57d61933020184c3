"""The bow pressed onto a string: its mass, and the contact of its hair normal to the string.

The bow's share of mass M_n at the string is pressed by the bow force; hair gives way as a finger
does (finger.py), by a law of Hunt and Crossley. Friction sees the force of this contact. The hair
runs between the strings: it presses string 1 towards the neck, as fingers do, and string 2 away
from it. A lifted bow touches nothing, and one that is put down begins on the string's surface.

Differs: [Yehu] has no second direction; there friction sees the bow force itself.
Source: [Desvages]; docs/derivation.md, section 11.
"""

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.finger import limited_gradient
from yehu_server.core.physics.fixed_power import power
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import BOW
from yehu_server.core.physics.records import Contacts, Model, Motion, Planes, Work


@compiled
def hair_position(d: Planes, c: Contacts, n: Motion, level: int) -> float:
    """Return I v under the hair, counted towards it (m)."""
    i = c.string[BOW]
    return float(d.side * interpolate(n.u[level, i], c.first[BOW], c.weights[BOW]))


@compiled
def lift_hair(m: Model, d: Planes, w: Work, now: int, prev: int) -> None:
    """Take the hair off the string; record its energy as a loss."""
    if d.is_on:
        velocity = m.rate * (d.Y[now] - d.Y[prev])
        w.dropped_z += 0.5 * d.M_n * velocity * velocity + 0.5 * d.Psi * d.Psi
    d.Y[:] = 0.0
    d.Psi, d.is_on, d.g, d.f_n[BOW] = 0.0, 0, 0.0, 0.0


@compiled
def press_hair(
    m: Model, d: Planes, c: Contacts, n: Motion, w: Work, F_N: float, is_pressed: bool,
    next_: int, now: int, prev: int,
) -> None:  # fmt: skip
    """Advance the bow's mass free of the contact; write the contact's gradient.

    `F_N` (N) is the bow force; the contact's string and place are those of the bow.
    """
    side = 1.0 if c.string[BOW] == 0 else -1.0
    if not is_pressed or side != d.side:
        lift_hair(m, d, w, now, prev)
    d.side, d.g, d.f_ext = side, 0.0, 0.0
    if not is_pressed:
        return
    if not d.is_on:
        d.is_on = 1
        d.Y[now] = d.Y[prev] = hair_position(d, c, n, now)
    d.f_ext = -abs(F_N)
    d.Y[next_] = 2.0 * d.Y[now] - d.Y[prev] + d.C_n * d.f_ext
    eta = hair_position(d, c, n, now) - d.Y[now]
    if d.Psi != 0.0 and (eta <= 0.0 or d.Psi < 0.0):
        w.dropped_Psi += 0.5 * d.Psi * d.Psi
        d.Psi = 0.0
    if eta > 0.0:
        d.g = power(d.ghat, eta)
        d.eta_prev = hair_position(d, c, n, prev) - d.Y[prev]


@compiled
def hair_stiffness(m: Model, d: Planes, travel: float) -> float:
    """Limit the gradient for a travel without this force (m); return A_f of eq. (35) (N/m)."""
    d.g = limited_gradient(d.g, d.Psi, travel)
    return float(0.25 * d.g * d.g + 0.5 * m.rate * d.beta_n * d.g * d.Psi)


@compiled
def move_hair(m: Model, d: Planes, next_: int, f: float) -> None:
    """Move the bow's mass by the contact's force (N); advance Psi as ``finger.advance_contact``."""
    d.Y[next_] += d.C_n * f
    d.Psi_prev = d.Psi
    if d.g > 0.0:
        d.Psi += 0.5 * (f - d.g * d.Psi) / (0.25 * d.g + 0.5 * m.rate * d.beta_n * d.Psi)
    d.f_n[BOW] = f


# ---------------------------------------------------------------- for the ledger


@compiled
def press_energy(m: Model, d: Planes, next_: int, now: int) -> float:
    """Return the energy of the bow's mass and of the contact at n + 1/2 (J)."""
    if not d.is_on:
        return 0.0
    velocity = m.rate * (d.Y[next_] - d.Y[now])
    return float(0.5 * d.M_n * velocity * velocity + 0.5 * d.Psi * d.Psi)


@compiled
def press_loss(m: Model, d: Planes, c: Contacts, n: Motion, next_: int) -> float:
    """Return what the contact of the hair loses (W)."""
    if d.g == 0.0:
        return 0.0
    travel = hair_position(d, c, n, next_) - d.Y[next_] - d.eta_prev
    return float(d.beta_n * d.g * d.Psi_prev * (0.5 * m.rate * travel) ** 2)
