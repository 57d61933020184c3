"""A sound of a data set that the player plays: some notes, as they are written."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG
from yehu_server.core.physics.layout import MAX_FINGERS, control_columns, probe_columns
from yehu_server.errors import ParameterError
from yehu_server.lab.dataset.description import Description
from yehu_server.lab.dataset.sound import Sound, calibrated, regimes
from yehu_server.lab.simulation import signals
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.stringing import higher_of
from yehu_server.playing.wishes import Key

Array = Any

LONGEST_S = 600.0
OF_NOTES = ("pitch", "velocity", "length", "gap")  # drawn for each
SHORTEST_S = 0.02  # from one beginning to the next


def melody(description: Description, number: int) -> Sound:
    """Make a sound of a description of kind "notes".

    Raises ParameterError where it would last too long.
    """
    rate = description.rate
    drawn: dict[str, Any] = {
        name: value for name, value in description.drawn(number).items() if name not in OF_NOTES
    }
    drawn["notes"] = _written(description, number, int(drawn["notes"]))
    _, calibration = calibrated(description)
    spec = PlayingOptions(seed=number % 65536).spec(rate, calibration, description.quantities)
    instrument = Instrument(spec)
    wishes = PlayingOptions().wishes(instrument)
    for address in description.draws:
        if address.startswith("/"):
            wishes.write(address, drawn[address])
    end_s = 0.0
    for place, note in enumerate(drawn["notes"]):
        key = Key(place % 16, float(place))
        begin, end = (instrument.frames(1e3 * note[name]) for name in ("begin", "end"))
        wishes.write("/playing/note_length", note["length"], frame=begin)
        struck = {"/playing/velocity": note["velocity"] / 127.0}
        played = note["pitch"] - higher_of(description.quantities)
        wishes.note_on(key, struck, frame=begin, tuned=played)
        wishes.note_off(key, frame=end)
        end_s = max(end_s, note["end"])
    frames = instrument.frames(1e3 * (end_s + drawn["tail"]))
    if frames > LONGEST_S * rate:
        raise ParameterError(f"lasts {frames / rate:.0f} s, longer than {LONGEST_S:g}")
    return _played(instrument, frames, drawn, rate, calibration.a4)


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


def _played(instrument: Any, frames: int, drawn: dict[str, Any], rate: float, a4: float) -> Sound:
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
    arrays = signals(probes, controls, rate)
    asked = a4 * np.exp2((pitch - 69.0) / 12.0)
    return Sound(
        audio=audio,
        arrays=arrays,
        drawn=drawn,
        found=regimes(arrays, asked, rate),
        faults=instrument.unconverged_solves + instrument.lost_states,
    )
