"""The metadata of a parameter: address, range, default, unit, curve; no values."""

import math
from dataclasses import dataclass
from enum import Enum
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.util.values import number

TURNED_ON = 0.5  # a switch is on from here


class Curve(Enum):
    """A mapping of 0..1 to a range."""

    LIN = "linear"
    EXP = "exp"  # equal ratios; the range must be above zero
    S = "s"  # gentle at both ends

    def from_unit(self, unit: float, lo: float, hi: float) -> float:
        """Map `unit` in 0..1 to `lo`..`hi`; hi below lo inverts."""
        if self is Curve.EXP:
            return float(lo * (hi / lo) ** unit)
        if self is Curve.S:
            unit = unit * unit * (3.0 - 2.0 * unit)
        return lo + (hi - lo) * unit

    def to_unit(self, value: float, lo: float, hi: float) -> float:
        """Find the unit in 0..1 that `from_unit` maps to `value`, clamped to the range."""
        if lo == hi:
            return 0.0
        value = min(max(value, min(lo, hi)), max(lo, hi))
        if self is Curve.EXP:
            return math.log(value / lo) / math.log(hi / lo)
        unit = (value - lo) / (hi - lo)
        if self is Curve.S:
            return 0.5 - math.sin(math.asin(1.0 - 2.0 * unit) / 3.0)
        return unit


class Place(Enum):
    """The holder of the value: the compiled engine, or the player's record."""

    ENGINE = "engine"
    PLAYER = "player"


@dataclass(frozen=True)
class Param:
    """One row of the parameter table.

    `lo`, `hi` and `default` are in `unit`; `smooth_ms` is the ramp of a write that names none.
    `player_controlled` marks parameters that the player moves while notes sound (decisions/0006);
    `is_choice` marks discrete ones, such as switches (on from `TURNED_ON` up); `is_shared` those
    that are one for all players on the stage.
    """

    address: str
    symbol: str
    unit: str
    lo: float
    hi: float
    default: float
    doc: str
    place: Place = Place.PLAYER
    curve: Curve = Curve.LIN
    smooth_ms: float = 5.0
    player_controlled: bool = False
    is_choice: bool = False
    is_shared: bool = False

    def clamped(self, value: float) -> float:
        """Clamp a value to the range; raises ParameterError where it is not finite."""
        try:
            return min(max(number(value), self.lo), self.hi)
        except ParameterError as error:
            raise ParameterError(f"{self.address}: {error}") from None

    def within(self, value: Any) -> float:
        """A value within the range; a ParameterError, without the address, where it is none."""
        return number(value, self.lo, self.hi, self.unit)

    @property
    def range_text(self) -> str:
        """The range and its unit, as text."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"{self.lo:g} to {self.hi:g}{unit}"

    def from_unit(self, unit: float) -> float:
        """Map 0..1, clamped, to the range along the parameter's curve."""
        return self.curve.from_unit(min(max(unit, 0.0), 1.0), self.lo, self.hi)

    def to_unit(self, value: float) -> float:
        """Map a value to 0..1, the inverse of `from_unit`."""
        return self.curve.to_unit(value, self.lo, self.hi)
