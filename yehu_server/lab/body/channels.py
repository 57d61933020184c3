"""What the channels of a recording are: names, and how large full scale or a unit is."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from yehu_server.errors import MeasurementError
from yehu_server.lab.body.curve import Floats

# What a channel may be; all but the force are responses.
QUANTITIES = ("force", "velocity", "acceleration", "displacement", "pressure")
SKIPPED = "none"
UNITS = {
    "force": {"n": 1.0, "mn": 1e-3},
    "velocity": {"m/s": 1.0, "mm/s": 1e-3, "um/s": 1e-6},
    "acceleration": {"m/s2": 1.0, "m/s^2": 1.0, "g": 9.80665},
    "displacement": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
    "pressure": {"pa": 1.0, "mpa": 1e-3},
}


@dataclass(frozen=True)
class Channel:
    """One channel: a quantity or ``none``, and how many SI units a value of 1 is."""

    quantity: str
    scale: float = 1.0


def parse_channels(text: str) -> tuple[Channel, ...]:
    """Read channels as users write them, in their order: ``force=100,velocity=0.5``.

    Raises MeasurementError for an unknown quantity, one that is given twice, or a scale that is
    none.
    """
    channels = []
    for item in text.split(","):
        name, _, scale = item.strip().partition("=")
        if name not in (*QUANTITIES, SKIPPED):
            known = ", ".join((*QUANTITIES, SKIPPED))
            raise MeasurementError(f"channels: unknown quantity {name!r} (known: {known})")
        channels.append(Channel(name, _scale(name, scale or "1")))
    check_channels(channels, "channels")
    return tuple(channels)


def check_channels(channels: list[Channel], where: str) -> None:
    """Refuse a quantity that is given twice. Raises MeasurementError, naming it."""
    names = [channel.quantity for channel in channels if channel.quantity != SKIPPED]
    for name in names:
        if names.count(name) > 1:
            raise MeasurementError(f"{where}: {name} is given twice")


def by_quantity(channels: Sequence[Channel], values: Floats) -> dict[str, Floats]:
    """The values of each quantity, in SI units, of columns [shape=(samples, channels)]."""
    return {
        channel.quantity: values[:, i] * channel.scale
        for i, channel in enumerate(channels)
        if channel.quantity != SKIPPED
    }


def _scale(name: str, text: str) -> float:
    try:
        scale = float(text)
    except ValueError:
        scale = math.nan
    if not (math.isfinite(scale) and scale != 0.0):
        raise MeasurementError(f"channels: {name}={text} is not a number other than 0")
    return scale


def parse_heading(text: str) -> Channel | None:
    """Read the heading of a column: ``force_N``, ``velocity (mm/s)``; None where it is no quantity.

    Raises MeasurementError for a unit that is not known.
    """
    match = re.fullmatch(r"\s*([a-z]+)[\s_]*[(\[]?\s*([^)\]]*?)\s*[)\]]?\s*", text.lower())
    if match is None or match[1] not in QUANTITIES:
        return None
    quantity, unit = match[1], match[2].replace("²", "2").replace("µ", "u").replace("μ", "u")
    if not unit:
        return Channel(quantity)
    if unit not in UNITS[quantity]:
        known = ", ".join(UNITS[quantity])
        raise MeasurementError(f"{quantity} in {unit!r}: unknown unit (known: {known})")
    return Channel(quantity, UNITS[quantity][unit])
