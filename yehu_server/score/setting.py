"""A parameter that a score sets: what its marks ask for and MIDI cannot say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True)
class Setting:
    """Stands among the messages of a score's events.

    Parameters
    ----------
    address : str
        Of `params/table.py`.
    value : float or None
        None: what it was before the score set it.
    channel : int
        Of the part, counted from 0; where that is not played, nothing is set.
    """

    address: str
    value: float | None
    channel: int = 0
    type: ClassVar[str] = "setting"  # as messages have one
