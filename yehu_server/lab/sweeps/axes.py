"""What a study varies: names, and the values of each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.util.documents import Fields
from yehu_server.util.values import brief, choice, number, whole

Array = Any

MOST_VALUES = 100_000  # of an axis
SPREADS = ("linear", "log")
Value = float | str


@dataclass(frozen=True)
class Axis:
    """A name that is varied, and its values in order."""

    name: str
    values: tuple[Value, ...]
    # How values lie between each other: "linear", "log", or "" for a list, between whose values
    # there are no others.
    spread: str = ""

    def refined(self, levels: int) -> Axis:
        """The axis with 2**levels steps where it has one.

        Raises ParameterError where it is a list.
        """
        if levels == 0:
            return self
        if not self.spread:
            raise ParameterError(f"{self.name}: a list of values cannot be refined; give a range")
        first, last = (float(value) for value in (self.values[0], self.values[-1]))
        steps = (len(self.values) - 1) * 2**levels + 1
        return spread_axis(self.name, first, last, steps, self.spread)

    def as_array(self) -> Array:
        """The values as an array [shape=(values,)], of numbers or text."""
        return np.array(self.values)


def spread_axis(name: str, first: float, last: float, steps: int, spread: str) -> Axis:
    """An axis of values from `first` to `last`, both with.

    Raises ParameterError where these are none.
    """
    whole(steps, 2, MOST_VALUES)
    choice(spread, SPREADS)
    if not (math.isfinite(first) and math.isfinite(last)):
        raise ParameterError(f"{first} to {last} is not finite")
    if spread == "log" and first * last <= 0.0:
        raise ParameterError(f"a log spread from {first:g} to {last:g} is impossible")
    part = np.arange(steps) / (steps - 1)
    values = first * (last / first) ** part if spread == "log" else first + (last - first) * part
    values[-1] = last
    return Axis(name, tuple(values.tolist()), spread)


def axis_of(text: str) -> Axis:
    """Read ``NAME=V1,V2,...``, ``NAME=FROM:TO:STEPS`` or ``NAME=FROM:TO:STEPS:log``.

    Raises ParameterError where the text has another form.
    """
    name, equals, values = (part.strip() for part in text.partition("="))
    if not equals or not all(name.split(".")):
        raise ParameterError(
            f"{text!r}: expected NAME=V1,V2,... or NAME=FROM:TO:STEPS or NAME=FROM:TO:STEPS:log"
        )
    parts = values.split(":")
    try:
        if len(parts) in {3, 4}:
            spread = parts[3] if len(parts) == 4 else "linear"
            return spread_axis(name, float(parts[0]), float(parts[1]), int(parts[2]), spread)
        return Axis(name, tuple(_value(value) for value in values.split(",")))
    except ParameterError as error:
        raise ParameterError(f"{name}: {error}") from error
    except ValueError:
        raise ParameterError(f"{text!r}: expected numbers after {name}=") from None


def _value(text: str) -> Value:
    """A number, or a word such as the name of a friction law."""
    text = text.strip()
    return text if text.replace("-", "").isalpha() else float(text)


def axis_from(name: str, entry: Any) -> Axis:
    """Read an axis of a study: a list, or a table of ``from``, ``to``, ``steps``, ``spread``.

    Raises ParameterError where it is none.
    """
    if isinstance(entry, list):
        if not 1 <= len(entry) <= MOST_VALUES:
            raise ParameterError(f"expected 1 to {MOST_VALUES} values")
        return Axis(name, tuple(x if isinstance(x, str) else number(x) for x in entry))
    if not isinstance(entry, Mapping):
        raise ParameterError(f"expected a list, or from, to and steps, got {brief(entry)}")
    table = Fields(entry)
    table.only("from", "to", "steps", "spread")
    first, last = table.need("from", number), table.need("to", number)
    steps = table.need("steps", whole, 2, MOST_VALUES)
    return spread_axis(name, first, last, steps, table.read("spread", choice, "linear", SPREADS))
