"""All targets, by importing them."""

from fuzz.targets import (
    calibrations,
    captures,
    midi,
    osc,
    osc_calls,
    physical,
    settings,
    tunings,
    web,
)

__all__ = [
    "calibrations",
    "captures",
    "midi",
    "osc",
    "osc_calls",
    "physical",
    "settings",
    "tunings",
    "web",
]
