"""Change one thing at a time, and see what it does to the least and the greatest force.

    .venv/bin/python scripts/playability_study/causes.py

It writes a table into docs/playability.md, of a bow position of 0.13 and 0.2 m/s.
"""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from maps import band, median
from tables import BETA, named, table, write_table

from yehu_lab.regimes.columns import HELMHOLTZ
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_server.core.physics.quantities import Quantities
from yehu_server.params.table import find

BOWS = list(range(9))  # seeds of the hair
FORCES = {"from": 0.03, "to": 12.0, "steps": 161, "spread": "log"}  # N
NOISE = find("/bow/noise").default
STROKE = {"speed": 0.2, "acceleration": 10.0, "noise": NOISE, "position": BETA}
AS_THEY_ARE = Quantities()
STRINGS = dict(zip(("string_1", "string_2"), AS_THEY_ARE.strings, strict=True))
HEAVY = 100.0
CHANGES: dict[str, tuple[float, dict[str, Any]]] = {  # finger force (N), instrument
    "nothing": (1.5, {}),
    "`ξ` of the other string": (1.5, {"bow": {"xi": list(reversed(AS_THEY_ARE.bow.xi))}}),
    "a quarter of the stiffness": (1.5, {i: {"E": 0.25 * s.E} for i, s in STRINGS.items()}),
    "four times the stiffness": (1.5, {i: {"E": 4.0 * s.E} for i, s in STRINGS.items()}),
    "a quarter of the loss": (
        1.5,
        {i: {"sigma_0": 0.25 * s.sigma_0, "sigma_1": 0.25 * s.sigma_1} for i, s in STRINGS.items()},
    ),
    "a finger of 6 N": (6.0, {}),
    f"a body {HEAVY:g} times as heavy": (1.5, {"body": "heavy.json"}),
    "that, and 6 N": (6.0, {"body": "heavy.json"}),
}
NOTES = ((1, 70), (1, 72), (1, 75), (2, 72), (2, 75), (2, 84))  # string, note


def forces(
    string: int, note: int, press: float, data: dict[str, Any], folder: Path
) -> tuple[float, float]:
    """Least and greatest force (N), the medians over the bows."""
    stroke = STROKE | {"string": string, "note": note, "press": press}
    instrument = {"felt_loss": 0.0} | data  # as the maps have it
    study = {"sample_rate": 44100, "duration": 0.3, "stroke": stroke, "instrument": instrument}
    found = sweep(study_of(study | {"vary": {"seed": BOWS, "force": FORCES}}, folder))
    rows = found.grid("regime") == HELMHOLTZ
    least, greatest = median(np.transpose([band(found.axes["force"], row) for row in rows]))
    return float(least), float(greatest)


def heavier(folder: Path) -> None:
    """Write a body whose bridge moves less, by a factor of HEAVY."""
    body = json.loads(files("yehu_server.core.physics").joinpath("body.json").read_text("utf-8"))
    for mode in body["bridge_modes"]:
        mode["mass_kg"] *= HEAVY
        mode["damping_kg_per_s"] *= HEAVY
    (folder / "heavy.json").write_text(json.dumps(body), encoding="utf-8")


def main() -> None:
    """Bow all notes with all changes, and write the table."""
    rows = []
    with TemporaryDirectory() as name:
        folder = Path(name)
        heavier(folder)
        for what, (press, instrument) in CHANGES.items():
            found = [forces(*note, press, instrument, folder) for note in NOTES]
            rows.append([what, *(f"{least:.2f}, {greatest:.1f}" for least, greatest in found)])
            print(*rows[-1], sep=" | ", flush=True)
    head = [named(note, string - 1) for string, note in NOTES]
    write_table("causes", table(["changed", *head], rows))


if __name__ == "__main__":
    main()
