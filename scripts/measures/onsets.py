"""`onsets`: how soon each note is heard at its pitch after each other one.

Every ordered pair of notes comes once, the same note twice too: the order is a random circuit
through all pairs, by Hierholzer's algorithm. A window of 24 ms is right where the sound is
most alike after a period, within 50 cents of the note's, and neither half nor twice of it does as
well. The onset lasts until all later windows of the note's first 0.28 s are right.

It is wrong where it lasts longer than 50 ms after the beat, which players accept of an ordinary
attack [Acceptance]: 10 ms of these for hand and hair, and 40 to come into Helmholtz motion. What is
wrong at that time is the old note, which rings on; an octave below, of two strings a fifth apart or
of one whose periods differ in turn; an octave above; or nothing that has a pitch.
"""

from collections import Counter
from dataclasses import dataclass
from itertools import chain, pairwise
from typing import Any

import numpy as np
from scipy.signal import resample_poly

from measures.shares import Share, share_line
from measures.take import NOTES, Setup, Sound, Take, in_parallel
from yehu_server.core.player.note_tables import frequency_hz
from yehu_server.following.frames import nsdf

Array = Any

EACH_S, SLUR_S = 0.32, 0.01  # a note lasts, and overlaps the next of a slur
PIECES = 4  # performances that the circuit is cut into
RATE, SIZE, HOP = 16000, 384, 40
HEARD_S, LATEST_S = 0.28, 0.05
NEAR_CENTS, SEARCHED_CENTS = 50.0, 250.0
CLEAR = 0.5  # clarity from which there is a pitch
AS_GOOD = 0.85  # of the clarity after two periods, that after one has to have
OCTAVE_ABOVE = 0.94  # clarity after half a period: all but 3 % of the power is of even harmonics
RIGHT, OLD, BELOW, ABOVE, NO_PITCH = range(5)
FAULTS = ("right", "old note", "octave below", "octave above", "no pitch")


@dataclass(frozen=True)
class Onset:
    """How a note began after another: `late_s` after the beat; what was heard until then."""

    old: int
    new: int
    kind: str
    late_s: float
    fault: str

    @property
    def is_right(self) -> bool:
        return self.late_s <= LATEST_S

    def __str__(self) -> str:
        return f"{self.old}-{self.new} {1e3 * self.late_s:.0f} ms {self.fault}"


def circuit(seed: int) -> list[int]:
    """Notes in an order in which every ordered pair comes once, the first of them last again."""
    chance = np.random.default_rng(seed)
    left = {note: chance.permutation(NOTES).tolist() for note in NOTES}
    stack, order = [int(chance.choice(NOTES))], []
    while stack:
        if left[stack[-1]]:
            stack.append(left[stack[-1]].pop())
        else:
            order.append(stack.pop())
    return order[::-1]


def _most(curves: Array, period: float, cents: float) -> tuple[Array, Array]:
    """The highest clarity within some cents of a period (s), and how far it is from it (cents)."""
    steps = np.arange(-cents, cents + 1.0, 5.0)
    lags = 2.0 * RATE * period * 2.0 ** (steps / 1200.0)
    low = np.floor(lags).astype(int)
    part = lags - low
    # A parabola through three lags: between those of half samples a peak of a high note is wider.
    below, here, above = curves[:, low - 1], curves[:, low], curves[:, low + 1]
    values = here + 0.5 * part * (above - below) + 0.5 * part**2 * (above - 2.0 * here + below)
    best = values.argmax(axis=1)
    return values[np.arange(len(values)), best], steps[best]


def faults_of(sound: Array, old: int, new: int) -> Array:
    """What each window of a note's sound (at RATE) has, from RIGHT to NO_PITCH."""
    curves = nsdf(np.lib.stride_tricks.sliding_window_view(sound, SIZE)[::HOP])
    period, before = 1.0 / frequency_hz(new, 440.0), 1.0 / frequency_hz(old, 440.0)
    own, cents = _most(curves, period, SEARCHED_CENTS)
    twice, _ = _most(curves, 2.0 * period, NEAR_CENTS)
    half, _ = _most(curves, 0.5 * period, NEAR_CENTS)
    rings, _ = _most(curves, before, NEAR_CENTS)
    fault = np.where(np.abs(cents) <= NEAR_CENTS, RIGHT, NO_PITCH)
    fault[(own < AS_GOOD * twice)] = BELOW
    fault[(half > OCTAVE_ABOVE) & (half > own - 0.02)] = ABOVE
    fault[np.maximum(own, twice) < CLEAR] = NO_PITCH
    if old != new:
        fault[(fault != RIGHT) & (rings > own)] = OLD
    return fault


def _heard(sound: Array, beat_s: float, old: int, new: int) -> tuple[float, str]:
    """How long after the beat a note is wrong (s), and as what it is heard the longest."""
    first = round(beat_s * RATE)
    part = sound[first - SIZE // 2 : first + round(HEARD_S * RATE) + SIZE // 2]
    fault = faults_of(part, old, new)
    # What a window still has of the time before it is judged in is not the note's: it begins there.
    late = round(LATEST_S * RATE / HOP)
    after = fault[late + SIZE // 2 // HOP :]
    wrong = np.flatnonzero(after)
    if not len(wrong):
        return 0.0, FAULTS[RIGHT]
    longest = Counter(after[wrong].tolist()).most_common(1)[0][0]
    return LATEST_S + (wrong[-1] + 1) * HOP / RATE, FAULTS[longest]


def _kind(old: int, new: int, strings: tuple[int, int]) -> str:
    if strings[0] != strings[1]:
        return "to the outer string" if strings[1] == 1 else "to the inner string"
    return "repeated" if old == new else "upwards" if new > old else "downwards"


def _play(setup: Setup, notes: list[int], is_slurred: bool) -> list[Onset]:
    take, strings = Take(setup), []
    for i, note in enumerate(notes):
        take.on(i * EACH_S, note)
        again = is_slurred and notes[i + 1 : i + 2] != [note]
        take.off((i + 1) * EACH_S + (SLUR_S if again else 0.0), note)
    parts: list[Sound] = []
    for _ in notes:
        parts.append(take.play(EACH_S))
        strings.append(0 if take.instrument.target("/bow/side") > 0.0 else 1)
    sound = np.concatenate(parts).astype(np.float64)
    common = np.gcd(round(setup.rate), RATE)
    low = resample_poly(sound, RATE // common, round(setup.rate) // common)
    found = []
    for i in range(1, len(notes)):
        old, new = notes[i - 1], notes[i]
        if is_slurred and old == new:
            continue
        late_s, fault = _heard(low, i * EACH_S, old, new)
        found.append(Onset(old, new, _kind(old, new, (strings[i - 1], strings[i])), late_s, fault))
    return found


def onsets(setup: Setup) -> list[Share]:
    """Print the share of onsets that are right, of each kind, and the worst of the others."""
    order = circuit(setup.seed)
    cuts = np.linspace(0, len(order) - 1, PIECES + 1).astype(int)
    pieces = [order[begin : end + 1] for begin, end in pairwise(cuts)]
    pieces = [[*piece, piece[-1]] for piece in pieces]  # so that the last one is heard to its end
    parts = []
    for way, is_slurred in (("separate", False), ("slurred", True)):
        jobs = [(piece, is_slurred) for piece in pieces]
        found = list(chain.from_iterable(each[:-1] for each in in_parallel(setup, _play, jobs)))
        for kind in sorted({onset.kind for onset in found}):
            own = sorted((o for o in found if o.kind == kind), key=lambda o: -o.late_s)
            rights, words = [o.is_right for o in own], [str(o) for o in own]
            parts.append(share_line(f"{way}, {kind}", rights, words))
        wrong = Counter(onset.fault for onset in found if not onset.is_right)
        print(f"{way}:", ", ".join(f"{fault} {n}" for fault, n in wrong.most_common()), flush=True)
    return parts
