"""Pitches as users write them: names of notes, or MIDI notes."""

from __future__ import annotations

import math
import re
from numbers import Real

from yehu_server.core.player.fingering import HIGHEST_NOTE, LOWEST_NOTE, OPEN_WITHIN
from yehu_server.errors import ParameterError
from yehu_server.playing.stringing import range_text

SEMITONES = {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11}
ACCIDENTALS = {"#": 1, "♯": 1, "b": -1, "♭": -1}
_NAME = re.compile(r"([A-Ga-g])([#♯b♭]*)(-?\d{1,2})([+-]\d{1,3}(?:\.\d+)?)?")
HIGHEST_KEY = 127.0


def pitch_of(note: str | float) -> float:
    """Return the pitch of a note as a fractional MIDI note.

    Parameters
    ----------
    note : str or float
        A name such as ``"A4"``, ``"Bb4"`` or ``"F#5+25"`` (cents), where A4 is MIDI note 69; or a
        MIDI note, which may be fractional.

    Raises
    ------
    ParameterError
        Where it is neither, or not within 0 to 127.

    Examples
    --------
    >>> pitch_of("A4"), pitch_of("Bb4-50"), pitch_of(60)
    (69.0, 69.5, 60.0)
    """
    if isinstance(note, str):
        found = _NAME.fullmatch(note.strip())
        if found is None:
            raise ParameterError(f"{note!r}: expected the name of a note, such as A4 or F#5")
        letter, signs, octave, cents = found.groups()
        pitch = 12.0 * (int(octave) + 1) + SEMITONES[letter.upper()]
        pitch += sum(ACCIDENTALS[sign] for sign in signs) + 0.01 * float(cents or 0.0)
    elif isinstance(note, Real) and not isinstance(note, bool):
        pitch = float(note)
    else:
        raise ParameterError(f"{note!r}: expected a note, such as 'A4' or 69")
    if not math.isfinite(pitch) or not 0.0 <= pitch <= HIGHEST_KEY:
        raise ParameterError(f"{note}: not within MIDI's notes, 0 to {HIGHEST_KEY:g}")
    return pitch


def playable(note: str | float, higher: int = 0) -> float:
    """Return the pitch of a note of the instrument; see `pitch_of`.

    Parameters
    ----------
    higher : int
        Semitones by which its strings are tuned higher than a yehu's.

    Raises
    ------
    ParameterError
        Where it is out of the instrument's range.
    """
    pitch = pitch_of(note)
    lowest, highest = LOWEST_NOTE + higher, HIGHEST_NOTE + higher
    if not lowest - OPEN_WITHIN < pitch < highest + OPEN_WITHIN:
        ends = f"{range_text(higher)} ({lowest} to {highest})"
        raise ParameterError(f"{note}: the instrument plays {ends}")
    return pitch
