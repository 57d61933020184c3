"""When the players of a section begin: together, but for what they correct from note to note.

Each player corrects a share, the gain, of how far it was from each of the others at the note
before [Wing]: A'_i = A_i - gain_i sum_j (A_i - A_j) + an error by chance. Their asynchronies are
counted from the earliest, which is on time: nobody is early, and nobody later than `LATEST_MS`.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

from yehu_server.physics.chance import chance

LATEST_MS = 40.0
# Standard deviation of the error in each onset, at full variation and at most. At the usual
# variation it is 9 ms, which leaves onsets of two players 13 ms apart [Wing]. Trios that play
# different notes have 30 to 50 ms [Rasch].
ERROR_MS, MOST_ERROR_MS = 36.0, 14.0
# The gain that keeps players of a number closest is 1 over it: 0.25 for four [Wing]. Each has one
# of its own, within these factors. By ear.
GAIN_LO, GAIN_HI = 0.6, 1.4
SHARE = 0.5  # of the time since the last onset that nobody is late for more, so that notes last
ADDED = 12  # a sum of so many uniform numbers is all but normal
FIRST_STREAM = 1 << 20  # of random numbers; those of the players' variation come before
KEPT = 64  # onsets


@dataclass(frozen=True)
class Onset:
    """An onset: its planned frame, and how many frames each player is late."""

    frame: int
    late: tuple[int, ...]


class Together:
    """The onsets of a section.

    Parameters
    ----------
    people : int
        Number of players.
    rate : float, Hz
    seed : int
        Of what goes by chance.
    """

    def __init__(self, people: int, rate: float, seed: int) -> None:
        self._rate = rate
        self.variation = 0.25  # as /playing/variation
        self._people = people
        self.playing = people  # the first of them
        self._onsets: deque[Onset] = deque(maxlen=KEPT)
        self.begin(seed)

    def begin(self, seed: int) -> None:
        """Begin the sequence of a seed; all are together."""
        self._stream, self._drawn = FIRST_STREAM + seed, 0
        self._shares = [self._uniform(GAIN_LO, GAIN_HI) for _ in range(self._people)]
        self._onsets.clear()
        self._draw()

    @property
    def gains(self) -> list[float]:
        """The share of its distance to each other one that a player corrects, of each."""
        return [share / self.playing for share in self._shares[: self.playing]]

    def onset(self, frame: int) -> tuple[int, ...]:
        """How many frames each is late for an onset planned at a frame; plan the next one."""
        late = self._late(frame)
        self._onsets.append(Onset(frame, late))
        self._draw()
        return late

    def release(self, frame: int) -> tuple[int, ...]:
        """How many frames each is late for the end of a note: as for the onset that follows."""
        for onset in self._onsets:
            if onset.frame >= frame:
                return onset.late
        return self._late(frame)

    def _late(self, frame: int) -> tuple[int, ...]:
        """How late each is for the next onset, if that is planned at a frame."""
        most = LATEST_MS
        before = [0.0] * self.playing
        if self._onsets:
            last = self._onsets[-1]
            most = min(most, max(0.0, SHARE * 1e3 * (frame - last.frame) / self._rate))
            before = [1e3 * frames / self._rate for frames in last.late[: self.playing]]
        total = sum(before)
        error = min(ERROR_MS * self.variation, MOST_ERROR_MS)
        planned = [
            own - gain * (self.playing * own - total) + error * drawn
            for own, gain, drawn in zip(before, self.gains, self._errors, strict=False)
        ]
        first = min(planned)
        late = tuple(int(1e-3 * min(own - first, most) * self._rate) for own in planned)
        return late + (0,) * (self._people - self.playing)

    def _draw(self) -> None:
        """Draw the errors of the next onset."""
        self._errors = [self._deviate() for _ in range(self._people)]

    def _uniform(self, lo: float, hi: float) -> float:
        self._drawn += 1
        return lo + 0.5 * (hi - lo) * (1.0 + chance((self._stream << 32) + self._drawn))

    def _deviate(self) -> float:
        """A number of mean 0 and variance 1; each of the uniform ones has a variance of 1/3."""
        return sum(self._uniform(-1.0, 1.0) for _ in range(ADDED)) / math.sqrt(ADDED / 3.0)
