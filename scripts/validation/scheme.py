"""The explicit scheme and modal strings at some rates, against modal strings at 176.4 kHz."""

from typing import Any

import numpy as np

from validation import convergence, laws
from yehu_lab.regimes.columns import HELMHOLTZ
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of

NOTES = ("A♯4", "G5")  # of convergence.NOTES
RATES = (44100.0, 88200.0)
FINEST = 176400.0  # of modal strings, the reference
EXPLICIT_FINEST = 352800.0
SCHEMES = ("explicit", "modal")
BETA, PERIODS = 0.13, 20
ACCELERATIONS = np.geomspace(0.5, 32.0, 10)


def measure() -> list[dict[str, Any]]:
    """What maps over place and force, and over acceleration and force, are like."""
    rows = []
    for note in NOTES:
        string, pitch = convergence.NOTES[note]

        def bowed(scheme: str, rate: float) -> tuple[Result, Result]:
            changes = convergence.BARE | {"scheme": scheme}
            place = convergence.one(string, pitch, rate, changes)  # noqa: B023
            return place, starts(string, pitch, rate, changes)  # noqa: B023

        reference = bowed("modal", FINEST)
        each = [(scheme, rate) for scheme in SCHEMES for rate in RATES]
        for scheme, rate in sorted([*each, ("explicit", EXPLICIT_FINEST), ("modal", FINEST)]):
            place, start = reference
            if (scheme, rate) != ("modal", FINEST):
                place, start = bowed(scheme, rate)
            rows.append(
                {"note": note, "scheme": scheme, "rate": rate}
                | laws.compared(place, reference[0])
                | started(start, reference[1])
            )
    return rows


def starts(string: int, pitch: float, rate: float, instrument: dict[str, Any]) -> Result:
    """A map over acceleration and force."""
    gesture, bridge_x, length = convergence.stroke(string, pitch, rate, instrument)
    gesture["controls"]["bow_position"] = bridge_x - BETA * length
    forces = convergence.FORCES if string == 1 else -convergence.FORCES
    vary = {"bow_acceleration": ACCELERATIONS.tolist(), "bow_force": forces.tolist()}
    return sweep(study_of({"gesture": gesture, "vary": vary}))


def started(found: Result, reference: Result) -> dict[str, float]:
    """Shares of strokes that begin soon."""
    soon, others = (
        (each.grid("regime") == HELMHOLTZ)
        & (
            (each.grid("helmholtz_s") - each.grid("first_slip_s")) * each.grid("pitch_hz")
            <= PERIODS
        )
        for each in (found, reference)
    )
    return {"soon": float(soon.mean()), "same_soon": float((soon == others).mean())}
