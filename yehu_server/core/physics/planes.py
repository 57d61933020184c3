"""The strings' second direction: its record, and the bridge that moves in both.

A string moves in the bow's direction, u, and normal to it, v, both by the same equation. Fingers
and hair press along v; friction and the fingers' skin act along u (press.py, skin.py). Tension,
which any motion raises, and the bridge tie both. The bridge as measured, q, moves along the bow. As
it rocks, one string rises and the other sinks, v = +/- rocking q; and it bounces, which takes a
second bank p of the same modes, v = bounce p. So for each string, with r = +/- rocking,

    Y = [1, r; r, r^2 + b^2] Y_measured,

which is passive for any r and b. Both are assumed: one direction has been measured.
Differs: [Yehu] has one direction, in which the finger presses, too.
Source: [Desvages]; [Mansour]. Derivation: docs/derivation.md, section 11.
"""

from typing import Any

import numpy as np

from yehu_server.core.physics import refined
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.fixed_power import TABLES, prepare_power
from yehu_server.core.physics.layout import (
    BOW,
    LEVELS,
    MAX_POINTS,
    MOTION,
    REFINED,
    STENCIL,
    STRINGS,
    WORK,
    lined_up,
    new_record,
)
from yehu_server.core.physics.modal_string import MODAL, prepare_modal
from yehu_server.errors import ParameterError

BOWING, NORMAL = 0, 1  # planes
BRIDGE_ROW = STRINGS  # of the joint system: tensions, then the bridge in both planes
CONTACT_ROW = BRIDGE_ROW + 2 * STRINGS
MAX_ROWS = CONTACT_ROW + 2 * BOW + 1 + MAX_POINTS

# What only an instrument in two directions has. It begins with REFINED, so that a pointer to it is
# one to that, too.
PLANES = lined_up(
    [
        ("refined", REFINED),
        # the second direction: displacements v, modes p, fingers
        ("normal", MOTION),
        ("normal_work", WORK),
        ("rocking", np.float64, STRINGS),
        ("bounce", np.float64),
        # the bow's mass, and its hair's contact normal to the string
        ("M_n", np.float64),
        ("C_n", np.float64),
        ("beta_n", np.float64),
        ("ghat", TABLES),
        ("is_on", np.uint8),
        ("side", np.float64),
        ("Y", np.float64, LEVELS),
        ("Psi", np.float64),
        ("Psi_prev", np.float64),
        ("g", np.float64),
        ("eta_prev", np.float64),
        ("f_ext", np.float64),
        ("F_N", np.float64),
        # the skin of the fingers
        ("K_s", np.float64),
        ("R_s", np.float64),
        ("mu_s", np.float64),
        ("s", np.float64, BOW),
        ("s_bar", np.float64, BOW),
        ("s_rate", np.float64, BOW),
        ("skin_velocity", np.float64, BOW),
        ("skin_force", np.float64, BOW),
        ("Z", np.float64, BOW),
        ("R_now", np.float64, BOW),
        ("yielding", np.float64, BOW),
        # normal forces of the last step
        ("f_n", np.float64, BOW + 1),
        # the joint system
        ("rows", np.int64),
        ("plane", np.uint8, MAX_ROWS),
        ("string", np.uint8, MAX_ROWS),
        ("contact", np.uint8, MAX_ROWS),
        ("first", np.uint16, MAX_ROWS),
        ("weights", np.float64, (MAX_ROWS, STENCIL)),
        ("G", np.float64, (MAX_ROWS, MAX_ROWS)),
        ("D", np.float64, MAX_ROWS),
        ("W", np.float64, MAX_ROWS),
        ("b", np.float64, MAX_ROWS),
        ("x", np.float64, MAX_ROWS),
    ]
)


def prepare(quantities: Quantities, rate: float) -> Any:
    """What an instrument has besides ``kernel.prepare``, at rest: REFINED, PLANES, MODAL, None.

    Raises ParameterError as ``refined.prepare``; where modal strings shall move in two directions,
    or have losses that leave them no frequency.
    """
    if quantities.scheme == "modal":
        if quantities.directions == "two":
            raise ParameterError('scheme: modal strings move in one direction, not "two"')
        modal = new_record(MODAL)
        refined.prepare_into(modal[0]["refined"], quantities, rate)
        prepare_modal(modal[0], quantities, 1.0 / rate)
        return modal
    if quantities.directions == "one":
        return refined.prepare(quantities, rate)
    planes, bow, finger = new_record(PLANES), quantities.bow, quantities.finger
    record = planes[0]
    refined.prepare_into(record["refined"], quantities, rate)
    record["rocking"] = quantities.rocking, -quantities.rocking
    record["bounce"] = quantities.bounce
    record["M_n"], record["C_n"] = bow.M_n, 1.0 / (rate * rate * bow.M_n)
    record["beta_n"] = bow.beta_n
    prepare_power(
        record["ghat"], np.sqrt(0.5 * bow.K_n * (bow.alpha_n + 1.0)), 0.5 * (bow.alpha_n - 1.0)
    )
    record["K_s"], record["R_s"], record["mu_s"] = finger.K_s, finger.R_s, finger.mu_s
    record["normal"]["U"] = finger.rest_height
    return planes
