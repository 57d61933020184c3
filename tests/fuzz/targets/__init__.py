"""All targets, by importing them."""

from fuzz.targets import (
    calibrations,
    captures,
    jianpu,
    laboratory,
    midi,
    midi_files,
    osc,
    osc_calls,
    physical,
    scores_musicxml,
    settings,
    tunings,
    web,
)

__all__ = [
    "calibrations",
    "captures",
    "jianpu",
    "laboratory",
    "midi",
    "midi_files",
    "osc",
    "osc_calls",
    "physical",
    "scores_musicxml",
    "settings",
    "tunings",
    "web",
]
