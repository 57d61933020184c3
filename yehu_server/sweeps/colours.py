"""Colours of the regimes, for pictures and pages; apart for eyes that confuse red and green."""

from __future__ import annotations

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
# What is drawn along y, where a result has it: forces first.
UPRIGHT = ("force", "bow_force", "press", "press_force", "tension")


def plane_of(axes: dict[str, int]) -> tuple[str, str | None]:
    """Which axis to draw along x, and which along y, if there are two.

    Parameters
    ----------
    axes : dict
        Number of values by name, in order.
    """
    varied = [name for name, count in axes.items() if count > 1] or list(axes)[:1]
    # The seed repeats a map, and a note names one, where others span a plane.
    for name in ("seed", "string", "note"):
        if name in varied and len(varied) > 2:
            varied.remove(name)
    upright = [name for name in UPRIGHT if name in varied]
    y = upright[0] if upright and len(varied) > 1 else None
    if y is None:
        return varied[0], varied[1] if len(varied) > 1 else None
    # The others make maps of their own, so those with few values.
    return max((name for name in varied if name != y), key=lambda name: axes[name]), y
