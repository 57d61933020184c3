"""A body in words: its modes, how well it fits, and what may be wrong with it."""

from typing import Any

import numpy as np

from yehu_lab.body.body_file import Fit, quality_of


def _rows(fit: Fit) -> list[list[float]]:
    """Frequency, damping ratio, mass and dashpot of each mode."""
    modes = fit.modes
    columns = [modes.frequency_hz, modes.damping, modes.mass, modes.resistance]
    return np.stack(columns, axis=1).tolist()  # type: ignore[no-any-return]


def lines_of(fit: Fit) -> list[str]:
    """A fit as lines for a terminal."""
    lines = ["   Hz       Q    mass, g   dashpot, kg/s"]
    lines += [
        f"{hz:7.1f}  {0.5 / ratio:6.1f}  {1e3 * mass:9.4g}  {resistance:9.4g}"
        for hz, ratio, mass, resistance in _rows(fit)
    ]
    lo, hi = fit.band_hz
    count = len(fit.body.sections)
    lines.append(f"{len(fit.body.mass)} bridge modes, {count} sections of radiation")
    if fit.measurement.sources:
        lines.append(f"of {', '.join(fit.measurement.sources)}, {lo:.0f} to {hi:.0f} Hz")
    for what, off in (("admittance", fit.admittance_db), ("radiation", fit.radiation_db)):
        if off is not None:
            lines.append(
                f"{what}: {off.rms:.2f} dB off the measurement (rms), which scatters by "
                f"{off.scatter:.2f} dB; {off.most:.1f} dB at most"
            )
    return lines


def fields_of(fit: Fit) -> dict[str, Any]:
    """A fit as JSON values."""
    return {
        "modes": [
            {"frequency_hz": hz, "q": 0.5 / ratio, "mass_kg": mass, "damping_kg_per_s": resistance}
            for hz, ratio, mass, resistance in _rows(fit)
        ],
        "sections": len(fit.body.sections),
        **quality_of(fit),
    }
