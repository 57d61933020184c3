"""The sounds of a data set: a stroke that is drawn as numbers, or notes that the player plays."""

from typing import Any

import numpy as np

from yehu_lab.dataset.description import Description
from yehu_lab.dataset.sound import Sound, calibrated, judged, regimes
from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG
from yehu_server.core.physics.layout import MAX_FINGERS, control_columns, probe_columns
from yehu_server.core.player.note_tables import frequency_hz, wave_speed
from yehu_server.errors import ParameterError
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.scores.gesture import Gesture
from yehu_server.simulation.run import signals, simulate

OPEN_BELOW = 0.01  # semitones: no finger
SIGN = {1: 1.0, 2: -1.0}  # of the bow's force, by the string
Array = Any
LONGEST_S = 600.0
OF_NOTES = ("pitch", "velocity", "length", "gap")  # drawn for each
SHORTEST_S = 0.02  # from one beginning to the next


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
        f = frequency_hz(calibration.open_notes[string - 1] + stop, calibration.a4)
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
        found=regimes(made.arrays, asked, description.rate, quantities.bow.lift_force),
        stroke=judged(made.arrays, hertz[-1], description.rate),
        faults=int(made.meta["unconverged_solves"]) + int(made.meta["lost_states"]),
    )


def _ends(drawn: dict[str, float], name: str) -> tuple[float, float]:
    return drawn[name], drawn.get(f"{name}_end", drawn[name])


def _begun(ends: Any, attack: float, duration: float) -> tuple[tuple[float, float], ...]:
    """A curve from 0 to its first value in the time of the attack, then to its last."""
    if attack <= 0.0:
        return ((0.0, ends[0]), (duration, ends[1]))
    if attack >= duration:
        return ((0.0, 0.0), (attack, ends[0]))
    return ((0.0, 0.0), (attack, ends[0]), (duration, ends[1]))


def melody(description: Description, number: int) -> Sound:
    """Make a sound of kind "notes". Raises ParameterError where it would last too long."""
    rate = description.rate
    drawn: dict[str, Any] = {
        name: value for name, value in description.drawn(number).items() if name not in OF_NOTES
    }
    drawn["notes"] = _written(description, number, int(drawn["notes"]))
    _, calibration = calibrated(description)
    playing = PlayingOptions(seed=number % 65536, quantities=description.quantities)
    instrument = Instrument(playing.spec(rate, calibration))
    commands = PlayingOptions().player(instrument)
    for address in description.draws:
        if address.startswith("/"):
            commands.write(address, drawn[address])
    end_s = 0.0
    for place, note in enumerate(drawn["notes"]):
        key = Key(place % 16, float(place))
        begin, end = (instrument.frames(1e3 * note[name]) for name in ("begin", "end"))
        commands.write("/playing/note_length", note["length"], frame=begin)
        struck = {"/playing/velocity": note["velocity"] / 127.0}
        commands.note_on(key, struck, frame=begin, tuned=note["pitch"])
        commands.note_off(key, frame=end)
        end_s = max(end_s, note["end"])
    frames = instrument.frames(1e3 * (end_s + drawn["tail"]))
    if frames > LONGEST_S * rate:
        raise ParameterError(f"lasts {frames / rate:.0f} s, longer than {LONGEST_S:g}")
    return _played(instrument, frames, drawn, description, calibration.a4)


def _written(description: Description, number: int, count: int) -> list[dict[str, float]]:
    """The notes: pitch, velocity, and seconds."""
    notes = []
    begin = 0.0
    for place in range(count):
        pitch, velocity, length, gap = (description.draw(number, name, place) for name in OF_NOTES)
        end = begin + length
        drawn = {"pitch": pitch, "velocity": velocity}
        notes.append(drawn | {"begin": begin, "end": end, "length": length})
        begin = max(end + gap, begin + SHORTEST_S)
    return notes


def _played(
    instrument: Any, frames: int, drawn: dict[str, Any], description: Description, a4: float
) -> Sound:
    rig = np.frombuffer(instrument.memory, RIG, count=1)[0]
    audio = np.zeros(frames, np.float32)
    probes = np.zeros((frames, probe_columns(MAX_FINGERS)))
    controls = np.zeros((frames, control_columns(MAX_FINGERS)))
    pitch = np.full(frames, np.nan)
    for start in range(0, frames, CHUNK):
        end = min(start + CHUNK, frames)
        instrument.process(audio[start:end])
        probes[start:end] = rig["output"]["probes"][: end - start]
        controls[start:end] = rig["output"]["controls"][: end - start]
        pitch[start:end] = instrument.meters()["pitch"]
    rate = description.rate
    arrays = signals(probes, controls, rate)
    asked = a4 * np.exp2((pitch - 69.0) / 12.0)
    return Sound(
        audio=audio,
        arrays=arrays,
        drawn=drawn,
        found=regimes(arrays, asked, rate, description.quantities.bow.lift_force),
        faults=instrument.unconverged_solves + instrument.lost_states,
    )
