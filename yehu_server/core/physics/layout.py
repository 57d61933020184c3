"""Where the model's coefficients and state live in memory.

One record each, with room for the largest grid, so that every sample rate runs the
same compiled code and a single address reaches everything. MODEL is written once
per sample rate; STATE is what a step changes: ``motion`` is the state of the instrument,
``contacts`` is where bow and fingers touch the strings, ``work`` holds the intermediate results of
one step. An instrument at rest is all zeros except for the fingers' heights. docs/notation.md
has each field's symbol, unit and equation.

Indices are unsigned: a negative one costs a comparison at every use, and keeps loops from
becoming vectors.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import IS_PLAIN, compiled
from yehu_server.compile.memory import with_attributes
from yehu_server.core.physics.fixed_power import TABLES

STRINGS = 2
MAX_INTERVALS = 512  # of one string's grid; 0.38 m of silk at 192 kHz take about 130
GHOST = 1  # points before l = 0, so that the stencil of D4 needs no special case
VECTOR = 8  # numbers worked on at once: two vectors of AVX2, one of AVX-512
POINTS = MAX_INTERVALS + 2 * VECTOR
LEVELS = 3  # u[n+1], u[n], u[n-1], taking turns
MAX_MODES = 64
MAX_TWISTS = 16  # torsional modes of a string
MAX_SECTIONS, USUAL_SECTIONS = 64, 32  # most bodies need no more than the usual
MAX_TAPS = 12
MAX_FINGERS = 4
STENCIL = 4  # nodes that one contact touches (cubic interpolation)
MAX_POINTS = 4  # across the width of the hair
BOW = MAX_FINGERS * STRINGS  # finger j on string i is contact 2 j + i
POINT = BOW + 1  # the first of the points across the width
MAX_CONTACTS = POINT + MAX_POINTS
HEAT_COUNT = 256  # of the table of friction over temperature
LINE_BYTES = 64  # of the processor's cache: vectors within one are read and written at once


def lined_up(fields: list[Any]) -> np.dtype[Any]:
    """A record whose nested records, and first nodes of strings, begin cache lines, if it does."""
    kinds = {name: kind for name, (kind, *_) in (np.dtype(fields, align=True).fields or {}).items()}
    offsets, end = [], 0
    for kind in kinds.values():
        unit, ahead = kind.alignment, 0
        if kind.shape[-1:] == (POINTS,):
            unit, ahead = LINE_BYTES, (GHOST + 1) * kind.base.itemsize
        elif kind.names:
            unit = LINE_BYTES
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
    return room[start : start + kind.itemsize].view(with_attributes(kind) if IS_PLAIN else kind)


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
        ("inside", np.float64, (STRINGS, POINTS)),
        ("held", np.float64, (STRINGS, POINTS)),
        ("rho_A", np.float64, STRINGS),
        ("T", np.float64, STRINGS),
        ("EI", np.float64, STRINGS),
        ("sigma_0", np.float64, STRINGS),
        ("sigma_1", np.float64, STRINGS),
        ("stretch_stiffness", np.float64, STRINGS),
        ("tension_gain", np.float64, STRINGS),
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
        ("bristle_stiffness", np.float64),
        ("per_v_s", np.float64),
        ("chi_slope", np.float64, STRINGS),
        ("M_h", np.float64),
        ("K_h", np.float64),
        ("R_h", np.float64),
        ("A_h", np.float64),
        ("B_h", np.float64),
        ("C_h", np.float64),
        # the hair's texture
        ("hair", np.int64),
        ("per_grain", np.float64),
        # the contact's temperature
        ("is_thermal", np.uint8),
        ("softened", np.float64, HEAT_COUNT),
        ("per_heat", np.float64),
        ("cooled", np.float64),
        # finger, eqs. (33)-(36)
        ("M_f", np.float64),
        ("C_f", np.float64),
        ("K_f", np.float64),
        ("beta", np.float64),
        ("rest_height", np.float64),
        ("K_lift", np.float64),
        ("R_lift", np.float64),
        # radiation
        ("sections", np.uint8),
        ("b_0", np.float64, MAX_SECTIONS),
        ("b_1", np.float64, MAX_SECTIONS),
        ("a_1", np.float64, MAX_SECTIONS),
        ("a_2", np.float64, MAX_SECTIONS),
        ("taps", np.float64, MAX_TAPS),
        ("last_tap", np.int64),
        # ghat of eq. (33), a power of the penetration
        ("ghat", TABLES),
    ]
)

MOTION = lined_up(
    [
        ("level", np.uint8),  # which of the LEVELS is "now"
        ("u", np.float64, (LEVELS, STRINGS, POINTS)),
        ("Delta_u", np.float64, (STRINGS, POINTS)),
        ("q", np.float64, (LEVELS, MAX_MODES)),
        ("zeta", np.float64, (LEVELS, STRINGS)),
        ("z", np.float64, STRINGS),
        ("w", np.float64, STRINGS),
        ("grain", np.int64),  # where `rough` is the texture at either end; one more than its number
        ("rough", np.float64, 2),
        ("f_b", np.float64),
        ("v_r", np.float64),
        ("tangent", np.float64, 3),
        ("U", np.float64, (LEVELS, MAX_FINGERS)),
        ("Psi", np.float64, MAX_CONTACTS),
        ("resting", np.uint8, MAX_FINGERS),
        # radiation filter
        ("s_1", np.float64, MAX_SECTIONS),
        ("s_2", np.float64, MAX_SECTIONS),
        ("history", np.float64, MAX_TAPS),
    ]
)

CONTACTS = lined_up(
    [
        ("placed", np.int64),
        ("x", np.float64, MAX_CONTACTS),
        ("string", np.uint8, MAX_CONTACTS),
        ("first", np.uint16, MAX_CONTACTS),
        ("weights", np.float64, (MAX_CONTACTS, STENCIL)),
        ("self_compliance", np.float64, MAX_CONTACTS),
        ("bridge_coupling", np.float64, MAX_CONTACTS),
        # fingers: from the loop to the bridge, and those of them that may touch a string
        ("order", np.uint8, MAX_FINGERS),
        ("candidates", np.uint8, MAX_FINGERS),
        ("candidate_bits", np.int64),
        ("is_chain", np.uint8),
        ("meets_previous", np.uint8, MAX_FINGERS),
        ("previous_coupling", np.float64, (MAX_FINGERS, STRINGS)),
        # where a string is plucked
        ("x_pluck", np.float64),
        ("pluck_string", np.uint8),
        ("pluck_first", np.uint16),
        ("pluck_weights", np.float64, STENCIL),
    ]
)

WORK = lined_up(
    [
        # tension and bridge
        ("Delta_u_squared", np.float64, STRINGS),
        ("Delta_u_travel", np.float64, STRINGS),
        ("Delta_u_at", np.float64, MAX_CONTACTS),
        ("K_cc", np.float64, (STRINGS, STRINGS)),
        ("K_tc", np.float64, (STRINGS, STRINGS)),
        ("K_tt", np.float64, (STRINGS, STRINGS)),
        ("tau", np.float64, STRINGS),
        ("f_c", np.float64, STRINGS),
        ("tau_per_newton", np.float64, STRINGS),
        ("f_c_per_newton", np.float64, STRINGS),
        # fingers
        ("f_ext", np.float64, MAX_FINGERS),
        ("ghat", np.float64, MAX_CONTACTS),
        ("g", np.float64, MAX_CONTACTS),
        ("eta_prev", np.float64, MAX_CONTACTS),
        ("travel", np.float64, MAX_CONTACTS),
        ("bow_compliance", np.float64, MAX_CONTACTS),
        ("f_f", np.float64, MAX_CONTACTS),
        # fingers eliminated as a chain
        ("W", np.float64, (MAX_FINGERS, 3)),
        ("f_0", np.float64, MAX_CONTACTS),
        ("Delta_u_chain", np.float64, (MAX_FINGERS, STRINGS, STRINGS)),
        ("tau_fingers", np.float64, STRINGS),
        # contacts eliminated jointly
        ("touching", np.uint8, MAX_CONTACTS),
        ("touching_count", np.int64),
        ("A_f", np.float64, MAX_CONTACTS),
        ("d", np.float64, MAX_CONTACTS),
        ("G", np.float64, (MAX_CONTACTS, MAX_CONTACTS)),
        # for probes and the ledger
        ("bridge_travel", np.float64),
        ("z_bar", np.float64),
        ("r", np.float64),
        ("F_N", np.float64),
        ("mu_S", np.float64),
        ("iterations", np.int64),
        ("dropped_z", np.float64),
        ("dropped_Psi", np.float64),
    ]
)

STATE = lined_up(
    [
        ("motion", MOTION),
        ("contacts", CONTACTS),
        ("work", WORK),
        # counters, which outlive a lost state
        ("unconverged", np.int64),
        ("lost", np.int64),
    ]
)

# What only an instrument with torsion, hair of some width or another friction has (refined.py).
REFINED = lined_up(
    [
        # another law of friction
        ("is_hyperbolic", np.uint8),
        ("epsilon_2", np.float64),
        # width of the hair
        ("points", np.int64),
        ("share", np.float64),
        ("offset", np.float64, MAX_POINTS),
        # torsion
        ("twists", np.int64),
        ("M_t", np.float64, (STRINGS, MAX_TWISTS)),
        ("K_t", np.float64, (STRINGS, MAX_TWISTS)),
        ("R_t", np.float64, (STRINGS, MAX_TWISTS)),
        ("A_t", np.float64, (STRINGS, MAX_TWISTS)),
        ("B_t", np.float64, (STRINGS, MAX_TWISTS)),
        ("C_t", np.float64, (STRINGS, MAX_TWISTS)),
        ("R_skin", np.float64),
        # motion
        ("zeta", np.float64, (LEVELS, MAX_POINTS, STRINGS)),
        ("z", np.float64, (MAX_POINTS, STRINGS)),
        ("w", np.float64, (MAX_POINTS, STRINGS)),
        ("f_b", np.float64, MAX_POINTS),
        ("v_r", np.float64, MAX_POINTS),
        ("tangent", np.float64, (MAX_POINTS, 3)),
        ("twist", np.float64, (LEVELS, STRINGS, MAX_TWISTS)),
        # shapes of the torsional modes under a finger on each string, and under each point
        ("twist_x", np.float64, STRINGS + MAX_POINTS),
        ("twist_shapes", np.float64, (STRINGS + MAX_POINTS, MAX_TWISTS)),
        # intermediate results of one step
        ("responses", np.float64, (MAX_POINTS, 2 * STRINGS)),
        ("free", np.float64, MAX_POINTS),
        ("mobility", np.float64, (MAX_POINTS, MAX_POINTS)),
        ("stiffness", np.float64, (MAX_POINTS, MAX_POINTS)),
        ("newton", np.float64, (MAX_POINTS, MAX_POINTS + 1)),
        ("v_kept", np.float64, MAX_POINTS),
        ("slope", np.float64, MAX_POINTS),
        ("mu_S", np.float64, MAX_POINTS),
        ("z_bar", np.float64, MAX_POINTS),
        ("r", np.float64, MAX_POINTS),
        ("skin_drag", np.float64, STRINGS),
        ("twist_per_newton", np.float64, (MAX_POINTS, MAX_TWISTS)),
    ]
)

# Columns of the controls, one row a sample. Fingers follow in pairs (x_f, press).
F_N, V_B, X_B, Y_B, TEXTURE, F_HAMMER, F_PLUCK, X_PLUCK, FINGER_CONTROLS = range(9)
CONTROLS_PER_FINGER = 2


def control_columns(fingers: int) -> int:
    """Columns of the control array of an instrument with a number of fingers."""
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
    """Columns of the probe array of an instrument with a number of fingers."""
    return FINGER_PROBES + PROBES_PER_FINGER * fingers


@compiled
def padded_length(count: int) -> int:
    """Round a count up to whole vectors.

    A loop over the numbers left over, one by one, costs as much as the loop over vectors.
    """
    return int((np.int64(count) + VECTOR - 1) & -VECTOR)


# Columns of the energy ledger, by name and by number: J, then W, then residuals (m/s, m and W).
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
    "friction_residual",
)
(
    ENERGY,
    POWER_IN,
    LOSS_STRINGS,
    LOSS_BRIDGE,
    LOSS_FINGER,
    LOSS_HAIR,
    LOSS_FRICTION,
    LOSS_BOW_LIFT,
    LOSS_CONTACT_RESET,
    ENERGY_ERROR,
    V_R_RESIDUAL,
    CONSTRAINT_RESIDUAL,
    FRICTION_RESIDUAL,
) = range(len(LEDGER))
