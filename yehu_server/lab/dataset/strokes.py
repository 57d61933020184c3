"""A sound of a data set that is drawn as numbers: one stroke of the bow, one finger."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.core.player.calibration import OPEN_NOTES, frequency_hz, wave_speed
from yehu_server.lab.dataset.description import Description
from yehu_server.lab.dataset.sound import Sound, calibrated, judged, regimes
from yehu_server.lab.simulation import simulate
from yehu_server.scores.gesture import Gesture

OPEN_BELOW = 0.01  # semitones: no finger
SIGN = {1: 1.0, 2: -1.0}  # of the bow's force, by the string


def stroke(description: Description, number: int) -> Sound:
    """Make a sound of a description of kind "strokes"."""
    drawn = description.drawn(number)
    quantities, calibration = calibrated(description)
    string = int(drawn["string"])
    silk = quantities.strings[string - 1]
    pairs = {name: _ends(drawn, name) for name in ("stop", "bow_velocity", "bow_force")}
    places = _ends(drawn, "bow_position")
    lengths, hertz = [], []
    for stop in pairs["stop"]:
        f = frequency_hz(OPEN_NOTES[string - 1] + stop, calibration.a4)
        hertz.append(f)
        lengths.append(min(wave_speed(quantities, string - 1) / (2.0 * f), quantities.bridge_x))
    is_open = max(pairs["stop"]) < OPEN_BELOW
    bridge = quantities.bridge_x
    duration = drawn["duration"]
    fingers = [min(max(bridge - length, 1e-3), silk.L - 1e-3) for length in lengths]
    bows = [bridge - beta * length for beta, length in zip(places, lengths, strict=True)]
    curves: dict[str, list[float]] = {
        "bow_position": bows,
        "bow_noise": [drawn["bow_noise"]] * 2,
        "finger_position": fingers,
        "press_force": [0.0 if is_open else drawn["press_force"]] * 2,
    }
    controls: dict[str, Any] = {
        name: ((0.0, ends[0]), (duration, ends[1])) for name, ends in curves.items()
    }
    forces = [SIGN[string] * force for force in pairs["bow_force"]]
    controls["bow_force"] = _begun(forces, drawn["force_attack"], duration)
    controls["bow_velocity"] = _begun(pairs["bow_velocity"], drawn["attack"], duration)
    made = simulate(Gesture(description.rate, duration, quantities, controls))
    frames = len(made.arrays["time"])
    asked = np.interp(np.arange(frames), [0, frames], hertz)
    return Sound(
        audio=made.arrays["pressure"].astype(np.float32),
        arrays=made.arrays,
        drawn=drawn,
        found=regimes(made.arrays, asked, description.rate),
        stroke=judged(made.arrays, hertz[-1], description.rate),
        faults=int(made.meta["unconverged_solves"]) + int(made.meta["lost_states"]),
    )


def _ends(drawn: dict[str, float], name: str) -> tuple[float, float]:
    """A value at the beginning and at the end."""
    return drawn[name], drawn.get(f"{name}_end", drawn[name])


def _begun(ends: Any, attack: float, duration: float) -> tuple[tuple[float, float], ...]:
    """A curve from 0 to its first value in the time of the attack, then to its last."""
    if attack <= 0.0:
        return ((0.0, ends[0]), (duration, ends[1]))
    if attack >= duration:
        return ((0.0, 0.0), (attack, ends[0]))
    return ((0.0, 0.0), (attack, ends[0]), (duration, ends[1]))
