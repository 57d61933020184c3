"""Play every note at many dynamics and print which are in tune, and from when on.

    .venv/bin/python scripts/playability.py [--rate HZ]

Notes F4 to F6 with velocities 20 to 127 and the mod wheel untouched, at 0, 64 and 127, through
the keyboard mapping: 500 notes of 0.8 s. A dot is a note within 10 cents (open strings 12) from
0.1 s to its end; `a` one whose attack takes longer; a number how many cents it is off in the
end; `O` and `U` a register above or below, `?` none.
"""

from __future__ import annotations

import argparse
import math
import os
from concurrent.futures import ThreadPoolExecutor

import mido
import numpy as np

from yehu_server.analysis.pitch import cents, pitch_hz
from yehu_server.engine.instrument import Instrument
from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibration import OPEN_NOTES, calibration_for, frequency_hz
from yehu_server.playing.intonation import Intonation
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.playing.messages import MidiPlayer
from yehu_server.playing.performer import Performer

VELOCITIES = (20, 50, 80, 110, 127)
WHEELS = (None, 0, 64, 127)
SECONDS = 0.8
MOMENTS_S = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
STEADY = 4  # moments from which on a note has settled
LISTEN_S = 0.06
NONE = 9999.0


def errors(rate: float, note: int, wheel: int | None, velocity: int) -> list[float]:
    """How many cents a note is off, at each of MOMENTS_S; NONE where it has no pitch."""
    calibration = calibration_for(rate)
    instrument = Instrument(rate, calibration.tuned(Quantities()))
    midi = MidiPlayer(Performer(instrument, Intonation(calibration)), load(DEFAULT))
    if wheel is not None:
        midi.receive(mido.Message("control_change", control=1, value=wheel), frame=0)
    midi.receive(mido.Message("note_on", note=note, velocity=velocity), frame=0)
    out = np.zeros(round(SECONDS * rate), np.float32)
    instrument.process(out)
    wanted = frequency_hz(note, 440.0)
    found = []
    for moment in MOMENTS_S:
        window = out[round(moment * rate) : round((moment + LISTEN_S) * rate)]
        pitch = pitch_hz(window, rate, lo=0.4 * wanted, hi=3.2 * wanted)
        found.append(cents(pitch, wanted) if math.isfinite(pitch) else NONE)
    return found


def mark(note: int, found: list[float]) -> str:
    """One place of the map."""
    bound = 12.0 if note in OPEN_NOTES else 10.0
    if all(abs(error) <= bound for error in found):
        return "."
    settled = found[STEADY:]
    if all(abs(error) <= bound for error in settled):
        return "a"
    if NONE in settled:
        return "?"
    middle = float(np.median(settled))
    if abs(middle) < 100.0:
        return f"{middle:+.0f}"
    return "O" if middle > 0.0 else "U"


def main() -> None:
    """Print the map and the sum."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--rate", type=float, default=44100.0)
    rate = parser.parse_args().rate
    jobs = [(n, w, v) for n in range(65, 90) for w in WHEELS for v in VELOCITIES]
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        marks = list(workers.map(lambda job: mark(job[0], errors(rate, *job)), jobs))
    print("note   wheel untouched       wheel 0               wheel 64              wheel 127")
    per_note = len(WHEELS) * len(VELOCITIES)
    for row in range(0, len(jobs), per_note):
        cells = marks[row : row + per_note]
        groups = [cells[at : at + len(VELOCITIES)] for at in range(0, per_note, len(VELOCITIES))]
        lines = ["".join(f"{cell:>4}" for cell in group) for group in groups]
        print(f"{jobs[row][0]:4} {'  '.join(lines)}")
    good = marks.count(".")
    print(f"{good} of {len(marks)} ({100.0 * good / len(marks):.1f} %)")


if __name__ == "__main__":
    main()
