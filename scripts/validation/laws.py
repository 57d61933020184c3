"""The same strokes with other laws of friction, and what their maps are like."""

from typing import Any

import numpy as np

from validation import convergence
from yehu_lab.regimes.columns import HELMHOLTZ, REGIMES
from yehu_lab.sweeps.result import Result
from yehu_server.scores.gesture import gesture_from
from yehu_server.simulation.run import simulate

RATE = 176400.0
NOTES = ("A♯4", "G5")  # of convergence.NOTES
LAWS: dict[str, dict[str, Any]] = {  # [bow] of the instrument
    "elasto-plastic, [Yehu]": {},
    "elasto-plastic, [Matusiak]": {"epsilon_0": 3.186e5, "xi": [0.7, 0.7]},
    "elasto-plastic, [Willemsen]": {
        "epsilon_0": 1e4, "epsilon_1": 0.1, "epsilon_2": 0.4, "v_s": 0.1, "mu_C": 0.3, "mu_S": 0.8,
        "xi": [0.7, 0.7],
    },
    "the same, not viscous": {
        "epsilon_0": 1e4, "epsilon_1": 0.1, "v_s": 0.1, "mu_C": 0.3, "mu_S": 0.8, "xi": [0.7, 0.7],
    },
    "hyperbolic": {"friction": "hyperbolic"},
    "thermal": {"friction": "thermal"},
}  # fmt: skip
BETA, FORCE, SECONDS = 0.13, 0.5, 0.35  # of the stroke that is drawn


def measure() -> list[dict[str, Any]]:
    """What the maps of some notes are like with each law."""
    rows = []
    for note in NOTES:
        string, pitch = convergence.NOTES[note]
        maps = {
            law: convergence.one(string, pitch, RATE, {"bow": bow}) for law, bow in LAWS.items()
        }
        plain = next(iter(maps.values()))
        rows += [{"note": note, "law": law} | compared(each, plain) for law, each in maps.items()]
    return rows


def compared(found: Result, plain: Result) -> dict[str, float]:
    """What a map says, and how far it is from that of the law that the instrument has."""
    regimes, others = found.grid("regime"), plain.grid("regime")
    cells = regimes == HELMHOLTZ
    both = cells & (others == HELMHOLTZ)
    pitch = found.grid("pitch_hz")
    cents = 1200.0 * np.log2(pitch / plain.grid("pitch_hz"))[both]
    brighter = (found.grid("brightness_hz") / plain.grid("brightness_hz"))[both]
    column = int(np.abs(np.log(convergence.BETAS / BETA)).argmin())  # of the places of the bow
    forces, flatter = convergence.FORCES[cells[column]], pitch[column][cells[column]]
    if len(forces) == 0:
        forces = flatter = np.array([np.nan])
    onset = (found.grid("helmholtz_s") - found.grid("first_slip_s"))[cells]
    return {
        "helmholtz": float(cells.mean()),
        "aperiodic": float((regimes == REGIMES.index("aperiodic")).mean()),
        "same": float((regimes == others).mean()),
        "least": float(forces[0]),
        "greatest": float(forces[-1]),
        "cents": float(np.median(cents)) if both.any() else np.nan,
        "flatter": float(1200.0 * np.log2(flatter[-1] / flatter.max())),
        "brighter": float(np.median(brighter)) if both.any() else np.nan,
        "onset_ms": 1e3 * float(np.nanmedian(onset)) if cells.any() else np.nan,
    }


def stroke(law: str) -> dict[str, Any]:
    """Relative velocity (m/s) and friction coefficient of a stroke on the first note."""
    string, pitch = convergence.NOTES[NOTES[0]]
    data, bridge_x, length = convergence.stroke(string, pitch, RATE, {"bow": LAWS[law]})
    data["duration"] = SECONDS
    data["controls"] |= {"bow_position": bridge_x - BETA * length, "bow_force": FORCE}
    arrays = simulate(gesture_from(data)).arrays
    return {
        "time": arrays["time"],
        "relative_velocity": arrays["relative_velocity"],
        "coefficient": arrays["friction_force"] / FORCE,
    }
