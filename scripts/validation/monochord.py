"""Strokes of a robot on a cello's G string between rigid ends, and the same strokes here.

A. Lampis, A. Mayer and V. Chatziioannou bowed four G strings at β = 5.5/70, from rest with a
constant force and a constant acceleration, some 5,900 times each session [Lampis]; the raw data are
open (Zenodo 13374477, 17749110, CC BY 4.0), but were not had here. `MEASURED` is what others found
in them by the authors' own classifier: the force by which a stroke of an acceleration succeeds,
as a line, and the share of strokes that do. The string is their string A ([Lampis], table 1); hair
and friction are those of [YehuData], which are [Matusiak]'s but for bristles a tenth as stiff.
"""

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from yehu_lab.regimes.columns import HELMHOLTZ
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_server.core.physics.default_quantities import BODY_FILE

Floats = np.ndarray[Any, np.dtype[np.float64]]

LENGTH, STUB, RADIUS, MASS = 0.70, 0.02, 5e-4, 7.721e-3  # m, m, m, kg/m
TENSION, STIFFNESS = 145.31, 3.03e-4  # N, N m^2
SIGMA_0, SIGMA_1 = 0.166, 0.0024  # loss factors of 3.5e-4 at 98 Hz and 5.4e-4 at 1 kHz
TWIST_SPEED, Q_T = 755.0, 50.0  # m/s: 5.5 times as high as 98 Hz, as Mores measured one
HERTZ, BETA = 98.0, 5.5 / 70.0
RIGID = 1e6  # kg/s
FORCES, ACCELERATIONS = np.linspace(0.1, 4.2, 16), np.linspace(0.15, 3.2, 16)
DURATION_S, FASTEST = 0.6, 0.7  # s, m/s
SOON = 20  # periods after the first slip: a stroke that is Helmholtz motion by then succeeds
SCHELLENG_BETA, SPEEDS = 0.1, (0.05, 0.1, 0.2)
SWEPT = np.geomspace(0.08, 5.0, 28)


@dataclass(frozen=True)
class Wedge:
    """Strokes that succeed: force (N) over acceleration, slope (kg) and at zero (N), and share."""

    slope: float
    at_zero: float
    share: float


MEASURED = {
    "A": Wedge(1.63, 0.92, 0.22),
    "B": Wedge(0.97, 1.00, 0.40),
    "C": Wedge(1.06, 0.38, 0.43),
    "D": Wedge(0.91, 1.28, 0.30),
}
# At beta = 0.1 on string A: least force (N) at each of SPEEDS, and the greatest at the second.
MEASURED_LEAST, MEASURED_GREATEST = (0.21, 0.31, 0.76), 1.89

HAIR: dict[str, dict[str, Any]] = {
    "one point": {},
    "10 mm of hair": {"bow": {"width": 0.01, "points": 4}},
    "torsion": {"torsion": "on"},
    "torsion, bristles four times as stiff": {"torsion": "on", "bow": {"epsilon_0": 1.274e5}},
    "torsion, ten times": {"torsion": "on", "bow": {"epsilon_0": 3.186e5}},
    "thermal": {"bow": {"friction": "thermal"}},
    "no bristles": {"bow": {"friction": "hyperbolic"}},
}


def measure() -> dict[str, Any]:
    """Both diagrams by each hair and law."""
    with TemporaryDirectory() as folder:
        body = Path(folder) / "rigid.json"
        body.write_text(json.dumps(rigid_ends()), "utf-8")
        return {
            name: {"wedge": asdict(wedge(body, each)), "helmholtz": steady(body, each)}
            for name, each in HAIR.items()
        }


def rigid_ends() -> dict[str, Any]:
    """A body that is one heavy dashpot."""
    body: dict[str, Any] = json.loads(BODY_FILE.read_text("utf-8"))
    mass = 0.02 * RIGID / (2.0 * math.pi * 1e3)
    mode = {"frequency_hz": 1e3, "mass_kg": mass, "damping_kg_per_s": RIGID}
    return body | {"bridge_modes": [mode]}


def instrument(body: Path, changes: dict[str, Any]) -> dict[str, Any]:
    """The monochord: its string is string 1, beside one that hardly weighs."""
    density = MASS / (math.pi * RADIUS**2)
    string = {"L": LENGTH + STUB, "r": RADIUS, "rho": density, "T": TENSION}
    string |= {"E": 4.0 * STIFFNESS / (math.pi * RADIUS**4)}
    string |= {"sigma_0": SIGMA_0, "sigma_1": SIGMA_1, "G": density * TWIST_SPEED**2, "Q_t": Q_T}
    other = {"L": LENGTH + STUB, "r": 1e-4, "T": 2.0, "E": 0.0, "sigma_0": 100.0}
    bare = {"tension_modulation": 0.0, "tension_headroom": 1.0, "felt_loss": 0.0}
    strings = {"string_1": string, "string_2": other, "bridge_x": LENGTH, "body": str(body)}
    return bare | strings | changes


def wedge(body: Path, changes: dict[str, Any]) -> Wedge:
    """Guettler's wedge: the fastest acceleration by which each force succeeds, as a line."""
    controls = {"bow_velocity": FASTEST, "bow_position": LENGTH * (1.0 - BETA)}
    vary = {"bow_acceleration": ACCELERATIONS.tolist(), "bow_force": FORCES.tolist()}
    found = sweep(study_of({"gesture": gesture(body, changes, controls, DURATION_S), "vary": vary}))
    periods = (found.grid("helmholtz_s") - found.grid("first_slip_s")) * HERTZ
    return wedge_of((found.grid("regime") == HELMHOLTZ) & (periods < SOON))


def wedge_of(succeeds: Any) -> Wedge:
    """The wedge of a map [shape=(accelerations, forces)]."""
    any_of = succeeds.any(axis=0)
    fastest = np.array([ACCELERATIONS[each].max() for each in succeeds.T[any_of]])
    slope, at_zero = np.polyfit(fastest, FORCES[any_of], 1)
    return Wedge(float(slope), float(at_zero), float(succeeds.mean()))


def steady(body: Path, changes: dict[str, Any]) -> list[str]:
    """Whether each force of SWEPT ends in Helmholtz motion (#), at each speed."""
    rows = []
    for speed in SPEEDS:
        controls = {
            "bow_velocity": [[0.0, 0.0], [speed, speed]],  # at 1 m/s^2
            "bow_position": LENGTH * (1.0 - SCHELLENG_BETA),
        }
        data = gesture(body, changes, controls, 1.2)
        found = sweep(study_of({"gesture": data, "vary": {"bow_force": SWEPT.tolist()}}))
        rows.append("".join("#" if each else "." for each in found.grid("regime") == HELMHOLTZ))
    return rows


def gesture(
    body: Path, changes: dict[str, Any], controls: dict[str, Any], seconds: float
) -> dict[str, Any]:
    """A stroke on the monochord."""
    return {
        "sample_rate": 44100,
        "duration": seconds,
        "instrument": instrument(body, changes),
        "controls": controls,
    }
