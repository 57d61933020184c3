"""How much of a folder is rendered, in seconds of sound, as far as their number is known."""

from __future__ import annotations

from collections.abc import Sequence


class Seconds:
    """Counts the seconds of jobs: those that are done, and all.

    A job whose length nobody knows yet counts as the mean of the others; so files of one length
    count as files do.

    Parameters
    ----------
    known : sequence of float
        Of each job; 0 where it is not known.
    """

    def __init__(self, known: Sequence[float]) -> None:
        self._known = list(known)
        self._shares = [0.0] * len(self._known)
        self._number = sum(seconds > 0.0 for seconds in self._known)
        self._sum = sum(self._known)
        self._done = 0.0  # of those that are known,
        self._unknown_shares = 0.0  # and of the others

    def hear(self, job: int, share: float, seconds: float = 0.0) -> None:
        """Take a job's share that is done, and its length where that is told (else 0)."""
        self._count(job, -1.0)
        if seconds > 0.0:
            self._number += self._known[job] == 0.0
            self._sum += seconds - self._known[job]
            self._known[job] = seconds
        self._shares[job] = share
        self._count(job, 1.0)

    def _count(self, job: int, sign: float) -> None:
        share = sign * self._shares[job]
        if self._known[job] > 0.0:
            self._done += share * self._known[job]
        else:
            self._unknown_shares += share

    @property
    def mean(self) -> float:
        """Of the jobs whose length is known; 1 where none is."""
        return self._sum / self._number if self._number else 1.0

    @property
    def done(self) -> float:
        """Seconds that are done, in all jobs."""
        return self._done + self._unknown_shares * self.mean

    @property
    def total(self) -> float:
        """Seconds of all jobs."""
        return self._sum + (len(self._known) - self._number) * self.mean
