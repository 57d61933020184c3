"""Where the model's coefficients and state live in memory.

One record each, with room for the largest grid, so that every sample rate runs the
same compiled code and a single address reaches everything. ``model`` is written once
per sample rate; ``state`` is what a step changes, and all zeros but the finger
heights is an instrument at rest. What serves as an index is unsigned: one that might be
negative costs a comparison at every use, and keeps loops from becoming vectors.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled

STRINGS = 2
MAX_NODES = 512  # grid intervals of one string; 0.38 m of silk at 192 kHz takes about 130
GHOST = 1  # points before l = 0, so that the stencil of D4 needs no special case
VECTOR = 8  # numbers worked on at once: two vectors of AVX2, one of AVX-512
POINTS = MAX_NODES + 2 * VECTOR
LEVELS = 3  # u[n+1], u[n], u[n-1], taking turns
MAX_MODES = 16
MAX_SECTIONS = 32
MAX_TAPS = 12
MAX_FINGERS = 4
STENCIL = 4  # nodes that one contact touches (cubic interpolation)
MAX_CONTACTS = MAX_FINGERS * STRINGS + 1  # finger j on string i is contact 2 j + i
BOW = MAX_CONTACTS - 1
# Tables of a power, power.py
EXPONENTS = 2048  # of all floats
INTERVAL_BITS = 7
INTERVALS = 1 << INTERVAL_BITS
POWER_TERMS = 5

LINE_BYTES = 64  # of the processor's cache: vectors within one are read and written at once


def lined_up(fields: list[Any]) -> np.dtype[Any]:
    """A record in which the first node of each string begins a cache line, if the record does."""
    kinds = {name: kind for name, (kind, *_) in (np.dtype(fields, align=True).fields or {}).items()}
    offsets, end = [], 0
    for kind in kinds.values():
        unit, ahead = kind.alignment, 0
        if kind.shape[-1:] == (POINTS,):
            unit, ahead = LINE_BYTES, (GHOST + 1) * kind.base.itemsize
        offsets.append(-(-(end + ahead) // unit) * unit - ahead)
        end = offsets[-1] + kind.itemsize
    return np.dtype(
        {
            "names": list(kinds),
            "formats": list(kinds.values()),
            "offsets": offsets,
            "itemsize": -(-end // LINE_BYTES) * LINE_BYTES,
        },
        align=True,
    )


def new_record(kind: np.dtype[Any]) -> Any:
    """One record, all zeros [shape=(1,)], at the beginning of a cache line."""
    room = np.zeros(kind.itemsize + LINE_BYTES, np.uint8)
    start = -room.ctypes.data % LINE_BYTES
    return room[start : start + kind.itemsize].view(kind)


MODEL = lined_up(
    [
        ("k", np.float64),
        ("rate", np.float64),  # 1 / k
        ("fingers", np.int64),
        # strings, eqs. (32) and (57)
        ("N", np.uint16, STRINGS),
        ("h", np.float64, STRINGS),
        ("B", np.float64, (STRINGS, 3)),
        ("C", np.float64, (STRINGS, 2)),
        ("spread", np.float64, STRINGS),
        ("inside", np.float64, (STRINGS, POINTS)),  # 1 between the ends, 0 there and beyond
        ("rho_A", np.float64, STRINGS),
        ("T", np.float64, STRINGS),
        ("EI", np.float64, STRINGS),
        ("sigma_0", np.float64, STRINGS),
        ("sigma_1", np.float64, STRINGS),
        ("stretch", np.float64, STRINGS),  # EA / (4 L h), tension.py
        ("taut", np.float64, STRINGS),  # the same, in what a string moves by it
        # bridge, eqs. (41)-(45)
        ("bridge_x", np.float64),
        ("bridge_first", np.uint16, STRINGS),
        ("bridge_weights", np.float64, (STRINGS, STENCIL)),
        ("modes", np.uint8),
        ("M_m", np.float64, MAX_MODES),
        ("K_m", np.float64, MAX_MODES),
        ("R_m", np.float64, MAX_MODES),
        ("A_q", np.float64, MAX_MODES),
        ("B_q", np.float64, MAX_MODES),
        ("C_q", np.float64, MAX_MODES),
        ("C_q_sum", np.float64),
        ("S_c", np.float64, (STRINGS, STRINGS)),
        # bow, eqs. (17)-(25) and (60)
        ("epsilon_0", np.float64),
        ("epsilon_1", np.float64),
        ("v_s", np.float64),
        ("mu_C", np.float64),
        ("mu_S", np.float64),
        ("xi", np.float64, STRINGS),
        ("lift_force", np.float64),
        ("stiffness", np.float64),  # epsilon_0 + 2 epsilon_1 / k
        ("per_v_s", np.float64),
        ("sharpness", np.float64, STRINGS),  # friction.py: N, of chi's curve over f_b
        ("M_h", np.float64),
        ("K_h", np.float64),
        ("R_h", np.float64),
        ("A_h", np.float64),
        ("B_h", np.float64),
        ("C_h", np.float64),
        # finger, eqs. (33)-(36)
        ("M_f", np.float64),
        ("C_f", np.float64),
        ("K_f", np.float64),
        ("beta", np.float64),
        ("rest_height", np.float64),
        ("K_lift", np.float64),
        ("R_lift", np.float64),
        # radiation
        ("b_0", np.float64, MAX_SECTIONS),
        ("b_1", np.float64, MAX_SECTIONS),
        ("a_1", np.float64, MAX_SECTIONS),
        ("a_2", np.float64, MAX_SECTIONS),
        ("taps", np.float64, MAX_TAPS),
        ("last_tap", np.int64),
        # ghat of eq. (33), a power of the penetration, by tables (power.py)
        ("power_series", np.float64, POWER_TERMS),
        ("power_of_twos", np.float64, EXPONENTS),
        ("per_middle", np.float64, INTERVALS),
        ("power_of_middle", np.float64, INTERVALS),
    ]
)

STATE = lined_up(
    [
        ("level", np.uint8),  # which of the LEVELS is "now"
        ("u", np.float64, (LEVELS, STRINGS, POINTS)),
        ("q", np.float64, (LEVELS, MAX_MODES)),
        ("zeta", np.float64, (LEVELS, STRINGS)),
        ("z", np.float64, STRINGS),
        ("v_r", np.float64),
        ("U", np.float64, (LEVELS, MAX_FINGERS)),
        ("Psi", np.float64, MAX_CONTACTS),
        # where the contacts are, and how each answers to the others (contacts.py)
        ("placed", np.int64),
        ("x", np.float64, MAX_CONTACTS),
        ("string", np.uint8, MAX_CONTACTS),
        ("first", np.uint16, MAX_CONTACTS),
        ("weights", np.float64, (MAX_CONTACTS, STENCIL)),
        ("yields", np.float64, MAX_CONTACTS),
        ("shared_with_bridge", np.float64, MAX_CONTACTS),
        ("at_bow", np.float64, MAX_CONTACTS),
        # the bridge, and tension modulation (tension.py), in the current step
        ("S_c_inverse", np.float64, (STRINGS, STRINGS)),
        ("bend", np.float64, (STRINGS, POINTS)),  # Delta u^n; as a step begins, Delta u^{n-1}
        ("bend_at", np.float64, MAX_CONTACTS),
        ("square", np.float64, STRINGS),  # <Delta u, Delta u>, and <Delta u, u* + u^{n-1}>
        ("along", np.float64, STRINGS),
        ("slack", np.float64, STRINGS),
        ("give", np.float64, (STRINGS, STRINGS)),
        ("tug", np.float64, (STRINGS, STRINGS)),
        # where a string is pulled aside (pluck.py)
        ("x_pluck", np.float64),
        ("pluck_string", np.uint8),
        ("pluck_first", np.uint16),
        ("pluck_weights", np.float64, STENCIL),
        # forces of the current step, and scratch of the contact solve
        ("f_c", np.float64, STRINGS),
        ("f_b", np.float64),
        ("z_bar", np.float64),
        ("r", np.float64),
        ("tangent", np.float64, 3),
        ("bridge_travel", np.float64),
        ("iterations", np.int64),
        ("f_f", np.float64, MAX_CONTACTS),
        ("f_ext", np.float64, MAX_FINGERS),
        ("order", np.uint8, MAX_FINGERS),  # fingers from the loop to the bridge
        ("still", np.uint8, MAX_FINGERS),  # which are up, out of reach, and have come to rest
        ("near", np.uint8, MAX_FINGERS),  # which may touch, in that order
        ("are_near", np.int64),  # one bit for each
        ("clear", np.uint8),  # whether they meet their neighbours at most,
        ("meets", np.uint8, MAX_FINGERS),  # whether the one before,
        ("shared", np.float64, (MAX_FINGERS, STRINGS)),  # and how far it moves them (m/N)
        ("g", np.float64, MAX_CONTACTS),
        ("ghat", np.float64, MAX_CONTACTS),
        ("eta_prev", np.float64, MAX_CONTACTS),
        ("travel", np.float64, MAX_CONTACTS),
        ("W", np.float64, (MAX_FINGERS, 3)),  # closing.py
        ("slackens", np.float64, (MAX_FINGERS, STRINGS, STRINGS)),
        ("held", np.float64, MAX_CONTACTS),
        ("slackened", np.float64, STRINGS),
        ("slack_per_newton", np.float64, STRINGS),
        ("f_c_per_newton", np.float64, STRINGS),
        ("touching", np.uint8, MAX_CONTACTS),  # contacts of which each feels each
        ("contacts", np.int64),
        ("A_f", np.float64, MAX_CONTACTS),
        ("d", np.float64, MAX_CONTACTS),
        ("G", np.float64, (MAX_CONTACTS, MAX_CONTACTS)),
        # energy given up since the last sample (J), and stored at the last one
        ("dropped_z", np.float64),
        ("dropped_Psi", np.float64),
        ("stored", np.float64),
        # radiation filter
        ("s_1", np.float64, MAX_SECTIONS),
        ("s_2", np.float64, MAX_SECTIONS),
        ("history", np.float64, MAX_TAPS),
        # counters, which outlive a lost state
        ("unconverged", np.int64),
        ("lost", np.int64),
    ]
)

# Columns of the controls, one row a sample. Fingers follow in pairs (x_f, press).
F_N, V_B, X_B, F_HAMMER, F_PLUCK, X_PLUCK, FINGER_CONTROLS = range(7)
CONTROLS_PER_FINGER = 2


def control_columns(fingers: int) -> int:
    """Columns of the control array of an instrument with so many fingers."""
    return FINGER_CONTROLS + CONTROLS_PER_FINGER * fingers


# Columns of the probes. Fingers follow in triples (U, f_f on string 1, f_f on string 2).
(
    BRIDGE_FORCE,
    BRIDGE_FORCE_1,
    BRIDGE_FORCE_2,
    BRIDGE_VELOCITY,
    PRESSURE,
    FRICTION_FORCE,
    RELATIVE_VELOCITY,
    ITERATIONS,
    FINGER_PROBES,
) = range(9)
PROBES_PER_FINGER = 3


def probe_columns(fingers: int) -> int:
    """Columns of the probe array of an instrument with so many fingers."""
    return FINGER_PROBES + PROBES_PER_FINGER * fingers


@compiled
def whole_vectors(count: int) -> int:
    """Room for so many numbers in whole vectors: loops over these leave no single ones over.

    Those that finish a loop over vectors one by one cost as much as all of it.
    """
    return (count + VECTOR - 1) & -VECTOR


# Columns of the energy ledger: J, then W, then two residuals (m/s and m).
LEDGER = (
    "energy",
    "power_in",
    "loss_strings",
    "loss_bridge",
    "loss_finger",
    "loss_hair",
    "loss_friction",
    "loss_bow_lift",
    "loss_contact_reset",
    "energy_error",
    "v_r_residual",
    "constraint_residual",
)
