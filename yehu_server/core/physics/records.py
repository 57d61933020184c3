"""Types of the model's records; written by scripts/generate from layout.py.

In compiled code a record of an array of layout.MODEL, layout.STATE, layout.REFINED,
planes.PLANES or modal_string.MODAL has these attributes.
docs/notation.md has their symbols and units.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Records = NDArray[np.void]  # of layout.MODEL or layout.STATE


class Tables(Protocol):
    """Tables of one power, power.py."""

    series: Array
    of_exponent: Array
    per_midpoint: Array
    of_midpoint: Array


class Model(Protocol):
    """Coefficients of one sample rate."""

    k: float
    rate: float
    fingers: int
    N: NDArray[np.uint16]
    h: Array
    B: Array
    C: Array
    spread: Array
    inside: Array
    held: Array
    rho_A: Array
    T: Array
    EI: Array
    sigma_0: Array
    sigma_1: Array
    stretch_stiffness: Array
    tension_gain: Array
    bridge_x: float
    bridge_first: NDArray[np.uint16]
    bridge_weights: Array
    modes: int
    M_m: Array
    K_m: Array
    R_m: Array
    A_q: Array
    B_q: Array
    C_q: Array
    C_q_sum: float
    S_c: Array
    epsilon_0: float
    epsilon_1: float
    v_s: float
    mu_C: float
    mu_S: float
    xi: Array
    lift_force: float
    bristle_stiffness: float
    per_v_s: float
    chi_slope: Array
    M_h: float
    K_h: float
    R_h: float
    A_h: float
    B_h: float
    C_h: float
    hair: int
    per_grain: float
    is_thermal: int
    softened: Array
    per_heat: float
    cooled: float
    M_f: float
    C_f: float
    K_f: float
    beta: float
    rest_height: float
    K_lift: float
    R_lift: float
    sections: int
    b_0: Array
    b_1: Array
    a_1: Array
    a_2: Array
    taps: Array
    last_tap: int
    ghat: Tables


class Motion(Protocol):
    """The state of the instrument."""

    level: int
    u: Array
    Delta_u: Array
    q: Array
    zeta: Array
    z: Array
    w: Array
    grain: int
    rough: Array
    f_b: float
    v_r: float
    tangent: Array
    U: Array
    Psi: Array
    resting: NDArray[np.uint8]
    s_1: Array
    s_2: Array
    history: Array


class Contacts(Protocol):
    """Where bow and fingers touch the strings."""

    placed: int
    x: Array
    string: NDArray[np.uint8]
    first: NDArray[np.uint16]
    weights: Array
    self_compliance: Array
    bridge_coupling: Array
    order: NDArray[np.uint8]
    candidates: NDArray[np.uint8]
    candidate_bits: int
    is_chain: int
    meets_previous: NDArray[np.uint8]
    previous_coupling: Array
    x_pluck: float
    pluck_string: int
    pluck_first: int
    pluck_weights: Array


class Work(Protocol):
    """Intermediate results of one step."""

    Delta_u_squared: Array
    Delta_u_travel: Array
    Delta_u_at: Array
    K_cc: Array
    K_tc: Array
    K_tt: Array
    tau: Array
    f_c: Array
    tau_per_newton: Array
    f_c_per_newton: Array
    f_ext: Array
    ghat: Array
    g: Array
    eta_prev: Array
    travel: Array
    bow_compliance: Array
    f_f: Array
    W: Array
    f_0: Array
    Delta_u_chain: Array
    tau_fingers: Array
    touching: NDArray[np.uint8]
    touching_count: int
    A_f: Array
    d: Array
    G: Array
    bridge_travel: float
    z_bar: float
    r: float
    F_N: float
    mu_S: float
    iterations: int
    dropped_z: float
    dropped_Psi: float


class State(Protocol):
    """All that a step changes."""

    motion: Motion
    contacts: Contacts
    work: Work
    unconverged: int
    lost: int


class Refined(Protocol):
    """What an instrument with torsion, or with wide hair, has besides."""

    is_hyperbolic: int
    epsilon_2: float
    points: int
    share: float
    offset: Array
    twists: int
    M_t: Array
    K_t: Array
    R_t: Array
    A_t: Array
    B_t: Array
    C_t: Array
    R_skin: float
    zeta: Array
    z: Array
    w: Array
    f_b: Array
    v_r: Array
    tangent: Array
    twist: Array
    twist_x: Array
    twist_shapes: Array
    responses: Array
    free: Array
    mobility: Array
    stiffness: Array
    newton: Array
    v_kept: Array
    slope: Array
    mu_S: Array
    z_bar: Array
    r: Array
    skin_drag: Array
    twist_per_newton: Array


class Planes(Protocol):
    """What an instrument in two directions has besides."""

    refined: Refined
    normal: Motion
    normal_work: Work
    rocking: Array
    bounce: float
    M_n: float
    C_n: float
    beta_n: float
    ghat: Tables
    is_on: int
    side: float
    Y: Array
    Psi: float
    Psi_prev: float
    g: float
    eta_prev: float
    f_ext: float
    F_N: float
    K_s: float
    R_s: float
    mu_s: float
    s: Array
    s_bar: Array
    s_rate: Array
    skin_velocity: Array
    skin_force: Array
    Z: Array
    R_now: Array
    yielding: Array
    f_n: Array
    rows: int
    plane: NDArray[np.uint8]
    string: NDArray[np.uint8]
    contact: NDArray[np.uint8]
    first: NDArray[np.uint16]
    weights: Array
    G: Array
    D: Array
    W: Array
    b: Array
    x: Array


class Modal(Protocol):
    """What an instrument of modal strings has besides."""

    refined: Refined
    partials: int
    L: Array
    A_s: Array
    B_s: Array
    C_s: Array
    M_s: Array
    K_s: Array
    R_s: Array
    bend: Array
    stretch_stiffness: Array
    R_felt: Array
    M_w: Array
    K_w: Array
    R_w: Array
    A_w: Array
    B_w: Array
    C_w: Array
    a: Array
    w: Array
    Delta: Array
    x_slot: Array
    string: NDArray[np.uint8]
    shapes: Array
    compliance: Array
    rows: int
    slot: NDArray[np.uint8]
    G: Array
    D: Array
    W: Array
    b: Array
    x: Array
