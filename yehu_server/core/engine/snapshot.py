"""Snapshots of an instrument, for pictures: strings, bow, fingers, what the ear hears. Compiled.

Taking one only reads. Beside a callback on another thread, half of it may be a block older.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import native
from yehu_server.compile.memory import carray
from yehu_server.core.controls.kernel_controls import bow_force, tremolo_factor
from yehu_server.core.controls.record import CONTROLS, FORCE_DRIFT, SPEED_DRIFT
from yehu_server.core.controls.slots import FINGER_POSITION, FINGER_PRESS, SLOT_COUNT, SLOTS
from yehu_server.core.engine.atomics import record_at
from yehu_server.core.engine.rig import (
    CONTROLS_AT,
    METERS_AT,
    MODEL_AT,
    PLAYER_AT,
    RIG_BYTES,
    STATE_AT,
    count_parts,
)
from yehu_server.core.engine.telemetry import METERS, SHAPE_POINTS, displacement
from yehu_server.core.physics.elementary import exp2
from yehu_server.core.physics.layout import MAX_FINGERS, MODEL, STATE, STRINGS
from yehu_server.core.physics.schelleng import lower_limit, resistance, upper_limit
from yehu_server.core.player.notes import sounding_pitch
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.player.record import PLAYER
from yehu_server.core.stage.record import STAGE

NO_STRING = -1
MIN_PRESS = 1e-6  # N; below, a finger is lifted

SNAPSHOT = np.dtype(
    [
        ("frame", np.float64),  # of the next sample
        ("rate", np.float64),  # Hz
        ("pitch", np.float64),  # that is played (fractional MIDI note); NaN in silence
        ("frequency", np.float64),  # of it (Hz); NaN in silence
        # What the player hears: see ``player.ear`` and ``player.bowing_by_ear``.
        ("certainty", np.float64),
        ("error", np.float64),  # cents; positive where the string is sharp
        ("slips", np.float64),  # in a period
        # Of the mix, in the last sixtieth of a second; of this instrument's own sound, before the
        # stage, where it is not the first of several.
        ("peak", np.float64),
        ("rms", np.float64),
        ("length", np.float64),  # m; of the strings, from the loop to the bridge
        ("string", np.float64),  # that is bowed, or NO_STRING
        ("speed", np.float64),  # of the bow (m/s), with its direction
        ("force", np.float64),  # of the bow (N)
        ("beta", np.float64),  # of the bow
        ("bow_x", np.float64),  # m from the loop
        ("hair_place", np.float64),  # m from the frog: where the string is on the hair
        ("hair_length", np.float64),  # m; 0: the hair has no ends
        ("finger_x", np.float64, MAX_FINGERS),  # m from the loop
        ("finger_press", np.float64, MAX_FINGERS),  # N; 0: lifted
        # Schelleng's limits at a speed of 1 m/s and beta 1, for the string and pitch played: both
        # grow with the speed; divide the upper one by beta, the lower by its square.
        ("upper", np.float64),  # N
        ("lower", np.float64),
        ("targets", np.float64, SLOT_COUNT),  # values that the engine's parameters have or move to
        ("shapes", np.float64, (STRINGS, SHAPE_POINTS)),  # m; displacement, from loop to bridge
    ]
)


@native
def snapshot(rig: Any, into: Any) -> None:
    """Copy the present state of a ``rig.RIG`` into a SNAPSHOT. Real time: safe."""
    m = record_at(rig, MODEL_AT, MODEL)
    s = record_at(rig, STATE_AT, STATE).motion
    c = record_at(rig, CONTROLS_AT, CONTROLS)
    p = record_at(rig, PLAYER_AT, PLAYER)
    t = record_at(rig, METERS_AT, METERS)
    out = carray(into, (1,), SNAPSHOT)[0]
    out.frame, out.rate = c.frame, m.rate
    out.pitch = sounding_pitch(p)
    out.frequency = p.a4 * exp2((out.pitch - 69.0) / 12.0)
    out.certainty, out.error, out.slips = p.ear.certainty, p.ear.error, p.ear.slips
    parts = count_parts(rig)
    if parts > 0:
        mix = record_at(rig, parts * RIG_BYTES, STAGE)
        out.peak, out.rms = mix.peak, mix.rms
    else:
        out.peak, out.rms = t.peak, t.rms
    out.length = m.bridge_x
    side = c.value[SLOTS.bow_side]
    string = 0 if side >= 0.0 else 1
    out.string = string if side != 0.0 else NO_STRING
    out.speed = c.value[SLOTS.bow_speed] * tremolo_factor(c) * (1.0 + c.drift[SPEED_DRIFT])
    out.force = abs(side) * bow_force(c, string, out.speed) * (1.0 + c.drift[FORCE_DRIFT])
    out.beta = c.value[SLOTS.bow_position] * c.position_drift
    out.bow_x = c.bridge_x - out.beta * (c.bridge_x - c.sounding_from)
    out.hair_place, out.hair_length = c.bow_displacement, p.value[PLAYING.bow_length]
    stop, held = 0.0, 0.0
    for j in range(MAX_FINGERS):
        out.finger_x[j] = c.value[FINGER_POSITION[j]]
        press = c.value[FINGER_PRESS[j]]
        out.finger_press[j] = press if press > MIN_PRESS else 0.0
        if press > MIN_PRESS and out.finger_x[j] > stop:
            stop, held = out.finger_x[j], press
    out.upper = out.lower = 0.0
    if out.frequency > 0.0:  # not NaN
        Z, grip = math.sqrt(m.T[string] * m.rho_A[string]), m.mu_S - m.mu_C
        out.upper = upper_limit(Z, grip, 1.0, 1.0)
        R = resistance(m, string, out.frequency, stop, held)
        out.lower = lower_limit(Z, grip, R, 1.0, 1.0)
    for slot in range(SLOT_COUNT):
        out.targets[slot] = c.target[slot]
    for i in range(STRINGS):
        for point in range(SHAPE_POINTS):
            place = point * m.bridge_x / m.h[i] / (SHAPE_POINTS - 1)
            out.shapes[i, point] = displacement(s, i, place)
