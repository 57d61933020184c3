"""`strings`: stopped notes in tune on strings and bridges that nobody calibrated for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from measures.intonation import CLOSE_CENTS, SETTLED_S, in_words, off_by
from measures.shares import Share, share_line
from measures.take import NOTES, Setup, Take, in_parallel
from yehu_server.core.physics.quantities import Quantities, measured_body
from yehu_server.core.player.calibration import OPEN_NOTES
from yehu_server.params.table import STRING_NAMES

END_S = 0.75
VELOCITIES = (50, 100)
BODY = measured_body()
LIGHT_BRIDGE = Quantities(body=replace(BODY, mass=tuple(0.5 * mass for mass in BODY.mass)))
OTHERS: dict[str, dict[str, Any]] = {
    "as calibrated": {},
    "30 cents low": {"settings": {f"/string/{name}/tuning": -30.0 for name in STRING_NAMES}},
    "30 cents high": {"settings": {f"/string/{name}/tuning": 30.0 for name in STRING_NAMES}},
    "4 % more tension": {"tension": 1.04},  # 34 cents
    "bridge of half the mass": {"quantities": LIGHT_BRIDGE},  # of each mode, at its frequency
}


def _on_string(setup: Setup, note: int, velocity: int, how: dict[str, Any]) -> float:
    """Return the error (cents) of a stopped note from 0.4 s on."""
    take = Take(setup, **how)
    take.on(0.0, note, velocity)
    return off_by(take.play(END_S), setup.rate, SETTLED_S, END_S - SETTLED_S, note)


def strings(setup: Setup) -> list[Share]:
    """Print the share of stopped notes in tune on each instrument, and the others."""
    cases = [
        (note, velocity) for note in NOTES if note not in OPEN_NOTES for velocity in VELOCITIES
    ]
    parts = []
    for name, how in OTHERS.items():
        errors = in_parallel(setup, _on_string, [(*case, how) for case in cases])
        words = [f"{n}/{v} {in_words(e)}" for (n, v), e in zip(cases, errors, strict=True)]
        parts.append(share_line(name, [abs(error) <= CLOSE_CENTS for error in errors], words))
    return parts
