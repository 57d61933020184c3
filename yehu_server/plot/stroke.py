"""What a gesture's stroke is by theory: its string, its pitch, Schelleng's limits of its force."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from yehu_server.physics import kernel
from yehu_server.physics.quantities import Quantities, StringQuantities, override
from yehu_server.physics.schelleng import bridge_resistance, lower_limit, upper_limit

Array = Any

LEAST_PRESS = 0.05  # N; below, no finger stops the strings
DEFAULTS = {"bow_position": 0.255, "finger_position": 0.1}


class Stroke:
    """A bowed note, from the data of a gesture.

    Parameters
    ----------
    gesture : mapping
        As a gesture file has it; of a curve, the largest value counts.
    values : mapping
        Controls that differ, by name.

    Attributes
    ----------
    quantities : Quantities
    string : int
        0 the inner, 1 the outer.
    speed : float
        Of the bow (m/s).
    sounding_from : float
        Where the sounding length begins, m from the loop: at the finger, if one presses.
    """

    def __init__(self, gesture: Mapping[str, Any], values: Mapping[str, float]) -> None:
        self._controls = dict(gesture.get("controls", {})) | dict(values)
        self.quantities = override(Quantities(), gesture.get("instrument", {}))
        self._rate = float(gesture.get("sample_rate", 44100.0))
        self.string = 0 if self._largest("bow_force") >= 0.0 else 1
        self.speed = abs(self._largest("bow_velocity"))
        is_pressed = self._largest("press_force") > LEAST_PRESS
        self.sounding_from = self._largest("finger_position") if is_pressed else 0.0

    def _largest(self, name: str) -> float:
        value = self._controls.get(name, DEFAULTS.get(name, 0.0))
        if isinstance(value, list | tuple):
            return float(max((level for _, level in value), key=abs))
        return float(value)

    @property
    def silk(self) -> StringQuantities:
        """The quantities of the string."""
        return self.quantities.strings[self.string]

    @property
    def sounding_length(self) -> float:
        """Length of the string that sounds (m)."""
        return self.quantities.bridge_x - self.sounding_from

    @property
    def frequency_hz(self) -> float:
        """Fundamental frequency of the ideal string (Hz)."""
        return math.sqrt(self.silk.T / self.silk.rho_A) / (2.0 * self.sounding_length)

    @property
    def impedance(self) -> float:
        """Wave impedance of the string (kg/s)."""
        return math.sqrt(self.silk.T * self.silk.rho_A)

    def beta(self, bow_position: Array) -> Array:
        """Return the distance of the bow from the bridge as a share of the sounding length."""
        return (self.quantities.bridge_x - np.asarray(bow_position)) / self.sounding_length

    def limits(self, beta: Array) -> tuple[Array, Array]:
        """Return Schelleng's lower and upper limit of the bow force (N) at bow positions."""
        grip = self.quantities.bow.mu_S - self.quantities.bow.mu_C
        model = kernel.prepare(self.quantities, self._rate)[0]
        resistance = bridge_resistance(model, self.frequency_hz)
        lower = [lower_limit(self.impedance, grip, resistance, self.speed, b) for b in beta]
        upper = [upper_limit(self.impedance, grip, self.speed, b) for b in beta]
        return np.array(lower), np.array(upper)
