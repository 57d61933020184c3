"""Measure what both pages validation.md state, and write their tables and figures.

    .venv/bin/python scripts/validate.py measure   # half an hour on two cores
    .venv/bin/python scripts/validate.py published FOLDER   # of the authors' sounds
    .venv/bin/python scripts/validate.py write

`measure` takes subjects as arguments, to measure only those; the others stay as they were.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from validation import convergence, energy, ideal, laws, monochord, published
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
    "monochord": monochord.measure,
}


def results() -> dict[str, Any]:
    """What was measured."""
    found: dict[str, Any] = json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else {}
    return found


def keep(name: str, found: Any) -> None:
    """Put what was measured in place of what was known."""
    RESULTS.write_text(json.dumps(results() | {name: found}, indent=1) + "\n", "utf-8")
    print(name, "measured", flush=True)


def main(words: list[str]) -> None:
    if words[:1] == ["measure"]:
        for name in words[1:] or SUBJECTS:
            keep(name, SUBJECTS[name]())
        return
    if words[:1] == ["published"] and len(words) == 2:
        keep("published", published.measure(Path(words[1])))
        return
    if words != ["write"]:
        print(__doc__)
        return
    draw(results())
    for each in PAGES:
        each.write_text(page(each.read_text("utf-8"), results()), "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
