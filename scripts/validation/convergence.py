"""What changes with the sample rate, with the grid at one rate, and with the hair's seed."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from yehu_lab.regimes.columns import HELMHOLTZ, REGIMES
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_server.core.physics.default_quantities import Quantities

RATES = (44100.0, 88200.0, 176400.0, 352800.0)
HEADROOMS = (1.0, 1.1, 1.15)  # other numbers of nodes, and the same physics
SEEDS = (1, 2, 3)
NOISE = 0.025  # of the hair, as the player's bow has it
BARE: dict[str, Any] = {"felt_loss": 0.0}  # no felt behind the bridge, as in [Yehu]
SOFT = 1.0 / 8.0  # of the bristles' stiffness: what 352.8 kHz has at 44.1 kHz
SPEED = 0.2
BETAS = np.geomspace(0.05, 0.3, 10)
FORCES = np.geomspace(0.06, 3.0, 12)
# String, MIDI note; of an open string no finger.
NOTES = {"F4, open": (1, 65.0), "A♯4": (1, 70.0), "E5": (1, 76.0), "G5": (2, 79.0)}
SOUNDING = 1.02  # of an ideal string's length: a stopped string sounds flat of it


def maps(note: str) -> dict[str, Result]:
    """Maps of one note: by rate, by grid, by seed, with soft bristles."""
    string, pitch = NOTES[note]
    found = {f"rate {rate:g}": one(string, pitch, rate, BARE) for rate in RATES}
    for headroom in HEADROOMS:
        other = BARE | {"tension_headroom": headroom}
        found[f"grid {headroom:g}"] = one(string, pitch, RATES[0], other)
    for seed in SEEDS:
        hair = BARE | {"bow": {"hair": seed}}
        found[f"seed {seed}"] = one(string, pitch, RATES[0], hair, noise=NOISE)
    for rate in (RATES[0], RATES[-1]):
        soft = BARE | {"bow": {"epsilon_0": SOFT * Quantities().bow.epsilon_0}}
        found[f"soft {rate:g}"] = one(string, pitch, rate, soft)
    return found


def one(
    string: int,
    pitch: float,
    rate: float,
    instrument: Mapping[str, Any] | None = None,
    noise: float = 0.0,
) -> Result:
    """A map over bow position and force."""
    gesture, bridge_x, length = stroke(string, pitch, rate, instrument, noise)
    sign = 1.0 if string == 1 else -1.0
    vary = {
        "bow_position": (bridge_x - BETAS * length).tolist(),
        "bow_force": (sign * FORCES).tolist(),
    }
    return sweep(study_of({"gesture": gesture, "vary": vary}))


def stroke(
    string: int,
    pitch: float,
    rate: float,
    instrument: Mapping[str, Any] | None = None,
    noise: float = 0.0,
    speed: float = SPEED,
) -> tuple[dict[str, Any], float, float]:
    """A gesture without force and place of the bow; where the bridge is, and the length (m)."""
    quantities = Quantities()
    own = quantities.strings[string - 1]
    hertz = 440.0 * 2.0 ** ((pitch - 69.0) / 12.0)
    sounding = SOUNDING * math.sqrt(own.T / own.rho_A) / (2.0 * hertz)
    is_open = pitch == 65.0
    finger = 0.05 if is_open else quantities.bridge_x - sounding
    length = quantities.bridge_x if is_open else sounding
    controls = {
        "bow_velocity": [[0.0, 0.0], [0.02, speed]],
        "finger_position": finger,
        "press_force": 0.0 if is_open else 1.5,
        "bow_noise": noise,
    }
    gesture = {
        "sample_rate": rate,
        "duration": 0.35,
        "instrument": dict(instrument or {}),
        "controls": controls,
    }
    return gesture, quantities.bridge_x, length


def compared(found: Mapping[str, Result]) -> list[dict[str, Any]]:
    """Shares of regimes, pitch and onset of each map; and how alike it is to the finest."""
    finest = found[f"rate {RATES[-1]:g}"]
    plain = found[f"rate {RATES[0]:g}"]
    rows = []
    for name, each in found.items():
        against = plain if name.startswith(("grid", "seed")) else finest
        if name.startswith("soft"):
            against = found[f"soft {RATES[-1]:g}"]
        regimes, others = each.grid("regime"), against.grid("regime")
        both = (regimes == HELMHOLTZ) & (others == HELMHOLTZ)
        cents = 1200.0 * np.log2(each.grid("pitch_hz") / against.grid("pitch_hz"))[both]
        later = 1e3 * (_onset_s(each) - _onset_s(against))[both]
        later = later[np.isfinite(later)]
        rows.append(
            {
                "map": name,
                "helmholtz": float((regimes == HELMHOLTZ).mean()),
                "aperiodic": float((regimes == REGIMES.index("aperiodic")).mean()),
                "same": float((regimes == others).mean()),
                "cents": float(np.median(cents)),
                "cents_90": float(np.percentile(np.abs(cents), 90.0)),
                "onset_ms": float(np.median(later)),
                "onset_ms_90": float(np.percentile(np.abs(later), 90.0)),
            }
        )
    return rows


def _onset_s(found: Result) -> Any:
    """From the first slip to lasting Helmholtz motion (s)."""
    return found.grid("helmholtz_s") - found.grid("first_slip_s")
