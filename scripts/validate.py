"""Measure what both pages validation.md state, and write their tables and figures.

    .venv/bin/python scripts/validate.py measure   # half an hour on two cores
    .venv/bin/python scripts/validate.py write

`measure` takes subjects as arguments, to measure only those; the others stay as they were.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from validation import convergence, energy, held_out, ideal, laws, scheme, two_directions
from validation.draw import draw
from validation.tables import PAGES, page

RESULTS = Path(__file__).parent / "validation" / "results.json"


def measure_ideal() -> dict[str, Any]:
    """The ideal string against its closed forms."""
    fair = ideal.instrument()
    return {
        "helmholtz": [
            ideal.helmholtz(beta, ideal.ORDINARY * ideal.greatest_force(fair, beta))
            for beta in ideal.BETAS
        ],
        "greatest": [ideal.measured_limit("resistive", b, upper=True) for b in ideal.BETAS],
        "least": [ideal.measured_limit("resistive", b, upper=False) for b in ideal.BETAS],
    }


def measure_convergence() -> dict[str, Any]:
    """Maps of some notes at some rates, on other grids, and with other hair."""
    return {note: convergence.compared(convergence.maps(note)) for note in convergence.NOTES}


SUBJECTS: dict[str, Callable[[], Any]] = {
    "ideal": measure_ideal,
    "energy": energy.measure,
    "convergence": measure_convergence,
    "laws": laws.measure,
    "held_out": held_out.measure,
    "scheme": scheme.measure,
    "two_directions": two_directions.measure,
}


def results() -> dict[str, Any]:
    """What was measured."""
    found: dict[str, Any] = json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else {}
    return found


def main(words: list[str]) -> None:
    if not words or words[0] not in ("measure", "write"):
        print(__doc__)
        return
    if words[0] == "measure":
        for name in words[1:] or SUBJECTS:
            found = SUBJECTS[name]()
            RESULTS.write_text(json.dumps(results() | {name: found}, indent=1) + "\n", "utf-8")
            print(name, "measured", flush=True)
        return
    draw(results())
    for each in PAGES:
        each.write_text(page(each.read_text("utf-8"), results()), "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
