"""Colours of the regimes and names of the axes, for pictures and pages."""

from __future__ import annotations

# Told apart by eyes that confuse red and green, too.
COLOURS = {
    "unbowed": "#ffffff",
    "silent": "#e6e6e6",
    "helmholtz": "#2f8f5b",
    "multiple slip": "#a9d18e",
    "octave": "#3b7dd8",
    "anomalous low": "#f0a830",
    "raucous": "#b5402a",
    "aperiodic": "#5a4a6f",
}
LABELS = {
    "force": "bow force, N",
    "position": "bow position β",
    "speed": "bow speed, m/s",
    "acceleration": "acceleration of the bow, m/s²",
    "note": "MIDI note",
    "press": "finger force, N",
    "place": "place of the finger, cents above the note",
    "tension": "tension of the string, factor",
    "noise": "noise of the hair",
    "bow_force": "bow force, N",
    "bow_velocity": "bow speed, m/s",
    "bow_position": "bow position, m from the loop",
    "bow_acceleration": "acceleration of the bow, m/s²",
    "press_force": "finger force, N",
    "finger_position": "finger position, m from the loop",
}
