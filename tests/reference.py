"""One time step of the yehu, slow and dense, written straight from the equations.

An independent oracle for tests: it shares no code with `yehu_server.core.physics`, uses numpy only,
and prefers matrices and one dense solve to everything fast. [Yehu] is Zheng, Darabundit, Scavone,
"Physical model of the Chinese yehu for sound synthesis", DAFx26, with the corrections of the
project's physics notes; equation numbers are that paper's. Symbols are the paper's, in ASCII.

Layout. Everything that moves is stacked into one vector
    X = (u_1[1:-1], u_2[1:-1], q_1..q_M, U_1..U_F, zeta_1, zeta_2),
and each equation of motion is diagonal in X^{n+1}:
    a X^{n+1} = b + G f,
with b known, f the unknown forces and the columns of G their spreading vectors. Each force p also
has a row of W that reads the motion it works on (the bridge's gap, a contact's eta, the bow's
place). Bridge and contact forces, and the tensions, are linear in W X^{n+1}: a dense system gives
them as f_0 + f_1 f_b; what is left is one scalar equation for the friction force f_b.

State convention. `RefState` holds u = u^n and u_prev = u^{n-1} (likewise q, zeta, U), and z, Psi at
n-1/2. `step` returns the state one sample later. Inputs are never modified.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class SeveralRootsError(ArithmeticError):
    """The friction equation has more than one solution in this step."""

    def __init__(self, roots: list[float]) -> None:
        super().__init__(f"friction has {len(roots)} solutions, near v_r = {roots}")
        self.roots = roots


# ---------------------------------------------------------------------------------------------
# Data
# ---------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, kw_only=True)
class RefString:
    """One string: [Yehu] eq. (2), and its number of grid intervals N."""

    rho: float  # kg/m^3
    A: float  # m^2
    T: float  # N
    EI: float  # N m^2
    sigma_0: float  # 1/s
    sigma_1: float  # m^2/s
    L: float  # m
    N: int
    EA: float = 0.0  # N; stiffness against stretching, 0 for constant tension
    felt: Array  # (N-1,), 1/s; what felt adds to sigma_0 at each inner node

    @property
    def h(self) -> float:
        return self.L / self.N


@dataclass(frozen=True, eq=False, kw_only=True)
class RefParams:
    """Everything that does not change from sample to sample (SI units)."""

    strings: list[RefString]
    x_c: float
    M: Array  # modal masses, kg
    R: Array  # modal dampings, kg/s
    omega: Array  # modal frequencies, rad/s
    eps0: float
    eps1bar: float
    v_s: float
    mu_C: float
    mu_S: float
    xi: Array  # (2,), one per string
    M_h: float
    K_h: float
    R_h: float
    lift_threshold: float  # N
    M_f: float
    K_f: float
    alpha: float
    beta: float
    omega_lift: float  # rad/s
    U_rest: float  # m
    rate: float  # Hz

    @property
    def k(self) -> float:
        return 1.0 / self.rate

    @property
    def K(self) -> Array:
        """Modal stiffness, pre-warped so that mu_tt leaves the mode at omega. Differs: (11)."""
        k = self.k
        warped: Array = 2.0 / k * np.tan(self.omega * k / 2.0)
        return self.M * warped**2


@dataclass(frozen=True, eq=False, kw_only=True)
class RefState:
    """u, q, zeta, U at n; *_prev at n-1; z and Psi at n-1/2."""

    u: list[Array]  # two arrays of N_i + 1 points, the zero ends included
    u_prev: list[Array]
    q: Array  # (M,)
    q_prev: Array
    zeta: Array  # (2,)
    zeta_prev: Array
    z: Array  # (2,)
    U: Array  # (F,)
    U_prev: Array
    Psi: Array  # (F, 2)


@dataclass(frozen=True, eq=False, kw_only=True)
class RefControls:
    """What acts on the instrument during one step."""

    v_b: float
    F_N: float  # > 0 bows string 0, < 0 bows string 1
    x_b: float
    f_hammer: float
    x_f: Array  # (F,)
    press: Array  # (F,), N, >= 0; 0 means the finger is lifted
    f_pluck: float = 0.0  # N, towards the finger: > 0 pulls string 0, < 0 pulls string 1
    x_pluck: float = 0.2


@dataclass(frozen=True, eq=False, kw_only=True)
class RefOutputs:
    """Forces of the step, and what a test may want to look at."""

    f_c: Array  # (2,)
    f_b: float  # on the bowed string; 0 when the bow is lifted
    v_r: float  # the friction solver's v_r; 0 when the bow is lifted
    f_f: Array  # (F, 2)
    bowed: int  # 0, 1, or -1 when the bow is lifted
    zbar: float  # mu_t0 z of the bowed string
    f_ext: Array  # (F,)
    eta: Array  # (F, 2), eta^n
    eta_star: Array  # (F, 2)
    g: Array  # (F, 2)
    theta: Array  # (F, 2)
    scalar_I: float


def largest_N(
    rho: float, A: float, T: float, EI: float, sigma_0: float, sigma_1: float, L: float, k: float
) -> int:
    """The finest stable grid, (57) with the corrected 2 k sigma_1."""
    del sigma_0  # it does not enter the bound
    rho_A = rho * A
    root = np.sqrt((T * k / rho_A + 4.0 * sigma_1) ** 2 + 16.0 * EI / rho_A)
    h_min = np.sqrt(T * k**2 / (2.0 * rho_A) + 2.0 * k * sigma_1 + k / 2.0 * root)
    return int(np.floor(L / h_min))


def rest_state(params: RefParams, fingers: int) -> RefState:
    """All at rest, the fingers at their resting height."""

    def flat() -> list[Array]:
        return [np.zeros(string.N + 1) for string in params.strings]

    modes = len(params.M)
    return RefState(
        u=flat(),
        u_prev=flat(),
        q=np.zeros(modes),
        q_prev=np.zeros(modes),
        zeta=np.zeros(2),
        zeta_prev=np.zeros(2),
        z=np.zeros(2),
        U=np.full(fingers, params.U_rest),
        U_prev=np.full(fingers, params.U_rest),
        Psi=np.zeros((fingers, 2)),
    )


# ---------------------------------------------------------------------------------------------
# Operators in space
# ---------------------------------------------------------------------------------------------


@cache
def D_minus(string: RefString) -> Array:
    """(27): N x (N-1), the slope between neighbours of the interior nodes, ends fixed at zero."""
    N = string.N
    return (np.eye(N, N - 1) - np.eye(N, N - 1, k=-1)) / string.h


def D_plus(string: RefString) -> Array:
    """(27): (N-1) x N."""
    return -D_minus(string).T


@cache
def D_2(string: RefString) -> Array:
    """(27): (N-1) x (N-1)."""
    return D_plus(string) @ D_minus(string)


@cache
def D_4(string: RefString) -> Array:
    """(27), corrected: D4 = D2 D2, the ends simply supported (3)."""
    return D_2(string) @ D_2(string)


def interpolate_cubic(string: RefString, x: float) -> Array:
    """I as N-1 weights: cubic Lagrange on nodes l-1 .. l+2, l = floor(x/h); ends dropped."""
    left = int(np.floor(x / string.h))
    frac = x / string.h - left
    return _weights(string, left - 1, np.array([-1.0, 0.0, 1.0, 2.0]), frac)


def interpolate_linear(string: RefString, x: float) -> Array:
    """I as N-1 weights: linear on nodes l, l+1, l = floor(x/h); ends dropped."""
    left = int(np.floor(x / string.h))
    frac = x / string.h - left
    return _weights(string, left, np.array([0.0, 1.0]), frac)


def _weights(string: RefString, first: int, offsets: Array, frac: float) -> Array:
    """Lagrange's polynomials through `offsets`, at `frac`, the first on node `first`."""
    if first < 0 or first + len(offsets) - 1 > string.N:
        raise ValueError(f"stencil at node {first} leaves the grid 0..{string.N}")
    full = np.zeros(string.N + 1)
    for j, own in enumerate(offsets):
        others = np.delete(offsets, j)
        full[first + j] = np.prod((frac - others) / (own - others))
    return full[1:-1]


# ---------------------------------------------------------------------------------------------
# Friction: (17)-(20), (25), (46), (52)
# ---------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, kw_only=True)
class Friction:
    """The friction law of one string at one step, F_N > 0."""

    params: RefParams
    F_N: float
    xi: float
    z: float  # z^{n-1/2}

    def eps1(self, v_r: Array) -> Array:
        """(25)."""
        p = self.params
        gamma = p.mu_C * self.F_N / p.eps1bar
        return p.mu_C * self.F_N / np.sqrt(v_r**2 + gamma**2)

    def z_ss(self, v_r: Array) -> Array:
        """|z_ss|, (17) without its sign."""
        p = self.params
        curve = p.mu_C + (p.mu_S - p.mu_C) * np.exp(-((v_r / p.v_s) ** 2))
        return self.F_N / p.eps0 * curve

    def chi(self, v_r: Array, zbar: Array) -> Array:
        """(18)-(20), z_ba = xi mu_C F_N / eps0."""
        z_ba = self.xi * self.params.mu_C * self.F_N / self.params.eps0
        z_abs, z_ss = np.abs(zbar), self.z_ss(v_r)
        middle = 0.5 * (1.0 + np.sin(np.pi * (z_abs - 0.5 * (z_ss + z_ba)) / (z_ss - z_ba)))
        chi_m = np.where(z_abs <= z_ba, 0.0, np.where(z_abs >= z_ss, 1.0, middle))
        return np.where(v_r * zbar > 0.0, chi_m, 0.0)

    def r(self, v_r: Array, zbar: Array) -> Array:
        """(16). Where chi > 0, z and z_ss have the same sign: zbar/z_ss = |zbar|/|z_ss|."""
        return v_r * (1.0 - self.chi(v_r, zbar) * np.abs(zbar) / self.z_ss(v_r))

    def zbar_of(self, f_b: Array, v_r: Array) -> Array:
        """zbar from (46) with r = (2/k)(zbar - z): f_b = eps0 zbar + eps1 (2/k)(zbar - z)."""
        k, eps1 = self.params.k, self.eps1(v_r)
        return (f_b + eps1 * 2.0 * self.z / k) / (self.params.eps0 + eps1 * 2.0 / k)

    def residual(self, f_b: Array, s: float, mobility: float) -> Array:
        """(52), second row, in m/s, with v_r from its first row (49) and zbar from (46)."""
        v_r = s - mobility * f_b
        zbar = self.zbar_of(f_b, v_r)
        return self.r(v_r, zbar) - 2.0 * (zbar - self.z) / self.params.k

    def solve(self, s: float, mobility: float) -> float:
        """The f_b that goes with v_r = s - mobility f_b. SeveralRootsError if there are several.

        Any solution has |zbar| <= z_max: beyond z_ss the bristle moves back towards zero (16), so
        |zbar| < |z|. That bounds f_b by (46); below it the residual is > 0 and above it < 0.
        """
        p, k = self.params, self.params.k
        z_max = max(abs(self.z), p.mu_S * self.F_N / p.eps0)
        f_max = 1.01 * (p.eps0 * z_max + p.eps1bar * 2.0 * (z_max + abs(self.z)) / k)

        def function(f_b: Array) -> Array:
            return self.residual(f_b, s, mobility)

        # A scan of the whole bracket, finer where the law bends: around the Stribeck peak, and
        # where |zbar| passes z_ba and z_ss (eps0 |zbar| < mu_S F_N), for both extremes of eps1.
        peak = (s - np.linspace(-4.0, 4.0, 801) * p.v_s) / mobility
        bend = np.linspace(-1.5, 1.5, 801) * p.mu_S * self.F_N
        damped = bend * (1.0 + p.eps1bar * 2.0 / (k * p.eps0)) - p.eps1bar * 2.0 * self.z / k
        scan = np.concatenate((np.linspace(-f_max, f_max, 2001), peak, bend, damped))
        brackets = sign_changes(function, np.clip(scan, -f_max, f_max))
        roots = [root_to_the_last_bit(function, a, b) for a, b in brackets]
        if not roots:
            raise ArithmeticError(f"friction has no solution with |f_b| < {f_max} N, s = {s}")
        if len(roots) > 1:
            raise SeveralRootsError([s - mobility * f_b for f_b in roots])
        return roots[0]


def sign_changes(function: Callable[[Array], Array], scan: Array) -> list[tuple[float, float]]:
    """Intervals in which `function` changes sign, also those hidden between two scan points."""
    x = np.unique(scan)
    # Points nearly on top of each other would see rounding, not the function. Keep both ends.
    keep = np.diff(x, prepend=-np.inf) > 1e-9 * (x[-1] - x[0])
    keep[-1] = True
    x = x[keep]
    y = function(x)
    # Where |y| dips without a change of sign, look closer: two roots may hide there.
    for _ in range(4):
        same = (y[:-2] * y[1:-1] > 0.0) & (y[1:-1] * y[2:] > 0.0)
        dip = same & (np.abs(y[1:-1]) < np.abs(y[:-2])) & (np.abs(y[1:-1]) <= np.abs(y[2:]))
        places = np.flatnonzero(dip) + 1
        if len(places) == 0:
            break
        closer = [np.linspace(x[j - 1], x[j + 1], 101) for j in places]
        x = np.unique(np.concatenate([x, *closer]))
        y = function(x)
    (nonzero,) = np.nonzero(y)
    a, b = nonzero[:-1], nonzero[1:]
    changes = np.sign(y[a]) != np.sign(y[b])
    touches = ~changes & (b > a + 1)  # it touches zero and turns back: a double root
    crossed = [*zip(x[a[changes]], x[b[changes]], strict=True)]
    touched = [(place, place) for place in x[a[touches] + 1]]
    return [(float(low), float(high)) for low, high in crossed + 2 * touched]


def root_to_the_last_bit(function: Callable[[Array], Array], a: float, b: float) -> float:
    """Cut [a, b] into pieces until no float is left between its ends."""
    while True:
        x = np.unique(np.linspace(a, b, 33))
        y = function(x)
        best = int(np.argmin(np.abs(y)))
        if y[best] == 0.0 or len(x) <= 2:
            return float(x[best])
        j = int(np.flatnonzero(np.sign(y[:-1]) != np.sign(y[1:]))[0])
        a, b = float(x[j]), float(x[j + 1])


# ---------------------------------------------------------------------------------------------
# The step
# ---------------------------------------------------------------------------------------------


def bowed_string(params: RefParams, controls: RefControls) -> int:
    """0, 1, or -1 when the bow is lifted (section 2.4: the sign of F_N chooses the string)."""
    if abs(controls.F_N) < params.lift_threshold or controls.F_N == 0.0:
        return -1
    return 0 if controls.F_N > 0.0 else 1


def plucking_force(controls: RefControls, string: int) -> float:
    """N, never negative; the sign of f_pluck chooses the string as that of F_N does."""
    return max(controls.f_pluck if string == 0 else -controls.f_pluck, 0.0)


def finger_readings(params: RefParams, state_u: list[Array], U: Array, x_f: Array) -> Array:
    """eta (F, 2) of (6): I_f u_i - U."""
    eta = np.zeros((len(U), 2))
    for j in range(len(U)):
        for i, string in enumerate(params.strings):
            eta[j, i] = interpolate_cubic(string, float(x_f[j])) @ state_u[i][1:-1] - U[j]
    return eta


def after_resets(params: RefParams, state: RefState, controls: RefControls) -> tuple[Array, Array]:
    """z and Psi as the step uses them: z = 0 off the bow, Psi = 0 out of contact or negative."""
    z = state.z.copy()
    for i in range(2):
        if i != bowed_string(params, controls):
            z[i] = 0.0
    eta = finger_readings(params, state.u, state.U, controls.x_f)
    Psi = np.where((eta <= 0.0) | (state.Psi < 0.0), 0.0, state.Psi)
    return z, Psi


def external_forces(params: RefParams, state: RefState, controls: RefControls) -> Array:
    """f_ext (F,) of (9): -press (pressing is downwards), or the lift law where press is zero."""
    if np.any(controls.press < 0.0):
        raise ValueError("press must not be negative")
    K_l = params.M_f * params.omega_lift**2
    R_l = 2.0 * params.M_f * params.omega_lift
    lift = -K_l * (state.U - params.U_rest) - R_l * (state.U - state.U_prev) / params.k
    return np.where(controls.press > 0.0, -controls.press, lift)


def stretch(string: RefString, u: Array, u_prev: Array) -> float:
    """psi^{n-1/2} = kappa <delta_x+ u^n, delta_x+ u^{n-1}>, kappa^2 = EA/(4 L); V = psi^2/2."""
    D1 = D_minus(string)
    kappa = np.sqrt(string.EA / (4.0 * string.L))
    return float(kappa * string.h * (D1 @ u[1:-1]) @ (D1 @ u_prev[1:-1]))


def _stack(u: list[Array], q: Array, U: Array, zeta: Array) -> Array:
    return np.concatenate((u[0][1:-1], u[1][1:-1], q, U, zeta))


def step(params: RefParams, state: RefState, controls: RefControls) -> tuple[RefState, RefOutputs]:
    """Advance everything by one sample."""
    k = params.k
    strings = params.strings
    F, modes = len(state.U), len(params.M)
    bowed = bowed_string(params, controls)
    z, Psi = after_resets(params, state, controls)
    f_ext = external_forces(params, state, controls)

    # Where each part sits in X.
    ends = np.cumsum([strings[0].N - 1, strings[1].N - 1, modes, F, 2])
    in_u = (slice(0, ends[0]), slice(ends[0], ends[1]))
    in_q, in_U, in_zeta = (slice(ends[j], ends[j + 1]) for j in (1, 2, 3))
    size = int(ends[-1])
    X_prev = _stack(state.u_prev, state.q_prev, state.U_prev, state.zeta_prev)

    # -- The equations of motion without the unknown forces: a X^{n+1} = b ---------------------
    a, b = np.zeros(size), np.zeros(size)
    for i, string in enumerate(strings):  # (32)
        rho_A, one = string.rho * string.A, np.eye(string.N - 1)
        D2, D4 = D_2(string), D_4(string)
        local = string.sigma_0 + string.felt
        A_s = rho_A / k**2 + rho_A * local / k
        B_s = (
            2.0 * rho_A / k**2 * one
            + (string.T + 2.0 * rho_A * string.sigma_1 / k) * D2
            - string.EI * D4
        )
        C_s = np.diag(-rho_A / k**2 + rho_A * local / k) - (2.0 * rho_A * string.sigma_1 / k) * D2
        a[in_u[i]] = A_s
        b[in_u[i]] = B_s @ state.u[i][1:-1] + C_s @ state.u_prev[i][1:-1]
        # + J_pluck |f_pluck|, (30)
        pluck = plucking_force(controls, i)
        b[in_u[i]] += pluck * interpolate_cubic(string, controls.x_pluck) / string.h
    # (41), written out: M dtt q + K mu_tt q + R dt. q = f_hammer (- f_c1 - f_c2, below)
    M, K, R = params.M, params.K, params.R
    a[in_q] = M / k**2 + K / 4.0 + R / (2.0 * k)
    b[in_q] = (
        (2.0 * M / k**2 - K / 2.0) * state.q
        + (-M / k**2 - K / 4.0 + R / (2.0 * k)) * state.q_prev
        + controls.f_hammer
    )
    # (36)
    a[in_U] = params.M_f / k**2
    b[in_U] = params.M_f * (2.0 * state.U - state.U_prev) / k**2 + f_ext
    # (47), of the same form as (41)
    M_h, K_h, R_h = params.M_h, params.K_h, params.R_h
    a[in_zeta] = M_h / k**2 + K_h / 4.0 + R_h / (2.0 * k)
    b[in_zeta] = (2.0 * M_h / k**2 - K_h / 2.0) * state.zeta + (
        -M_h / k**2 - K_h / 4.0 + R_h / (2.0 * k)
    ) * state.zeta_prev

    # -- Spreading columns G and reading rows W of the linear forces f_c (2), f_f (2 F), tau (2)
    # Column 2 + 2 j + i belongs to finger j on string i. J = I^T / h (28).
    first_tau = 2 + 2 * F
    count = first_tau + 2
    G, W = np.zeros((size, count)), np.zeros((count, size))
    for i, string in enumerate(strings):
        I_c = interpolate_cubic(string, params.x_c)
        G[in_u[i], i] = I_c / string.h  # + J_c f_c, (30)
        G[in_q, i] = -1.0  # - f_c on every mode, (41)
        W[i, in_u[i]] = I_c  # I_c u_i - sum q, (44)
        W[i, in_q] = -1.0
        # Tension modulation: the string gains the force density + g_u tau, and tau reads g_u . u.
        kappa = np.sqrt(string.EA / (4.0 * string.L))
        g_u = 2.0 * kappa * (D_2(string) @ state.u[i][1:-1])
        G[in_u[i], first_tau + i] = g_u
        W[first_tau + i, in_u[i]] = g_u
        for j in range(F):
            col = 2 + 2 * j + i
            I_f = interpolate_cubic(string, float(controls.x_f[j]))
            G[in_u[i], col] = -I_f / string.h  # - J_f f_f, (30)
            G[in_U.start + j, col] = 1.0  # + f_f on the finger, (36)
            W[col, in_u[i]] = I_f  # eta = I_f u_i - U, (6)
            W[col, in_U.start + j] = -1.0
    # ... and of the friction force: - J_b f_b on the string (30), - f_b on the hair (47); it
    # reads I_b u + zeta (48).
    G_b, W_b = np.zeros(size), np.zeros(size)
    if bowed >= 0:
        I_b = interpolate_linear(strings[bowed], controls.x_b)
        G_b[in_u[bowed]] = -I_b / strings[bowed].h
        G_b[in_zeta.start + bowed] = -1.0
        W_b[in_u[bowed]] = I_b
        W_b[in_zeta.start + bowed] = 1.0
    friction = Friction(
        params=params,
        F_N=abs(controls.F_N),
        xi=float(params.xi[bowed]) if bowed >= 0 else np.nan,
        z=float(z[bowed]) if bowed >= 0 else np.nan,
    )

    eta_now = finger_readings(params, state.u, state.U, controls.x_f)
    eta_prev = finger_readings(params, state.u_prev, state.U_prev, controls.x_f)

    psi = [
        stretch(string, u, u_prev)
        for string, u, u_prev in zip(strings, state.u, state.u_prev, strict=True)
    ]

    def solve(g: Array) -> tuple[Array, Array, float, float, float, float]:
        """All forces of the step for given contact gradients g (F, 2); g = 0: contacts off.

        Returns X^{n+1}, (f_c, f_f), f_b, v_r, s, mobility.
        """
        # (35): f_f = A_f (eta^{n+1} - eta^{n-1}) + g Psi
        A_f = g**2 / 4.0 + params.beta * g * Psi / (2.0 * k)
        X_free = b / a
        matrix, rhs = np.zeros((count, count)), np.zeros((count, 2))
        #   W (X_free + (G f + G_b f_b) / a) is what every force reads at n+1.
        read_free, read_f, read_b = W @ X_free, (W / a) @ G, (W / a) @ G_b
        #   (44): the bridge's two readings vanish.
        matrix[:2] = read_f[:2]
        rhs[:2, 0] = -read_free[:2]
        rhs[:2, 1] = -read_b[:2]
        #   (35)
        A_row = A_f.reshape(-1)
        c = slice(2, first_tau)
        matrix[c] = np.eye(count)[c] - A_row[:, None] * read_f[c]
        rhs[c, 0] = A_row * (read_free[c] - eta_prev.reshape(-1)) + (g * Psi).reshape(-1)
        rhs[c, 1] = A_row * read_b[c]
        #   tau = psi - (h/4) g_u . (u^{n+1} - u^{n-1})
        for i, string in enumerate(strings):
            row, quarter = first_tau + i, string.h / 4.0
            matrix[row] = np.eye(count)[row] + quarter * read_f[row]
            rhs[row, 0] = psi[i] - quarter * (read_free[row] - float(W[row] @ X_prev))
            rhs[row, 1] = -quarter * read_b[row]
        #   The linear forces are f_0 + f_1 f_b.
        #   Rows in metres and rows in newtons: bring both to one, or the small ones lose digits.
        row = np.abs(matrix).max(axis=1, keepdims=True)
        f_0, f_1 = np.linalg.solve(matrix / row, rhs / row).T
        f_b, v_r, s, mobility = 0.0, 0.0, 0.0, 0.0
        if bowed >= 0:
            # (48) becomes (49): v_r = s - mobility f_b (v_b taken into s)
            s = float(W_b @ ((b + G @ f_0) / a - X_prev)) / (2.0 * k) - controls.v_b
            mobility = -float(W_b @ ((G @ f_1 + G_b) / a)) / (2.0 * k)
            f_b = friction.solve(s, mobility)
            v_r = s - mobility * f_b
        f = f_0 + f_1 * f_b
        return (b + G @ f + G_b * f_b) / a, f, f_b, v_r, s, mobility

    # -- Contact gradient: (33), (34), (58) ----------------------------------------------------
    X_star = solve(np.zeros((F, 2)))[0]
    eta_star = (W[2:first_tau] @ X_star).reshape(F, 2)
    open_eta = np.maximum(eta_now, 0.0)
    g_hat = np.sqrt(params.K_f * (params.alpha + 1.0) / 2.0 * open_eta ** (params.alpha - 1.0))
    theta = np.ones((F, 2))
    V = 4.0 * Psi + g_hat * (eta_star - eta_prev)
    for place in zip(*np.nonzero(V < 0.0), strict=True):
        theta[place] = -4.0 * Psi[place] / (g_hat[place] * (eta_star[place] - eta_prev[place]))
    g = theta * g_hat

    # -- The step itself -----------------------------------------------------------------------
    X_next, f, f_b, v_r, _, mobility = solve(g)
    eta_next = (W[2:first_tau] @ X_next).reshape(F, 2)
    Psi_next = Psi + g * (eta_next - eta_prev) / 2.0  # (33)
    z_next, zbar = z.copy(), 0.0
    if bowed >= 0:
        zbar = float(friction.zbar_of(np.array(f_b), np.array(v_r)))
        z_next[bowed] = 2.0 * zbar - z[bowed]  # section 3.5

    after = RefState(
        u=[np.pad(X_next[in_u[i]], 1) for i in range(2)],
        u_prev=[u.copy() for u in state.u],
        q=X_next[in_q].copy(),
        q_prev=state.q.copy(),
        zeta=X_next[in_zeta].copy(),
        zeta_prev=state.zeta.copy(),
        z=z_next,
        U=X_next[in_U].copy(),
        U_prev=state.U.copy(),
        Psi=Psi_next,
    )
    outputs = RefOutputs(
        f_c=f[:2].copy(),
        f_b=f_b,
        v_r=v_r,
        f_f=f[2:first_tau].reshape(F, 2).copy(),
        bowed=bowed,
        zbar=zbar,
        f_ext=f_ext,
        eta=eta_now,
        eta_star=eta_star,
        g=g,
        theta=theta,
        scalar_I=mobility,
    )
    return after, outputs


# ---------------------------------------------------------------------------------------------
# Read back from the grid
# ---------------------------------------------------------------------------------------------


def v_r_on_grid(
    params: RefParams, before: RefState, after: RefState, controls: RefControls
) -> float:
    """(48) from the states on both sides of the step; 0 when the bow is lifted."""
    i = bowed_string(params, controls)
    if i < 0:
        return 0.0
    I_b = interpolate_linear(params.strings[i], controls.x_b)
    moved = I_b @ (after.u[i] - before.u_prev[i])[1:-1] + after.zeta[i] - before.zeta_prev[i]
    return float(moved / (2.0 * params.k) - controls.v_b)


# ---------------------------------------------------------------------------------------------
# The energy ledger: (54)-(56) as corrected
# ---------------------------------------------------------------------------------------------


def energy(params: RefParams, state: RefState) -> dict[str, float]:
    """h^{n-1/2} of the state's pair (n-1, n) by part, in joules; "total" is their sum."""
    k = params.k
    h_s = 0.0
    for i, string in enumerate(params.strings):  # (55a)
        u, u_prev = state.u[i][1:-1], state.u_prev[i][1:-1]
        rho_A, D1, D2, h = string.rho * string.A, D_minus(string), D_2(string), string.h
        v = (u - u_prev) / k
        h_s += rho_A / 2.0 * h * float(v @ v)
        h_s += string.T / 2.0 * h * float((D1 @ u_prev) @ (D1 @ u))
        h_s += stretch(string, state.u[i], state.u_prev[i]) ** 2 / 2.0
        h_s += string.EI / 2.0 * h * float((D2 @ u_prev) @ (D2 @ u))
        h_s -= string.sigma_1 * k * rho_A / 2.0 * h * float((D1 @ v) @ (D1 @ v))
    v_U = (state.U - state.U_prev) / k
    v_q, mean_q = (state.q - state.q_prev) / k, (state.q + state.q_prev) / 2.0
    v_zeta, mean_zeta = (state.zeta - state.zeta_prev) / k, (state.zeta + state.zeta_prev) / 2.0
    parts = {
        "string": h_s,
        # (55b), corrected: M_f
        "finger": float(params.M_f / 2.0 * np.sum(v_U**2) + np.sum(state.Psi**2) / 2.0),
        # (55c)
        "bridge": float(np.sum(params.M / 2.0 * v_q**2 + params.K / 2.0 * mean_q**2)),
        # (55d), corrected: M_h
        "hair": float(np.sum(params.M_h / 2.0 * v_zeta**2 + params.K_h / 2.0 * mean_zeta**2)),
        # (55e)
        "bristle": float(params.eps0 / 2.0 * np.sum(state.z**2)),
    }
    return {**parts, "total": sum(parts.values())}


def power(
    params: RefParams, before: RefState, after: RefState, outputs: RefOutputs, controls: RefControls
) -> dict[str, float]:
    """p^n by source, in watts, (56a) corrected: the bow does the work - f_b v_b."""
    two_k = 2.0 * params.k
    plucked = [
        plucking_force(controls, i)
        * float(interpolate_cubic(string, controls.x_pluck) @ (u - u_prev)[1:-1])
        for i, (string, u, u_prev) in enumerate(
            zip(params.strings, after.u, before.u_prev, strict=True)
        )
    ]
    parts = {
        "finger": float(np.sum(outputs.f_ext * (after.U - before.U_prev))) / two_k,
        "bow": -outputs.f_b * controls.v_b,
        "hammer": controls.f_hammer * float(np.sum(after.q - before.q_prev)) / two_k,
        "pluck": sum(plucked) / two_k,
    }
    return {**parts, "total": sum(parts.values())}


def losses(
    params: RefParams, before: RefState, after: RefState, outputs: RefOutputs, controls: RefControls
) -> dict[str, float]:
    """q^n by name, in watts: (56b)-(56e), and what the resets throw away."""
    k = params.k
    z, Psi = after_resets(params, before, controls)
    q_s = 0.0
    for i, string in enumerate(params.strings):  # (56b)
        v = (after.u[i] - before.u_prev[i])[1:-1] / (2.0 * k)
        slope = D_minus(string) @ v
        loss = float((string.sigma_0 + string.felt) * v @ v) + string.sigma_1 * float(slope @ slope)
        q_s += 2.0 * string.rho * string.A * string.h * loss
    v_q = (after.q - before.q_prev) / (2.0 * k)
    v_zeta = (after.zeta - before.zeta_prev) / (2.0 * k)
    # (56c), the same I_f^n at n+1 and n-1
    eta_next = finger_readings(params, after.u, after.U, controls.x_f)
    eta_prev = finger_readings(params, before.u_prev, before.U_prev, controls.x_f)
    v_eta = (eta_next - eta_prev) / (2.0 * k)
    # (56e), v_r from the grid; the bristle's energy starts from z after its reset
    v_r = v_r_on_grid(params, before, after, controls)
    stored = params.eps0 * np.sum((after.z + z) / 2.0 * (after.z - z) / k)
    return {
        "string": q_s,
        "bridge": float(np.sum(params.R * v_q**2)),
        "finger": float(np.sum(params.beta * outputs.g * Psi * v_eta**2)),
        "hair": float(params.R_h * np.sum(v_zeta**2)),
        "friction": float(outputs.f_b * v_r - stored),
        "reset_z": float(params.eps0 * np.sum(before.z**2 - z**2) / (2.0 * k)),
        "reset_Psi": float(np.sum(before.Psi**2 - Psi**2) / (2.0 * k)),
    }


def ledger(
    params: RefParams, before: RefState, after: RefState, outputs: RefOutputs, controls: RefControls
) -> dict[str, float]:
    """h_before, h_after (J), p, every q_<name> and error = (h_after - h_before)/k - p + sum q (W).

    (54). `before` and `after` are the states on the two sides of one `step`.
    """
    h_before, h_after = energy(params, before)["total"], energy(params, after)["total"]
    p = power(params, before, after, outputs, controls)["total"]
    q = losses(params, before, after, outputs, controls)
    error = (h_after - h_before) / params.k - p + sum(q.values())
    named = {f"q_{name}": value for name, value in q.items()}
    return {"h_before": h_before, "h_after": h_after, "p": p, **named, "error": error}
