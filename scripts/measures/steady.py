"""`steady`, `quarters`: the error in the steady state, of semitones and of quarter tones."""

from __future__ import annotations

import numpy as np

from measures.intonation import CLOSE_CENTS, SETTLED_S, bound, in_words, off_by
from measures.shares import Share, share, share_line
from measures.take import NOTES, Setup, Take, in_parallel

WHEELS = (None, 0, 32, 64, 96, 127)
VELOCITIES = (40, 60, 80, 100, 127)
CASES = [(wheel, velocity) for wheel in WHEELS for velocity in VELOCITIES]
QUARTERS = [note + 0.5 for note in NOTES[:-1]]
STEADY_S = 0.45
END_S = 0.75
SHARP_CENTS = 50.0  # more is another register


def sustained(
    setup: Setup, note: float, wheel: int | None, velocity: int, start_s: float
) -> tuple[float, bool]:
    """Return the error (cents) of a note in the steady state; and if its finger is at the nut."""
    take = Take(setup)
    take.wheel(wheel)
    take.on(0.0, note, velocity)
    sound = take.play(END_S)
    return off_by(sound, setup.rate, start_s, END_S - start_s, note), take.is_at_nut


def steady(setup: Setup) -> list[Share]:
    """Print the largest steady-state error of each note, from 0.45 s on."""
    start_s = setup.steady_s(STEADY_S)
    jobs = [(note, *case, start_s) for note in NOTES for case in CASES]
    errors = [error for error, _ in in_parallel(setup, sustained, jobs)]
    table = np.abs(np.array(errors)).reshape(len(NOTES), len(CASES))
    right = table <= np.array([[bound(note, CLOSE_CENTS)] for note in NOTES])
    for note, row, is_right in zip(NOTES, table, right, strict=True):
        print(
            f"{note}: {row.max():6.1f} cents at most, "
            f"{(~is_right).sum():2} over {bound(note, CLOSE_CENTS):g}"
        )
    return [share("in tune", right.flat)]


def quarters(setup: Setup) -> list[Share]:
    """Print the quarter tones that are out of tune, from 0.4 s on.

    They are fractional notes, as OSC and tunings ask for. Those that are sharp with the finger as
    near to the nut as it can be are apart: no finger reaches them on the string that the player
    chose.
    """
    cases = [(pitch, *case) for pitch in QUARTERS for case in CASES]
    found = in_parallel(setup, sustained, [(*case, SETTLED_S) for case in cases])
    words = [
        f"{pitch:g} wheel {wheel} velocity {velocity} {in_words(error)}"
        for (pitch, wheel, velocity), (error, _) in zip(cases, found, strict=True)
    ]
    is_apart = [is_at_nut and CLOSE_CENTS < error < SHARP_CENTS for error, is_at_nut in found]
    reached = [i for i in range(len(found)) if not is_apart[i]]
    apart = [i for i in range(len(found)) if is_apart[i]]

    def part(what: str, of: list[int], *, counts: bool) -> Share:
        right = [abs(found[i][0]) <= CLOSE_CENTS for i in of]
        return share_line(what, right, [words[i] for i in of], counts=counts)

    return [
        part("reached by a finger", reached, counts=True),
        part("not reached by a finger", apart, counts=False),
    ]
