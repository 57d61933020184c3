"""What is told of jobs while they are done, wherever that is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

Tell = Callable[[float, float], None]  # what is done, and of what
Perform = Callable[[Any, Tell], Any]


@dataclass(frozen=True)
class Event:
    """What became of a job: its share done, or its result, or why its processes died.

    Attributes
    ----------
    job : int
        The number of its task, from 0.
    share : float
        Of the job; 1 when it is over.
    total : float
        What the job does in all, such as seconds of sound; 0 where it has not told.
    result : object
        What was returned.
    died : str
        How its process ended, such as "killed by signal 9".
    """

    job: int
    share: float = 0.0
    total: float = 0.0
    result: Any = None
    died: str = ""

    @property
    def is_end(self) -> bool:
        """Whether the job is over."""
        return self.share >= 1.0
