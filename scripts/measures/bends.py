"""`bends`: the error while the pitch wheel moves.

Moments within half a semitone of an open string count apart: no finger fits there, and from the C
string the note goes on on the F string.
"""

import math
from itertools import repeat

import numpy as np

from measures.intonation import FAIR_CENTS, NONE, off_by
from measures.shares import Share, share_line
from measures.take import NOTES, Setup, Take, in_parallel
from yehu_server.core.player.note_tables import OPEN_NOTES

BEGIN_S, LENGTH_S, LAG_S, WINDOW_S = 0.3, 1.0, 0.012, 0.03
OPEN_WITHIN = 0.5  # semitones


def _bent(setup: Setup, note: int, semitones: float) -> list[tuple[float, bool]]:
    """Return the errors (cents) while a bend goes up and back, and whether a finger fits there.

    A delay of 12 ms is allowed.
    """
    take = Take(setup)
    take.player.write("/playing/bend_range", abs(semitones), frame=0, hold=True)
    take.on(0.0, note)

    def curve(t: float) -> float:
        turn = min(max((t - BEGIN_S) / LENGTH_S, 0.0), 1.0)
        return math.copysign(0.5 - 0.5 * math.cos(2.0 * math.pi * turn), semitones)

    for step in range(200):
        time = BEGIN_S + LENGTH_S * step / 199
        take.at(time, "pitchwheel", pitch=round(8191 * curve(time)))
    sound = take.play(BEGIN_S + LENGTH_S + 0.2)
    times = np.arange(BEGIN_S, BEGIN_S + LENGTH_S, 0.02)
    aims = [note + abs(semitones) * curve(t + 0.5 * WINDOW_S - LAG_S) for t in times]
    errors = [off_by(sound, setup.rate, *of) for of in zip(times, repeat(WINDOW_S), aims)]
    opens = [open_note for open_note in OPEN_NOTES if open_note < note]
    return [
        (error, all(abs(aim - open_note) > OPEN_WITHIN for open_note in opens))
        for error, aim in zip(errors, aims, strict=True)
    ]


def bends(setup: Setup) -> list[Share]:
    """Print how closely the pitch follows bends."""
    parts = []
    for semitones in (2.0, -2.0, 5.0):
        notes = [n for n in NOTES if n + semitones in NOTES and n not in OPEN_NOTES]
        found = np.array(in_parallel(setup, _bent, [(n, semitones) for n in notes]))
        errors, fits = np.abs(found[..., 0]), found[..., 1] > 0.0
        right = errors <= FAIR_CENTS
        name = f"{semitones:+g} semitones, moments"
        parts.append(share_line(name, right[fits]))
        parts.append(share_line(f"{name} where no finger fits", right[~fits], counts=False))
        for note, row in zip(notes, np.where(fits, errors, 0.0), strict=True):
            if (row > FAIR_CENTS).any():
                most = "no pitch" if row.max() == NONE else f"{row.max():.0f} cents at most"
                print(
                    f"   {note}: {100.0 * (row > FAIR_CENTS).mean():.0f} % of the time off, {most}"
                )
    return parts
