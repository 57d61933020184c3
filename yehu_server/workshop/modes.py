"""A bank of modes: masses on springs and dashpots, and the admittance that they make.

[Yehu] eqs. (10)-(12). With positive masses and dashpots the real part of the admittance is at
no frequency below zero: such a body never gives more energy than it got.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Floats = np.ndarray[Any, np.dtype[np.float64]]
Complexes = np.ndarray[Any, np.dtype[np.complex128]]


@dataclass(frozen=True)
class Modes:
    """A bank of modes; each array has one value a mode [shape=(modes,)], by rising frequency."""

    frequency_hz: Floats
    damping: Floats  # damping ratio, 1 / 2Q
    inverse_mass: Floats  # 1/kg, above zero

    @property
    def mass(self) -> Floats:
        """Masses (kg)."""
        return 1.0 / self.inverse_mass

    @property
    def resistance(self) -> Floats:
        """Dashpots (kg/s): 2 damping M omega."""
        return 2.0 * self.damping * self.mass * (2.0 * np.pi * self.frequency_hz)

    def admittance(self, frequency_hz: Floats) -> Complexes:
        """Velocity per force (s/kg) at frequencies [shape=(lines,)]."""
        columns = mode_columns(frequency_hz, self.frequency_hz, self.damping)
        return np.asarray(columns @ self.inverse_mass)


def mode_columns(frequency_hz: Floats, modes_hz: Floats, damping: Floats) -> Complexes:
    """Admittance of modes of one kilogram [shape=(lines, modes)], [Yehu] eq. (12) for M = 1."""
    omega = 2.0 * np.pi * frequency_hz[:, np.newaxis]
    omega_m = 2.0 * np.pi * modes_hz
    return np.asarray(1j * omega / (omega_m**2 - omega**2 + 2j * damping * omega_m * omega))
