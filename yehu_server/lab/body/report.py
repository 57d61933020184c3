"""A body in words: its modes, how well it fits, and what may be wrong with it."""

from __future__ import annotations

from typing import Any

from yehu_server.lab.body.body_file import Differences, Fit


def lines_of(fit: Fit) -> list[str]:
    """A fit as lines for a terminal."""
    modes = fit.modes
    lines = ["   Hz       Q    mass, g   dashpot, kg/s"]
    lines += [
        f"{hz:7.1f}  {0.5 / ratio:6.1f}  {1e3 * mass:9.4g}  {resistance:9.4g}"
        for hz, ratio, mass, resistance in zip(
            modes.frequency_hz, modes.damping, modes.mass, modes.resistance, strict=True
        )
    ]
    lo, hi = fit.band_hz
    count = len(fit.body.sections)
    lines.append(f"{len(modes.mass)} bridge modes, {count} sections of radiation")
    if fit.measurement.sources:
        lines.append(f"of {', '.join(fit.measurement.sources)}, {lo:.0f} to {hi:.0f} Hz")
    for what, off in (("admittance", fit.admittance_db), ("radiation", fit.radiation_db)):
        if off is not None:
            lines.append(f"{what}: {describe_differences(off)}")
    return lines


def describe_differences(off: Differences) -> str:
    """How far a fit is from its measurement, in words."""
    return (
        f"{off.rms:.2f} dB off the measurement (rms), which scatters by {off.scatter:.2f} dB; "
        f"{off.most:.1f} dB at most"
    )


def fields_of(fit: Fit) -> dict[str, Any]:
    """A fit as JSON values."""
    modes = fit.modes
    return {
        "modes": [
            {"frequency_hz": hz, "q": 0.5 / ratio, "mass_kg": mass, "damping_kg_per_s": resistance}
            for hz, ratio, mass, resistance in zip(
                modes.frequency_hz.tolist(),
                modes.damping.tolist(),
                modes.mass.tolist(),
                modes.resistance.tolist(),
                strict=True,
            )
        ],
        "sections": len(fit.body.sections),
        "band_hz": list(fit.band_hz),
        "admittance_db": _fields(fit.admittance_db),
        "radiation_db": _fields(fit.radiation_db),
        "sources": list(fit.measurement.sources),
        "warnings": list(fit.warnings),
    }


def _fields(off: Differences | None) -> dict[str, float] | None:
    if off is None:
        return None
    return {"rms": off.rms, "most": off.most, "scatter": off.scatter}
